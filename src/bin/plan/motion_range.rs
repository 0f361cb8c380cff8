//! `plan motion-range CONFIG`

use std::fmt::Write;
use std::io;
use std::path::Path;
use std::time::Instant;

use steadfast::io::{Checkable, read_checkable};
use steadfast::reconfigure::linkage::{Half, MotionRange, NotABridge, Stand, Turning, motion_range};
use steadfast::robot::linkage::{Connection, Linkage, Port};
use steadfast::statics::Verdict;

use crate::arguments::MotionRangeArguments;
use crate::exit::Exit;
use crate::{files, output, polar_map};

/// Maps where one connection or joint may stand and reports on it.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &MotionRangeArguments) -> io::Result<Exit> {
    let file = files::read(&arguments.file);
    let linkage = match read_checkable(&file, &files::resolve) {
        Ok(Checkable::Linkage(linkage)) => linkage,
        Ok(Checkable::Configuration(_)) => {
            let problem = "modules of a lattice slide and pivot as a whole: there is no range to map";
            return output::refused(&file.name, [problem.to_string()], false);
        }
        Ok(Checkable::Structure(_)) => {
            let problem = "a structure has no ports and joints: give a configuration";
            return output::refused(&file.name, [problem.to_string()], false);
        }
        Err(diagnostics) => return output::bad_input(&diagnostics, false),
    };
    let what = match (&arguments.connection, &arguments.joint) {
        (Some(pair), _) => connection(&linkage, pair),
        (None, Some(name)) => joint(&linkage, name),
        (None, None) => unreachable!("the arguments require one of the two"),
    };
    let ways = match what {
        Ok(ways) => ways,
        Err(problem) => return output::refused(&file.name, [problem], false),
    };
    let clock = Instant::now();
    // The side that is named first moves, unless it cannot.
    let mut found = motion_range(&linkage, ways[0], arguments.step);
    if found == Err(NotABridge::Fixed) {
        found = motion_range(&linkage, ways[1], arguments.step);
    }
    let range = match found {
        Ok(range) => range,
        Err(problem) => return output::refused(&file.name, [problem.to_string()], false),
    };
    let is_joint = arguments.joint.is_some();
    for (out, text) in [(&arguments.csv, csv(&range, is_joint)), (&arguments.svg, polar_map::picture(&range, is_joint))]
    {
        if let Some(out) = out
            && let Err(trouble) = save(out, &text)
        {
            output::message(&format!("error: {}: {trouble}", out.display()))?;
            return Ok(Exit::BadInput);
        }
    }
    output::result(&told(&range, is_joint, clock.elapsed().as_secs_f64()))?;
    Ok(match () {
        () if range.stands.iter().any(stands) => Exit::Yes,
        () if range.stands.iter().any(|stand| stand.verdict == Verdict::Undecided) => Exit::Undecided,
        () => Exit::No,
    })
}

fn save(path: &Path, text: &str) -> io::Result<()> {
    if path.as_os_str() == "-" { output::result(text) } else { std::fs::write(path, text) }
}

/// The connection of two modules or ports, with either side as the one that moves.
fn connection(linkage: &Linkage, pair: &str) -> Result<[Turning; 2], String> {
    let (a, b) = pair.split_once(',').ok_or("a connection is two modules or ports with a comma between, e.g. s1,n2")?;
    let [a, b] = [a, b].map(|name| named(linkage, name.trim()));
    let ((a, port_a), (b, port_b)) = (a?, b?);
    let fits =
        |own: Port, module: usize, port: Option<usize>| own.module == module && port.is_none_or(|p| p == own.port);
    let mut found = linkage.connections.iter().filter(|connection| {
        let [x, y] = connection.ports;
        (fits(x, a, port_a) && fits(y, b, port_b)) || (fits(y, a, port_a) && fits(x, b, port_b))
    });
    let connection: Connection = *found.next().ok_or_else(|| format!("`{pair}` is not an engaged connection"))?;
    if found.next().is_some() {
        return Err(format!("`{pair}` means several connections: name their ports, e.g. s1:top,n2:surface"));
    }
    Ok([a, b].map(|carried| Turning::Roll { connection, carried }))
}

/// The module, and the port if one is named.
fn named(linkage: &Linkage, name: &str) -> Result<(usize, Option<usize>), String> {
    let find = |id: &str| linkage.modules.iter().position(|module| module.id == id);
    if let Some(module) = find(name) {
        return Ok((module, None));
    }
    let (id, port) = name.rsplit_once(':').unwrap_or((name, ""));
    let module = find(id).ok_or_else(|| format!("there is no module `{id}`"))?;
    let kind = linkage.module_type(module);
    let index = kind.port(port).ok_or_else(|| format!("`{id}` has no port `{port}`"))?;
    Ok((module, Some(index)))
}

/// The joint called `module.joint`, with either side as the one that moves.
fn joint(linkage: &Linkage, name: &str) -> Result<[Turning; 2], String> {
    let (id, joint) = name.rsplit_once('.').ok_or("a joint is a module, a dot and its name, e.g. a.alpha")?;
    let module = linkage.modules.iter().position(|module| module.id == id);
    let module = module.ok_or_else(|| format!("there is no module `{id}`"))?;
    let index = linkage.module_type(module).joint(joint).ok_or_else(|| format!("`{id}` has no joint `{joint}`"))?;
    Ok([Half::Child, Half::Parent].map(|carried| Turning::Rotate { module, joint: index, carried }))
}

/// Whether the robot can be there.
pub fn stands(stand: &Stand) -> bool {
    stand.verdict == Verdict::Stable && !stand.overlaps
}

fn csv(range: &MotionRange, is_joint: bool) -> String {
    let columns = if is_joint { "position_deg" } else { "azimuth_deg,polar_deg" };
    let mut text = format!("{columns},overlaps,verdict,margin_lower,margin_upper\n");
    for stand in &range.stands {
        let at = if is_joint { stand.at[0].to_string() } else { format!("{},{}", stand.at[0], stand.at[1]) };
        let verdict = match stand.verdict {
            Verdict::Stable => "stable",
            Verdict::InternallyUnstable => "internally-unstable",
            Verdict::WholeBodyUnstable => "whole-body-unstable",
            Verdict::Undecided => "undecided",
        };
        let (lower, upper) = (stand.margin.lower, stand.margin.upper);
        let _ = writeln!(text, "{at},{},{verdict},{lower},{upper}", stand.overlaps);
    }
    text
}

fn told(range: &MotionRange, is_joint: bool, seconds: f64) -> String {
    let place = |at: [f64; 2]| {
        if is_joint { format!("{}°", at[0]) } else { format!("azimuth {}°, polar {}°", at[0], at[1]) }
    };
    let free = range.stands.iter().filter(|stand| !stand.overlaps).count();
    let standing: Vec<&Stand> = range.stands.iter().filter(|stand| stands(stand)).collect();
    let mut text = format!(
        "{} of {} positions stand ({} overlap something), {}° apart\nnow at {}\n",
        standing.len(),
        range.stands.len(),
        range.stands.len() - free,
        range.step_degrees,
        place(range.present),
    );
    let by_margin = |a: &&&Stand, b: &&&Stand| a.margin.lower.total_cmp(&b.margin.lower);
    for (name, stand) in
        [("largest", standing.iter().max_by(by_margin)), ("smallest", standing.iter().min_by(by_margin))]
    {
        if let Some(stand) = stand {
            let _ = writeln!(text, "{name:<8} margin {:.4} at {}", stand.margin.lower, place(stand.at));
        }
    }
    let _ = writeln!(text, "{:.2} ms", seconds * 1e3);
    text
}
