//! `plan check FILE`

use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::time::Instant;
use std::{fs, io};

use steadfast::certificate::issue;
use steadfast::io::{
    CertificateDocument, CheckReport, Checkable, NamedStructure, read_checkable, write_certificate, write_check,
};
use steadfast::statics::{
    Assessment, Bracket, Distribution, Question, Reductions, SelfStress, Verdict, assess, contact_self_stress, explain,
    failure_order,
};

use crate::arguments::CheckArguments;
use crate::exit::Exit;
use crate::explain::explained;
use crate::gives_way::gives_way;
use crate::order::order;
use crate::table::table;
use crate::{files, output};

/// Assesses a file and reports on it.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &CheckArguments) -> io::Result<Exit> {
    let file = files::read(&arguments.file);
    let named = match read_checkable(&file, &files::resolve) {
        Ok(Checkable::Structure(named)) => named,
        Ok(Checkable::Configuration(configuration)) => NamedStructure::of_configuration(&configuration),
        Ok(Checkable::Linkage(linkage)) => NamedStructure::of_linkage(&linkage),
        Err(diagnostics) => return output::bad_input(&diagnostics, arguments.json),
    };
    let clock = Instant::now();
    let question = if arguments.distribution { Question::Full } else { Question::VALUE };
    let answer = match assess(&named.structure, question) {
        Ok(answer) => answer,
        Err(problems) => {
            let reasons = problems.iter().map(|problem| format!("{}: {}", problem.place, problem.problem));
            return output::refused(&file.name, reasons, arguments.json);
        }
    };
    let seconds = clock.elapsed().as_secs_f64();
    // A structure that was assessed is sound.
    let explanation = arguments.explain.then(|| explain(&named.structure, Reductions::ALL).ok()).flatten();
    let stable = answer.verdict == Verdict::Stable;
    let self_stress = stable.then(|| contact_self_stress(&named.structure).ok()).flatten();
    let levels = arguments.order.then(|| failure_order(&named.structure, arguments.top).ok().flatten()).flatten();
    let report = CheckReport {
        assessment: &answer,
        explanation: explanation.as_ref(),
        self_stress,
        order: levels.as_ref(),
        seconds,
    };
    if arguments.json {
        match write_check(&named, &report) {
            Ok(text) => output::result(&text)?,
            Err(problem) => return output::refused(&file.name, [problem.to_string()], true),
        }
    } else {
        output::result(&told(&named, &report, arguments.top))?;
    }
    if let Some(out) = &arguments.certificate
        && let Err(trouble) = certify(&named, &answer, out)
    {
        output::message(&format!("error: {}: {trouble}", out.display()))?;
        return Ok(Exit::BadInput);
    }
    Ok(match answer.verdict {
        Verdict::Stable => Exit::Yes,
        Verdict::InternallyUnstable | Verdict::WholeBodyUnstable => Exit::No,
        Verdict::Undecided => Exit::Undecided,
    })
}

/// Writes a certificate of the answer; it is verified before it is written.
fn certify(named: &NamedStructure, answer: &Assessment, out: &Path) -> Result<(), Box<dyn Error>> {
    let document = CertificateDocument::new(named, issue(&named.structure, answer)?);
    fs::write(out, write_certificate(&document)?)?;
    Ok(())
}

fn told(named: &NamedStructure, report: &CheckReport<'_>, top: usize) -> String {
    let answer = report.assessment;
    let mut text = verdict(answer);
    text.push_str(clamped(report.self_stress));
    if answer.verdict != Verdict::Stable {
        text.push_str(&gives_way(named, answer));
    }
    if answer.verdict != Verdict::WholeBodyUnstable {
        let _ = writeln!(text, "margin       {}", shown(answer.margin()));
        let _ = writeln!(text, "utilisation  {}", shown(answer.utilisation));
        strengths(&mut text, named, answer);
        loaded(&mut text, named, answer, top);
    }
    if let Some(levels) = report.order {
        text.push_str(&order(named, levels));
    }
    left_out(&mut text, named, answer, report.seconds);
    if let Some(explanation) = report.explanation {
        text.push_str(&explained(named, explanation, answer.distribution == Distribution::Proof));
    }
    text
}

/// What a verdict of equilibrium is worth where contacts could clamp.
fn clamped(self_stress: Option<SelfStress>) -> &'static str {
    match self_stress {
        Some(SelfStress::ReliedOn) => {
            "but only by contacts that press on each other though nothing makes them:\nwithout a real squeeze it slips\n"
        }
        Some(SelfStress::Undecided) => {
            "contacts could press on each other without a load; whether it relies on that\nwas not found out\n"
        }
        Some(SelfStress::Impossible | SelfStress::NotNeeded) | None => "",
    }
}

fn verdict(answer: &Assessment) -> String {
    match answer.verdict {
        Verdict::Stable => "STABLE: every connection holds\n".to_string(),
        Verdict::InternallyUnstable => "INTERNALLY UNSTABLE: some connection must break\n".to_string(),
        Verdict::WholeBodyUnstable => {
            "WHOLE-BODY UNSTABLE: it tips, slides or falls, however strong the connections\n".to_string()
        }
        Verdict::Undecided => {
            let why = answer.undecided_because.as_deref().unwrap_or("the bracket straddles the limit");
            format!("UNDECIDED: {why}\n")
        }
    }
}

/// A bracket in as many digits as it proves.
fn shown(bracket: Bracket) -> String {
    if bracket.lower == bracket.upper {
        return format!("{:.6}", bracket.lower);
    }
    if bracket.width() < 5e-7 {
        return format!("{:.6}  (proved within {:.0e})", (bracket.lower + bracket.upper) / 2.0, bracket.width());
    }
    format!("between {:.9} and {:.9}", bracket.lower, bracket.upper)
}

fn strengths(text: &mut String, named: &NamedStructure, answer: &Assessment) {
    let used = |index: usize| named.structure.connections.iter().any(|connection| connection.connector == index);
    let rows: Vec<_> = named
        .structure
        .connectors
        .iter()
        .enumerate()
        .filter(|(index, _)| used(*index) && answer.utilisation.upper.is_finite())
        .map(|(_, connector)| {
            let required = connector.strength * answer.utilisation.upper;
            vec![connector.name.clone(), format!("{:.4}", connector.strength), format!("{required:.4}")]
        })
        .collect();
    if !rows.is_empty() {
        let _ = write!(text, "\n{}", table(&["connector", "rated N", "required N"], &rows));
    }
}

fn loaded(text: &mut String, named: &NamedStructure, answer: &Assessment, top: usize) {
    let mut order: Vec<_> = (0..answer.connections.len()).collect();
    let utilisation = |index: &usize| answer.connections[*index].utilisation;
    order.sort_by(|a, b| utilisation(b).total_cmp(&utilisation(a)).then(a.cmp(b)));
    let rows: Vec<_> = order
        .iter()
        .take(top)
        .map(|&index| {
            let state = &answer.connections[index];
            let norm = |vector: steadfast::spatial::Vec3| format!("{:.4}", vector.norm());
            vec![
                named.connections[index].clone(),
                format!("{:.4}", state.utilisation),
                norm(state.wrench.force),
                norm(state.wrench.torque),
                role(answer, index).to_string(),
            ]
        })
        .collect();
    if !rows.is_empty() {
        let _ = writeln!(text, "\nthe most loaded of {} connections", order.len());
        text.push_str(&table(&["connection", "utilisation", "force N", "torque N m", ""], &rows));
    }
    distribution(text, answer);
}

/// What a connection is to the verdict. A state that was not chosen says nothing about
/// who has to be at the limit.
fn role(answer: &Assessment, connection: usize) -> &'static str {
    if answer.connections[connection].critical {
        "critical"
    } else if answer.distribution != Distribution::Proof && answer.is_at_limit(connection) {
        "at its limit"
    } else {
        ""
    }
}

fn distribution(text: &mut String, answer: &Assessment) {
    let _ = match answer.distribution {
        Distribution::Proof => Ok(()),
        Distribution::Least => {
            writeln!(text, "the state at this utilisation with the least sum of strengths and pressures")
        }
        Distribution::LeastExcept { blocks } => {
            writeln!(text, "the least sum of strengths and pressures, except in blocks left as proved: {blocks}")
        }
    };
}

fn left_out(text: &mut String, named: &NamedStructure, answer: &Assessment, seconds: f64) {
    let (left_out, structure) = (&answer.left_out, &named.structure);
    let _ = writeln!(
        text,
        "\n{} of {} connections and {} of {} contacts in closed form; {} of {} bodies fixed;",
        left_out.closed_form_connections,
        structure.connections.len(),
        left_out.closed_form_contacts,
        structure.contacts.len(),
        left_out.fixed_bodies,
        structure.bodies.len(),
    );
    let solved = match left_out.solved_blocks {
        0 => "nothing had to be solved".to_string(),
        1 => format!("one block of {} bodies solved", left_out.largest_block_bodies),
        blocks => format!("{blocks} blocks solved, the largest of {} bodies", left_out.largest_block_bodies),
    };
    let _ = writeln!(text, "{solved}; {:.2} ms", seconds * 1e3);
}
