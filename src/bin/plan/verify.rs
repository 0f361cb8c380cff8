//! `plan verify FILE`

use std::io;

use steadfast::certificate::check;
use steadfast::io::{CertificateDocument, PlanDocument, Verifiable, read_verifiable};
use steadfast::reconfigure::Plan;
use steadfast::reconfigure::replay::{Failure, Fault};
use steadfast::statics::Verdict;

use crate::arguments::VerifyArguments;
use crate::exit::Exit;
use crate::family::Family;
use crate::{files, output};

/// How many of a certificate's faults are shown.
const SHOWN: usize = 5;

/// Verifies a plan or a certificate, by what the file says that it is.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &VerifyArguments) -> io::Result<Exit> {
    let file = files::read(&arguments.file);
    match read_verifiable(&file) {
        Ok(Verifiable::Plan(document)) => plans(&file.name, &document),
        Ok(Verifiable::LinkagePlan(document)) => plans(&file.name, &document),
        Ok(Verifiable::Certificate(document)) => certificate(&document),
        Err(diagnostics) => output::bad_input(&diagnostics, false),
    }
}

/// Checks a certificate and reports what it proves, or what is wrong with it.
fn certificate(document: &CertificateDocument) -> io::Result<Exit> {
    match check(&document.certificate) {
        Ok(proof) => {
            let claimed = document.certificate.utilisation;
            let verdict = match document.certificate.verdict {
                Verdict::Stable => "stable",
                Verdict::InternallyUnstable => "internally unstable",
                Verdict::WholeBodyUnstable => "whole-body unstable",
                Verdict::Undecided => "undecided",
            };
            let between = match claimed.lower == f64::INFINITY {
                true => "no strength of the connections helps".to_string(),
                false => format!("utilisation between {} and {}", claimed.lower, claimed.upper),
            };
            let data = match proof.forgiven == 0.0 {
                true => "for the data to the last bit".to_string(),
                false => format!("for data meant up to a relative {:.0e}", proof.forgiven),
            };
            output::result(&format!("VERIFIED: {verdict}, {between}\nproved {data}\n"))?;
            Ok(Exit::Yes)
        }
        Err(faults) => {
            let mut text = "NOT VERIFIED\n".to_string();
            for fault in faults.iter().take(SHOWN) {
                text.push_str(&format!("  {}\n", document.sentence(fault)));
            }
            if faults.len() > SHOWN {
                text.push_str(&format!("  and {} more\n", faults.len() - SHOWN));
            }
            output::result(&text)?;
            Ok(Exit::No)
        }
    }
}

/// All that a plan file says.
type Document<F> = PlanDocument<F, <F as Family>::Action, <F as Family>::Connection>;

/// Replays every plan of a file and reports the first thing wrong with each, and all of it.
fn plans<F: Family>(name: &str, document: &Document<F>) -> io::Result<Exit> {
    if document.plans().next().is_none() {
        output::result("NOTHING TO VERIFY: the file holds no plan\n")?;
        return Ok(Exit::Undecided);
    }
    let mut exit = Exit::Yes;
    let mut text = String::new();
    for (index, plan) in document.plans().enumerate() {
        if index > 0 {
            text.push_str(&format!("\nalternative {index}: "));
        }
        match verify(document, index, plan) {
            Ok((verdict, verified)) => {
                text.push_str(&verdict);
                if !verified {
                    exit = Exit::No;
                }
            }
            Err(problem) => {
                return output::refused(name, [problem], false);
            }
        }
    }
    output::result(&text)?;
    Ok(exit)
}

/// The verdict on one of the file's plans, for people, and whether it verifies.
fn verify<F: Family>(
    document: &Document<F>,
    index: usize,
    plan: &Plan<F::Action, F::Connection>,
) -> Result<(String, bool), String> {
    let problem = &document.problem;
    let required = document.report.required.unwrap_or(problem.required());
    let found = problem.replay(plan, required).map_err(|refusal| refusal.to_string())?;
    let contradictions: Vec<_> = document.contradictions_of(index).collect();
    if found.is_verified() && contradictions.is_empty() {
        let (states, margin) = (found.oracle_solves, found.margin.lower);
        let text = format!(
            "VERIFIED: {} actions replayed over {states} states, smallest margin {margin:.4}\n",
            found.actions_replayed
        );
        return Ok((text, true));
    }
    let mut text = "NOT VERIFIED\n".to_string();
    for contradiction in contradictions {
        let action = problem.action(&plan.actions[contradiction.action].action);
        text.push_str(&format!("  action {} ({action}): {contradiction}\n", contradiction.action + 1));
    }
    for failure in &found.failures {
        text.push_str(&format!("  {}\n", sentence(problem, Some(plan), failure)));
    }
    Ok((text, false))
}

/// A failure in one sentence: which action, how far, what is wrong, what gives way.
pub fn sentence<F: Family>(
    problem: &F,
    plan: Option<&Plan<F::Action, F::Connection>>,
    failure: &Failure<F::Connection, F::Touched>,
) -> String {
    let action = failure.action.and_then(|index| Some((index, plan?.actions.get(index)?)));
    let mut sentence = match action {
        Some((index, planned)) => format!("action {} ({})", index + 1, problem.action(&planned.action)),
        None => "the plan".to_string(),
    };
    if let Some(phase) = failure.phase.filter(|phase| *phase < 1.0) {
        sentence.push_str(&format!(" at {:.0} % of the way", 100.0 * phase));
    }
    match &failure.fault {
        Fault::Collision { with } => sentence.push_str(&format!(": it collides with {}", problem.touched(with))),
        fault => sentence.push_str(&format!(": {fault}")),
    }
    if let (Fault::Unstable { .. }, Some(held)) = (&failure.fault, &failure.connection) {
        sentence.push_str(&format!("; {} gives way", problem.held(held)));
    }
    sentence
}
