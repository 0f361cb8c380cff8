//! `plan load-range FILE`

use std::fmt::Write;
use std::io;
use std::time::Instant;

use steadfast::io::{Checkable, LoadRangeReport, NamedStructure, read_checkable, write_load_range};
use steadfast::spatial::{Point, Pose, Vec3};
use steadfast::statics::{LoadRange, RangeEnd, UnitForce, Verdict, load_range};

use crate::arguments::LoadRangeArguments;
use crate::exit::Exit;
use crate::gives_way::{gives_way, listed};
use crate::{files, output};

/// Finds the range of a force and reports on it.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &LoadRangeArguments) -> io::Result<Exit> {
    let file = files::read(&arguments.file);
    let (named, frames) = match read_checkable(&file, &files::resolve) {
        Ok(checkable) => framed(checkable),
        Err(diagnostics) => return output::bad_input(&diagnostics, arguments.json),
    };
    // Of a module of several bodies, which are called `module.body`, the first one.
    let first_of = format!("{}.", arguments.module);
    let named_so = |id: &String| *id == arguments.module;
    let body = named.bodies.iter().position(named_so);
    let Some(body) = body.or_else(|| named.bodies.iter().position(|id| id.starts_with(&first_of))) else {
        let ids: Vec<&str> = named.bodies.iter().map(String::as_str).collect();
        let problem = format!("there is no module or body `{}`; there are {}", arguments.module, listed(&ids));
        return output::refused(&file.name, [problem], arguments.json);
    };
    let at = arguments.at.map(|at| in_world(frames.get(body), at.into()));
    let force = UnitForce { body, direction: arguments.direction.into(), at };
    let clock = Instant::now();
    let range = match load_range(&named.structure, &force, 1.0 - arguments.margin) {
        Ok(range) => range,
        Err(problems) => {
            let reasons = problems.iter().map(|problem| format!("{}: {}", problem.place, problem.problem));
            return output::refused(&file.name, reasons, arguments.json);
        }
    };
    let report = LoadRangeReport {
        force: &force,
        range: &range,
        margin: arguments.margin,
        seconds: clock.elapsed().as_secs_f64(),
    };
    if arguments.json {
        match write_load_range(&named, &report) {
            Ok(text) => output::result(&text)?,
            Err(problem) => return output::refused(&file.name, [problem.to_string()], true),
        }
    } else {
        output::result(&told(&named, &report))?;
    }
    Ok(match &range {
        LoadRange::Between { lowest, highest } if lowest.is_decided() && highest.is_decided() => Exit::Yes,
        LoadRange::Between { .. } | LoadRange::Undecided { .. } => Exit::Undecided,
        LoadRange::Nowhere { .. } => Exit::No,
    })
}

/// The structure of what was read, with the poses of its bodies' frames in W; of a structure, whose points are
/// in W already, none.
fn framed(checkable: Checkable) -> (NamedStructure, Vec<Pose>) {
    match checkable {
        Checkable::Structure(named) => (named, Vec::new()),
        Checkable::Configuration(configuration) => {
            let frames = (0..configuration.modules.len()).map(|module| configuration.pose(module)).collect();
            (NamedStructure::of_configuration(&configuration), frames)
        }
        Checkable::Linkage(linkage) => {
            let frames = (0..linkage.modules.len()).flat_map(|module| linkage.body_poses(module)).collect();
            (NamedStructure::of_linkage(&linkage), frames)
        }
    }
}

/// A point given in a body's frame, in W.
fn in_world(frame: Option<&Pose>, at: Vec3) -> Vec3 {
    frame.map_or(at, |frame| (frame * Point::from(at)).coords)
}

fn told(named: &NamedStructure, report: &LoadRangeReport<'_>) -> String {
    let mut text = String::new();
    let id = &named.bodies[report.force.body];
    let leaving =
        if report.margin == 0.0 { String::new() } else { format!(" with a margin of at least {}", report.margin) };
    match report.range {
        LoadRange::Between { lowest, highest } => {
            let _ = writeln!(text, "RANGE: {id} withstands {} to {}{leaving}", side(lowest), side(highest));
            if report.range.contains(0.0) == Some(false) {
                text.push_str("it does not stand without the force\n");
            }
            for (name, end) in [("lowest", lowest), ("highest", highest)] {
                let _ = writeln!(text, "\n{name:<8} {}", exactly(end));
                text.push_str(&failure(named, end));
            }
        }
        LoadRange::Nowhere { best } => {
            let _ = writeln!(text, "NOWHERE: no force along this line lets it stand{leaving}");
            if best.verdict == Verdict::WholeBodyUnstable {
                text.push_str("it tips, slides or falls, however large the force\n");
            } else {
                let _ = writeln!(text, "the least utilisation over all forces is {:.6}", best.utilisation.lower);
            }
            text.push_str(&gives_way(named, best));
        }
        LoadRange::Undecided { because } => {
            let _ = writeln!(text, "UNDECIDED: {because}");
        }
    }
    let _ = writeln!(text, "\n{:.2} ms", report.seconds * 1e3);
    text
}

/// An end in a few words.
fn side(end: &RangeEnd) -> String {
    match () {
        () if end.is_unlimited() => "any force".to_owned(),
        () if end.is_decided() => format!("{:.4} N", 0.5 * (end.force.lower + end.force.upper)),
        () => "an end that is not quite known".to_owned(),
    }
}

fn exactly(end: &RangeEnd) -> String {
    let force = end.force;
    match () {
        () if end.is_unlimited() => "without end: the force alone demands nothing of any connection".to_owned(),
        () if !force.lower.is_finite() => format!("somewhere below {:.6} N", force.upper),
        () if !force.upper.is_finite() => format!("somewhere above {:.6} N", force.lower),
        () if end.is_decided() => {
            format!("{:.6} N  (proved within {:.0e})", 0.5 * (force.lower + force.upper), force.width())
        }
        () => format!("between {:.9} and {:.9} N", force.lower, force.upper),
    }
}

/// What fails beyond an end.
fn failure(named: &NamedStructure, end: &RangeEnd) -> String {
    let Some(beyond) = &end.beyond else { return String::new() };
    let how = match beyond.verdict {
        Verdict::WholeBodyUnstable => "beyond it, it tips, slides or falls as a whole\n",
        Verdict::InternallyUnstable => "beyond it, some connection must break\n",
        Verdict::Stable | Verdict::Undecided => "beyond it, less margin is left\n",
    };
    how.to_owned() + &gives_way(named, beyond)
}
