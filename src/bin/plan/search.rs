//! `plan START GOAL`

use std::io;
use std::process;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use steadfast::io::{Problem, read_problem};
use steadfast::reconfigure::{Method, Objective, Options, Outcome, Reduction, Refusal};

use crate::arguments::{ObjectiveArgument, PlannerArgument, PlanningArguments};
use crate::exit::Exit;
use crate::family::{Answer, Check, Family};
use crate::progress::ProgressLine;
use crate::summary::summary;
use crate::{files, memory, output, profile, restrictions};

/// Exit code of a program that a second Ctrl-C ended at once.
const INTERRUPTED: i32 = 130;

/// Plans, verifies what was found, and reports.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &PlanningArguments) -> io::Result<Exit> {
    match read(arguments)? {
        Ok(Problem::Lattice(problem)) => plan(arguments, &problem),
        Ok(Problem::Linkage(problem)) => plan(arguments, &problem),
        Err(exit) => Ok(exit),
    }
}

fn plan<F: Family>(arguments: &PlanningArguments, problem: &F) -> io::Result<Exit> {
    let mut report = match search(arguments, problem) {
        Ok(Ok(report)) => report,
        Ok(Err(refusal)) => {
            let file = arguments.start.display().to_string();
            return output::refused(&file, [refusal.to_string()], arguments.json);
        }
        Err(trouble) => {
            output::message(&format!("error: {trouble}"))?;
            return Ok(Exit::BadInput);
        }
    };
    // Replayed by the code that shares no decision with the search.
    let required = report.required.unwrap_or(problem.required());
    let check = match appraise(problem, &mut report, required) {
        Ok(checks) => checks,
        Err(refusal) => {
            output::message(&format!("error: {refusal}"))?;
            return Ok(Exit::Bug);
        }
    };
    let document = match problem.write(&report) {
        Ok(document) => document,
        Err(trouble) => {
            output::message(&format!("bug: the plan cannot be written: {trouble}"))?;
            return Ok(Exit::Bug);
        }
    };
    if let Some(path) = &arguments.profile
        && let Some(plan) = &report.plan
    {
        let names: Vec<String> = plan.actions.iter().map(|planned| problem.action(&planned.action)).collect();
        if let Err(trouble) = files::save(path, &profile::text(path, plan, &names)) {
            output::message(&format!("error: {}: {trouble}", path.display()))?;
            output::result(&document)?;
            return Ok(Exit::BadInput);
        }
    }
    if let Some(out) = &arguments.out
        && let Err(trouble) = files::save(out, &document)
    {
        output::message(&format!("error: {}: {trouble}", out.display()))?;
        output::result(&document)?;
        return Ok(Exit::BadInput);
    }
    let text = if arguments.json { document } else { summary(problem, &report, check.as_ref()) };
    output::result(&text)?;
    if let Some(check) = &check
        && !arguments.ignore_stability
        && !check.is_verified()
    {
        output::message("bug: the replay does not confirm the plan; please report the two input files")?;
        return Ok(Exit::Bug);
    }
    Ok(match (&report.outcome, &report.plan) {
        (_, Some(_)) => Exit::Yes,
        (Outcome::Impossible(_), None) => Exit::No,
        (Outcome::Solved | Outcome::OutOfBudget(_), None) => Exit::Undecided,
    })
}

/// Replays every plan, the best one first, and notes what the replays say of them. The failure of the plan
/// that does worst is what is returned: the best one, unless another one does not verify.
fn appraise<F: Family>(problem: &F, report: &mut Answer<F>, required: f64) -> Result<Option<Check<F>>, Refusal> {
    let mut first = None;
    for plan in report.plan.iter_mut().chain(&mut report.alternatives) {
        let replay = problem.replay(plan, required)?;
        if plan.margin.is_some() {
            *plan = problem.appraise(plan, &replay)?;
        }
        if first.as_ref().is_none_or(|first: &Check<F>| first.is_verified() && !replay.is_verified()) {
            first = Some(replay);
        }
    }
    if let Some(found) = &mut report.in_the_way
        && let Some(plan) = &mut found.plan
    {
        let replay = problem.replay(plan, f64::NEG_INFINITY)?;
        *plan = problem.appraise(plan, &replay)?;
        found.weigh(&replay, required);
    }
    Ok(first)
}

fn read(arguments: &PlanningArguments) -> io::Result<Result<Problem, Exit>> {
    let (start, goal) = (files::read(&arguments.start), files::read(&arguments.goal));
    match read_problem(&start, &goal, &files::resolve) {
        Ok(mut problem) => match restrictions::apply(arguments, &mut problem) {
            Ok(()) => Ok(Ok(problem)),
            Err(trouble) => output::refused(&start.name, [trouble], arguments.json).map(Err),
        },
        Err(diagnostics) => output::bad_input(&diagnostics, arguments.json).map(Err),
    }
}

/// Searches in a pool of the wanted size, until done, out of time, or interrupted.
fn search<F: Family>(arguments: &PlanningArguments, problem: &F) -> Result<Result<Answer<F>, Refusal>, String> {
    let options = Options {
        objective: match arguments.objective {
            ObjectiveArgument::Margin => Objective::Margin,
            ObjectiveArgument::Moves => Objective::Moves,
            ObjectiveArgument::Pareto => Objective::Pareto,
        },
        min_margin: arguments.min_margin,
        plans: arguments.plans as usize,
        time_limit: arguments.time_limit,
        max_bytes: arguments.memory_limit.or_else(memory::half_of_the_machine),
        measure_bytes: Some(memory::in_use),
        cancel: Some(cancelled_by_interrupt()?),
        explain: true,
        ignore_stability: arguments.ignore_stability,
        reduction: if arguments.primitive { Reduction::Primitive } else { Reduction::Saturated },
        method: match arguments.planner {
            PlannerArgument::Auto => Method::Auto,
            PlannerArgument::Exact => Method::Exact,
            PlannerArgument::Decompose => Method::Decompose,
        },
        seed: arguments.seed,
        ..Options::default()
    };
    let threads = arguments.threads.map_or(0, usize::from);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
    let mut line = ProgressLine::new();
    let report = pool.install(|| problem.solve(&options, &mut |event| line.show(event)));
    line.clear();
    Ok(report)
}

/// A flag that the first Ctrl-C raises; the second one ends the program.
pub fn cancelled_by_interrupt() -> Result<Arc<AtomicBool>, String> {
    let cancel = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&cancel);
    let on_interrupt = move || {
        if raised.swap(true, Ordering::SeqCst) {
            process::exit(INTERRUPTED);
        }
    };
    ctrlc::set_handler(on_interrupt).map_err(|error| error.to_string())?;
    Ok(cancel)
}
