//! `plan bench`
//!
//! Every job runs in a process of its own: a crash or an exhausted memory costs one job, the memory limit is one
//! that the system enforces, and the time of a job does not depend on what the others hold in their caches. What a job
//! finds comes back over its standard output, its plan as a file; plans are replayed here, from that file.

mod arguments;
mod directory;
mod figures;
mod job;
mod pool;
mod report;
mod settle;

use std::io;

use steadfast::io::read_suite;
use steadfast::suite::summary::Entry;

use crate::exit::Exit;
use crate::{files, output};
pub use arguments::Arguments;
use directory::{Directory, Trouble};

/// Runs what is left of a suite, and reports on all of it.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &Arguments) -> io::Result<Exit> {
    let suite = match read_suite(&files::read(&arguments.suite)) {
        Ok(suite) => suite,
        Err(diagnostics) => return output::bad_input(&diagnostics, false),
    };
    let jobs = suite.jobs();
    if let Some(name) = &arguments.job {
        return job::run(&jobs, name, &arguments.out);
    }
    let mut directory = match Directory::open(&arguments.out, &jobs) {
        Ok(directory) => directory,
        Err(Trouble::Results(diagnostics)) => return output::bad_input(&diagnostics, false),
        Err(Trouble::Other(trouble)) => {
            output::message(&format!("error: {trouble}"))?;
            return Ok(Exit::BadInput);
        }
    };
    if directory.cut_off > 0 {
        let bytes = directory.cut_off;
        output::message(&format!("the last line was half written: {bytes} bytes taken away, its job runs again"))?;
    }
    let at_once = arguments.jobs.map_or_else(cores, usize::from);
    directory.note_machine(at_once)?;
    let left: Vec<_> = jobs.iter().filter(|job| directory.record(job).is_none()).collect();
    output::message(&format!("{} jobs, {} of them finished already", jobs.len(), jobs.len() - left.len()))?;
    let crew = pool::Crew { suite: &suite, arguments, at_once };
    let interrupted = match crew.work(&left, &mut directory) {
        Ok(interrupted) => interrupted,
        Err(trouble) => {
            output::message(&format!("error: {trouble}"))?;
            return Ok(Exit::BadInput);
        }
    };
    let entries: Vec<Entry<'_>> =
        jobs.iter().filter_map(|job| Some(Entry { job, record: directory.record(job)? })).collect();
    let report =
        report::Report { suite: &suite, jobs: jobs.len(), machines: &directory.machines()?, entries: &entries };
    report.write(&arguments.out)?;
    output::result(&report.headline())?;
    let place = arguments.out.join("report.md");
    output::result(&format!("report: {}\n", place.display()))?;
    let refuted = report.refuted();
    if refuted > 0 {
        output::message(&format!("bug: replays refute {refuted} plans; please report results.jsonl"))?;
        return Ok(Exit::Bug);
    }
    Ok(if interrupted || entries.len() < jobs.len() { Exit::Undecided } else { Exit::Yes })
}

/// How many jobs run at once unless it is said.
fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}
