//! One job, in a process of its own: what becomes known goes to standard output, its plan to a file.

use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use steadfast::generate::Pair;
use steadfast::io::{
    LatticeProblem, LinkageProblem, PlanDocument, Unwritable, write_linkage_plan, write_plan, write_point, write_result,
};
use steadfast::suite::{AnyPlan, Job, Run, Watch, run as run_job};

use super::directory::plan_path;
use crate::exit::Exit;
use crate::{files, memory, output};

/// Address space that a process takes beyond what it allocates: code, stacks, the allocator's arenas.
#[cfg(unix)]
const OVERHEAD: u64 = 768 << 20;

/// Runs the job of this name.
///
/// # Errors
/// The output cannot be written.
pub fn run(jobs: &[Job], name: &str, folder: &Path) -> io::Result<Exit> {
    let Some(job) = jobs.iter().find(|job| job.name() == name) else {
        output::message(&format!("error: the suite has no job {name}"))?;
        return Ok(Exit::BadInput);
    };
    limit_memory(job.bytes);
    // Nobody listens any more: stop.
    let cancel = Arc::new(AtomicBool::new(false));
    let say = |line: &str| {
        let mut out = io::stdout().lock();
        if out.write_all(line.as_bytes()).and_then(|()| out.flush()).is_err() {
            cancel.store(true, Ordering::SeqCst);
        }
    };
    let mut on_point = |point: &_| {
        if let Ok(line) = write_point(point) {
            say(&line);
        }
    };
    // The best plan so far is on file, whatever becomes of this process.
    let mut on_plan = |pair: &Pair, answer: &AnyPlan| {
        if let Ok(text) = document(pair, answer) {
            let _ = files::save(&plan_path(folder, name), &text);
        }
    };
    let mut watch = Watch {
        on_point: &mut on_point,
        on_plan: &mut on_plan,
        measure_bytes: Some(memory::in_use),
        cancel: Some(Arc::clone(&cancel)),
    };
    let Run { mut record, answer } = run_job(job, &mut watch);
    if let Some((pair, answer)) = answer.filter(|_| record.found.is_some()) {
        match document(&pair, &answer) {
            Ok(text) => files::save(&plan_path(folder, name), &text)?,
            Err(trouble) => {
                output::message(&format!("bug: the plan cannot be written: {trouble}"))?;
                return Ok(Exit::Bug);
            }
        }
    }
    record.peak_bytes = peak_bytes();
    match write_result(job, &record) {
        Ok(line) => say(&line),
        Err(trouble) => {
            output::message(&format!("bug: the result cannot be written: {trouble}"))?;
            return Ok(Exit::Bug);
        }
    }
    Ok(Exit::Yes)
}

fn document(pair: &Pair, answer: &AnyPlan) -> Result<String, Unwritable> {
    match (pair, answer) {
        (Pair::Lattice { start, goal }, AnyPlan::Lattice(report)) => {
            let problem = LatticeProblem { start: start.clone(), goal: goal.clone() };
            write_plan(&PlanDocument::new(problem, report))
        }
        (Pair::Linkage { start, goal }, AnyPlan::Linkage(report)) => {
            let problem = LinkageProblem { start: start.clone(), goal: goal.clone() };
            write_linkage_plan(&PlanDocument::new(problem, report))
        }
        (Pair::Lattice { .. }, AnyPlan::Linkage(_)) | (Pair::Linkage { .. }, AnyPlan::Lattice(_)) => {
            unreachable!("an answer is for its own problem")
        }
    }
}

/// Makes the system refuse memory beyond the limit, which ends the process. The search itself stops before, as far as
/// its own books tell.
#[cfg(unix)]
fn limit_memory(bytes: u64) {
    let most = bytes.saturating_add(OVERHEAD);
    // Where the system has no such limit, the search's own books are all there is.
    let _ = rlimit::setrlimit(rlimit::Resource::AS, most, most);
}

#[cfg(not(unix))]
fn limit_memory(_bytes: u64) {}

/// Peak memory of this process in bytes, where the system tells.
fn peak_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes << 10)
}
