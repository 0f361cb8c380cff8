//! The planner on every planning problem of the library: a test for each
//! question. Every plan that is found is replayed.

use std::time::Duration;

use libtest_mimic::{Arguments, Failed, Trial};
use problems::{ByGeometry, FewestMoves, LargestMargin, PlanningCase};
use steadfast::io::{LatticeProblem, PlanDocument, SourceFile, read_plan, read_problem, write_plan};
use steadfast::reconfigure::replay::{Fault, replay};
use steadfast::reconfigure::{MARGIN_TOLERANCE, Objective, Options, Outcome, Plan, Reduction, Report, solve};

/// Problems with at most this many modules are also searched action by action.
const SMALL: usize = 5;

/// Nothing may take this long; reached, it fails the test by an unproved outcome.
const TIME_LIMIT: Duration = Duration::from_secs(600);

fn main() {
    let manifest = problems::manifest().expect("the manifest is sound");
    let trials = manifest.cubes.into_iter().flat_map(|(name, case)| trials(&name, &case)).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// A question to a problem.
type Question = Box<dyn FnOnce(&LatticeProblem) -> Result<(), Failed> + Send>;

fn trials(name: &str, case: &PlanningCase) -> Vec<Trial> {
    let mut trials = Vec::new();
    let mut add = |question: &str, test: Question| {
        let problem = name.to_string();
        trials.push(Trial::test(format!("{name}::{question}"), move || test(&read(&problem)?)));
    };
    let (modules, moves) = (case.modules, case.moves.clone());
    add("modules", Box::new(move |problem| is(problem.start.modules.len(), modules)));
    add("moves", Box::new(move |problem| fewest(problem, &moves, Reduction::Saturated)));
    add("threads", Box::new(same_on_any_number_of_threads));
    if let Some(margin) = case.margin.clone() {
        add("margin", Box::new(move |problem| widest(problem, &margin, Reduction::Saturated).map(drop)));
    }
    if case.modules <= SMALL {
        let moves = case.moves.clone();
        add("moves_by_single_actions", Box::new(move |problem| fewest(problem, &moves, Reduction::Primitive)));
        if let Some(margin) = case.margin.clone() {
            add("margin_by_single_actions", Box::new(move |problem| agree(problem, &margin)));
        }
    }
    if let Some(expected) = case.by_geometry.clone() {
        add("by_geometry", Box::new(move |problem| by_geometry(problem, &expected)));
    }
    if let Some(plans) = case.plans {
        add("plans", Box::new(move |problem| several(problem, plans)));
    }
    trials
}

fn read(name: &str) -> Result<LatticeProblem, Failed> {
    let directory = problems::root().join("cubes").join(name);
    let file = |which: &str| std::fs::read(directory.join(which)).map(|bytes| SourceFile::new(which, bytes));
    let beside = |_: &str, name: &str| {
        let bytes = std::fs::read(directory.join(name)).map_err(|error| error.to_string())?;
        Ok(SourceFile::new(name, bytes))
    };
    let problem = read_problem(&file("start.json")?, &file("goal.json")?, &beside)?;
    problem.into_lattice().ok_or_else(|| "not all modules sit in a lattice".into())
}

fn search(problem: &LatticeProblem, options: Options) -> Result<Report, Failed> {
    let options = Options { time_limit: Some(TIME_LIMIT), ..options };
    let report = solve(&problem.start, &problem.goal, &options, &mut |_| {}).map_err(|refusal| refusal.to_string())?;
    if let Some(required) = report.required {
        for plan in report.plan.iter().chain(&report.alternatives) {
            verify(problem, plan, required)?;
        }
        reads_back_and_verifies(problem, &report)?;
    }
    Ok(report)
}

fn verify(problem: &LatticeProblem, plan: &Plan, required: f64) -> Result<(), Failed> {
    let check = replay(&problem.start, &problem.goal, plan, required).map_err(|refusal| refusal.to_string())?;
    if check.is_verified() { Ok(()) } else { Err(format!("not verified: {:?}", check.failures).into()) }
}

/// The plan file says the same as the plan.
fn reads_back_and_verifies(problem: &LatticeProblem, report: &Report) -> Result<(), Failed> {
    let text = write_plan(&PlanDocument::new(problem.clone(), report)).map_err(|trouble| trouble.to_string())?;
    let document = read_plan(&SourceFile::new("plan.json", text))?;
    is(&document.report.plan, &report.plan)?;
    is(&document.report.outcome, &report.outcome)
}

fn is<T: PartialEq + std::fmt::Debug>(found: T, expected: T) -> Result<(), Failed> {
    if found == expected { Ok(()) } else { Err(format!("expected {expected:?}, found {found:?}").into()) }
}

fn fewest(problem: &LatticeProblem, expected: &FewestMoves, reduction: Reduction) -> Result<(), Failed> {
    let report = search(problem, Options { objective: Objective::Moves, reduction, ..Options::default() })?;
    let outcome = match report.outcome {
        Outcome::Solved => "solved",
        Outcome::Impossible(_) => "impossible",
        Outcome::OutOfBudget(_) => "out of budget",
    };
    is(outcome, expected.outcome.as_str())?;
    is(report.plan.as_ref().map(|plan| plan.moves), expected.moves)?;
    is(report.proof.optimal, expected.moves.is_some())
}

fn widest(problem: &LatticeProblem, expected: &LargestMargin, reduction: Reduction) -> Result<f64, Failed> {
    let report = search(problem, Options { objective: Objective::Margin, reduction, ..Options::default() })?;
    is(&report.outcome, &Outcome::Solved)?;
    is(report.proof.optimal, true)?;
    let plan = report.plan.ok_or("solved, but without a plan")?;
    is(plan.moves, expected.moves)?;
    let margin = plan.margin.ok_or("planned with stability, but without a margin")?;
    if let Some(value) = expected.value
        && !((margin.lower - value).abs() <= MARGIN_TOLERANCE && (margin.upper - value).abs() <= MARGIN_TOLERANCE)
    {
        return Err(format!("expected a margin of {value}, found {margin:?}").into());
    }
    Ok(margin.lower)
}

/// The search over single actions finds the same margin.
fn agree(problem: &LatticeProblem, expected: &LargestMargin) -> Result<(), Failed> {
    let saturated = widest(problem, expected, Reduction::Saturated)?;
    let primitive = widest(problem, expected, Reduction::Primitive)?;
    if (saturated - primitive).abs() <= 2.0 * MARGIN_TOLERANCE {
        Ok(())
    } else {
        Err(format!("{saturated} by moves, {primitive} by single actions").into())
    }
}

fn by_geometry(problem: &LatticeProblem, expected: &ByGeometry) -> Result<(), Failed> {
    let options = Options { objective: Objective::Moves, ignore_stability: true, ..Options::default() };
    let report = search(problem, options)?;
    let plan = report.plan.ok_or("no plan by geometry")?;
    is(plan.moves, expected.moves)?;
    let check = replay(&problem.start, &problem.goal, &plan, 0.0).map_err(|refusal| refusal.to_string())?;
    is(check.is_verified(), !expected.breaks)?;
    let only_unstable = check.failures.iter().all(|failure| matches!(failure.fault, Fault::Unstable { .. }));
    is(only_unstable, true)
}

fn several(problem: &LatticeProblem, at_least: usize) -> Result<(), Failed> {
    let options = Options { objective: Objective::Moves, plans: at_least, ..Options::default() };
    let report = search(problem, options)?;
    let best = report.plan.ok_or("no plan")?;
    is(1 + report.alternatives.len(), at_least)?;
    for plan in &report.alternatives {
        is(plan.moves, best.moves)?;
        is(plan == &best, false)?;
    }
    Ok(())
}

fn same_on_any_number_of_threads(problem: &LatticeProblem) -> Result<(), Failed> {
    let on = |threads: usize| -> Result<_, Failed> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let options = Options { objective: Objective::Moves, ..Options::default() };
        let report = pool.install(|| search(problem, options))?;
        Ok((report.plan, report.outcome, report.proof))
    };
    let single = on(1)?;
    is(&on(2)?, &single)?;
    is(&on(4)?, &single)
}
