//! The planner on every planning problem of the library with struts and nodes: a test for each
//! question. Every plan that is found is replayed.

use std::time::Duration;

use libtest_mimic::{Arguments, Failed, Trial};
use problems::{ByGeometry, FewestMoves, PlanningCase};
use steadfast::io::{LinkageProblem, SourceFile, no_references, read_problem};
use steadfast::reconfigure::linkage::replay::replay;
use steadfast::reconfigure::linkage::{Action, assembly::Held, solve};
use steadfast::reconfigure::replay::Fault;
use steadfast::reconfigure::{Objective, Options, Outcome, Report};

/// Nothing may take this long; reached, it fails the test by an unproved outcome.
const TIME_LIMIT: Duration = Duration::from_secs(600);

fn main() {
    let manifest = problems::manifest().expect("the manifest is sound");
    let trials = manifest.freesn.into_iter().flat_map(|(name, case)| trials(&name, &case)).collect();
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

/// A question to a problem.
type Question = Box<dyn FnOnce(&LinkageProblem) -> Result<(), Failed> + Send>;

fn trials(name: &str, case: &PlanningCase) -> Vec<Trial> {
    let mut trials = Vec::new();
    let mut add = |question: &str, test: Question| {
        let problem = name.to_string();
        trials.push(Trial::test(format!("{name}::{question}"), move || test(&read(&problem)?)));
    };
    let (modules, moves) = (case.modules, case.moves.clone());
    add("modules", Box::new(move |problem| is(problem.start.modules.len(), modules)));
    add("moves", Box::new(move |problem| fewest(problem, &moves)));
    if let Some(expected) = case.by_geometry.clone() {
        add("by_geometry", Box::new(move |problem| by_geometry(problem, &expected)));
    }
    trials
}

fn read(name: &str) -> Result<LinkageProblem, Failed> {
    let directory = problems::root().join("freesn").join(name);
    let file = |which: &str| std::fs::read(directory.join(which)).map(|bytes| SourceFile::new(which, bytes));
    let problem = read_problem(&file("start.json")?, &file("goal.json")?, &no_references)?;
    problem.into_linkage().ok_or_else(|| "all modules sit in a lattice".into())
}

fn search(problem: &LinkageProblem, options: Options) -> Result<Report<Action, Held>, Failed> {
    let options = Options { objective: Objective::Moves, time_limit: Some(TIME_LIMIT), ..options };
    let report = solve(&problem.start, &problem.goal, &options, &mut |_| {}).map_err(|refusal| refusal.to_string())?;
    Ok(report)
}

fn is<T: PartialEq + std::fmt::Debug>(found: T, expected: T) -> Result<(), Failed> {
    if found == expected { Ok(()) } else { Err(format!("expected {expected:?}, found {found:?}").into()) }
}

fn fewest(problem: &LinkageProblem, expected: &FewestMoves) -> Result<(), Failed> {
    let report = search(problem, Options::default())?;
    let outcome = match report.outcome {
        Outcome::Solved => "solved",
        Outcome::Impossible(_) => "impossible",
        Outcome::OutOfBudget(_) => "out of budget",
    };
    is(outcome, expected.outcome.as_str())?;
    is(report.plan.as_ref().map(|plan| plan.moves), expected.moves)?;
    is(report.proof.optimal, expected.moves.is_some())?;
    if let (Some(plan), Some(required)) = (&report.plan, report.required) {
        let check = replay(&problem.start, &problem.goal, plan, required).map_err(|refusal| refusal.to_string())?;
        is(check.failures, Vec::new())?;
    }
    Ok(())
}

/// The shortest plan by geometry, held to the margin that the start requires.
fn by_geometry(problem: &LinkageProblem, expected: &ByGeometry) -> Result<(), Failed> {
    let report = search(problem, Options { ignore_stability: true, ..Options::default() })?;
    let plan = report.plan.ok_or("no plan by geometry")?;
    is(plan.moves, expected.moves)?;
    let required = problem.start.require.margin;
    let check = replay(&problem.start, &problem.goal, &plan, required).map_err(|refusal| refusal.to_string())?;
    is(check.is_verified(), !expected.breaks)?;
    let only_unstable = check.failures.iter().all(|failure| matches!(failure.fault, Fault::Unstable { .. }));
    is(only_unstable, true)
}
