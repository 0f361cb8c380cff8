//! The planner on every problem of RoFI modules in the library. Every plan that is found is replayed.

use std::time::Duration;

use libtest_mimic::{Arguments, Failed, Trial};
use problems::PlanningCase;
use steadfast::io::{LinkageProblem, SourceFile, no_references, read_problem};
use steadfast::reconfigure::linkage::replay::replay;
use steadfast::reconfigure::linkage::solve;
use steadfast::reconfigure::{Objective, Options, Outcome};

/// Nothing may take this long; reached, it fails the test by an unproved outcome.
const TIME_LIMIT: Duration = Duration::from_secs(600);

fn main() {
    let manifest = problems::manifest().expect("the manifest is sound");
    let mut trials = Vec::new();
    for (name, case) in manifest.rofi {
        let (problem, expected) = (name.clone(), case.clone());
        trials.push(Trial::test(format!("{name}::moves"), move || moves(&read(&problem)?, &expected)));
        if case.by_geometry.is_some() {
            trials.push(Trial::test(format!("{name}::by_geometry"), move || by_geometry(&read(&name)?, &case)));
        }
    }
    libtest_mimic::run(&Arguments::from_args(), trials).exit();
}

fn read(name: &str) -> Result<LinkageProblem, Failed> {
    let directory = problems::root().join("rofi").join(name);
    let file = |which: &str| std::fs::read(directory.join(which)).map(|bytes| SourceFile::new(which, bytes));
    let problem = read_problem(&file("start.json")?, &file("goal.json")?, &no_references)?;
    problem.into_linkage().ok_or_else(|| "all modules are cubes".into())
}

fn is<T: PartialEq + std::fmt::Debug>(found: T, expected: T) -> Result<(), Failed> {
    if found == expected { Ok(()) } else { Err(format!("expected {expected:?}, found {found:?}").into()) }
}

fn moves(problem: &LinkageProblem, expected: &PlanningCase) -> Result<(), Failed> {
    let LinkageProblem { start, goal } = problem;
    is(start.modules.len(), expected.modules)?;
    let options = Options { objective: Objective::Moves, time_limit: Some(TIME_LIMIT), ..Options::default() };
    let report = solve(start, goal, &options, &mut |_| {}).map_err(|refusal| refusal.to_string())?;
    let outcome = match report.outcome {
        Outcome::Solved => "solved",
        Outcome::Impossible(_) => "impossible",
        Outcome::OutOfBudget(_) => "out of budget",
    };
    is(outcome, expected.moves.outcome.as_str())?;
    is(report.plan.as_ref().map(|plan| plan.moves), expected.moves.moves)?;
    let Some(plan) = &report.plan else { return Ok(()) };
    is(report.proof.optimal, true)?;
    let check = replay(start, goal, plan, 0.0).map_err(|refusal| refusal.to_string())?;
    if check.is_verified() { Ok(()) } else { Err(format!("not verified: {:?}", check.failures).into()) }
}

fn by_geometry(problem: &LinkageProblem, expected: &PlanningCase) -> Result<(), Failed> {
    let LinkageProblem { start, goal } = problem;
    let expected = expected.by_geometry.as_ref().ok_or("nothing is expected")?;
    let options = Options {
        objective: Objective::Moves,
        ignore_stability: true,
        time_limit: Some(TIME_LIMIT),
        ..Options::default()
    };
    let report = solve(start, goal, &options, &mut |_| {}).map_err(|refusal| refusal.to_string())?;
    let plan = report.plan.ok_or("no plan by geometry")?;
    is(plan.moves, expected.moves)?;
    let check = replay(start, goal, &plan, 0.0).map_err(|refusal| refusal.to_string())?;
    is(check.is_verified(), !expected.breaks)
}
