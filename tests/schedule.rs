//! Laws of changes and of planning on from anywhere.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use steadfast::reconfigure::{Limit, Objective, Options, Outcome};
use steadfast::robot::{Configuration, FaceConnection};

use steadfast::robot::linkage::Linkage;
use steadfast::schedule::{
    ChangeError, Job, PlanOf, Problem, Robot, best, plan_batch, until, weaken_connector, weaken_port, without,
};

fn cubes(name: &str) -> Problem<Configuration> {
    let read = problems_named("cubes", name).into_lattice().unwrap();
    Problem::lattice(read.start, read.goal)
}

fn linkage(name: &str) -> Problem<Linkage> {
    let steadfast::io::Problem::Linkage(read) = problems_named("freesn", name) else { panic!("a linkage") };
    Problem::linkage(read.start, read.goal)
}

fn problems_named(family: &str, name: &str) -> steadfast::io::Problem {
    let file = |end: &str| {
        let path = problems::root().join(family).join(name).join(end);
        steadfast::io::SourceFile::new(end, std::fs::read(path).unwrap())
    };
    steadfast::io::read_problem(&file("start.json"), &file("goal.json"), &steadfast::io::no_references).unwrap()
}

fn fewest_moves() -> Options {
    Options { objective: Objective::Moves, ..Options::default() }
}

fn plan_of<R: Robot>(problem: &Problem<R>) -> PlanOf<R> {
    problem.plan(&fewest_moves(), &mut |_| {}).unwrap().plan.unwrap()
}

fn actions<R: Robot>(plan: &PlanOf<R>) -> impl Iterator<Item = &R::Action> {
    plan.actions.iter().map(|planned| &planned.action)
}

/// From every state of a plan there is a plan of the rest, and it verifies.
fn replans_from_everywhere<R: Robot>(problem: &Problem<R>, every: usize) {
    let plan = plan_of(problem);
    for done in (0..=plan.actions.len()).step_by(every) {
        let now = problem.start.after(actions::<R>(&plan).take(done)).unwrap();
        let moved = !now.misplaced(&problem.start).is_empty();
        let from_here = problem.from_state(now);
        let rest = plan_of(&from_here);
        assert!(rest.moves <= plan.moves);
        assert!(done < plan.actions.len() || rest.moves == 0);
        assert!(moved || rest.moves == plan.moves);
        assert_eq!(from_here.replay(&rest, 0.0).unwrap().failures, []);
    }
}

#[test]
fn a_lattice_plans_on_from_any_action() {
    replans_from_everywhere(&cubes("overhang"), 3);
}

#[test]
fn a_linkage_plans_on_from_any_action() {
    replans_from_everywhere(&linkage("turn_in_place"), 2);
}

#[test]
fn a_robot_that_is_elsewhere_is_told_apart() {
    let problem = cubes("overhang");
    let plan = plan_of(&problem);
    let end = problem.start.after(actions::<Configuration>(&plan)).unwrap();
    assert!(!end.misplaced(&problem.start).is_empty());
    // The plan's actions are not legal where they have been taken already.
    let again = end.after(actions::<Configuration>(&plan)).unwrap_err();
    assert!(again.action < plan.actions.len());
}

#[test]
fn weaker_connectors_divide_the_margin() {
    let mut problem = cubes("overhang");
    let utilisation = |problem: &Problem<Configuration>| {
        let assembly = steadfast::reconfigure::assembly::assemble(&problem.start);
        steadfast::statics::assess(&assembly.structure, steadfast::statics::Question::VALUE).unwrap().utilisation.upper
    };
    let before = utilisation(&problem);
    for connector in problem.start.catalogue.connectors.clone() {
        weaken_connector(&mut problem, &connector.name, 0.5).unwrap();
    }
    assert!(before > 0.0 && (utilisation(&problem) - 2.0 * before).abs() <= 1e-5 * before);
    assert_eq!(problem.start.problems(), []);
    let unchanged = problem.clone();
    assert_eq!(weaken_connector(&mut problem, "glue", 0.5), Err(ChangeError::UnknownConnector("glue".into())));
    let name = problem.start.catalogue.connectors[0].name.clone();
    for factor in [0.0, -1.0, 1.5, f64::NAN] {
        assert!(matches!(weaken_connector(&mut problem, &name, factor), Err(ChangeError::Factor(_))));
    }
    assert_eq!(problem, unchanged);
}

#[test]
fn a_weak_port_weakens_its_own_module_only() {
    let mut problem = cubes("overhang");
    let ids: Vec<String> = problem.goal.ids().into_iter().map(str::to_owned).collect();
    let weak = problem.start.ids().iter().position(|id| ids.iter().any(|other| other == id)).unwrap();
    let id = problem.start.modules[weak].id.clone();
    weaken_port(&mut problem, &id, "+x", 0.25).unwrap();
    assert_eq!(problem.start.problems(), []);
    assert_eq!(problem.goal.problems(), []);
    let catalogue = &problem.start.catalogue;
    let strength = |m: usize| catalogue.connectors[problem.start.module_type(m).cell().face].strength;
    let others = (0..problem.start.modules.len()).filter(|&m| m != weak);
    assert!(others.into_iter().all(|other| strength(weak) == 0.25 * strength(other)));
    // It is weak wherever it is, so the planner still has an answer that verifies.
    let report = problem.plan(&fewest_moves(), &mut |_| {}).unwrap();
    if let Some(plan) = &report.plan {
        assert_eq!(problem.replay(plan, 0.0).unwrap().failures, []);
    }
    assert!(matches!(weaken_port(&mut problem, &id, "top", 0.5), Err(ChangeError::UnknownPort(_))));
}

#[test]
fn a_module_that_is_gone_takes_its_connections_along() {
    let problem = cubes("overhang");
    let gone = problem.start.modules.len() - 1;
    let id = problem.start.modules[gone].id.clone();
    let left = without(&problem, &id).unwrap();
    assert!(!left.is_empty());
    for (unfilled, left) in &left {
        assert_eq!(left.start.modules.len(), gone);
        assert_eq!(left.goal.modules.len(), problem.goal.modules.len() - 1);
        assert!(!left.goal.ids().contains(&unfilled.as_str()));
        let count = |c: &[FaceConnection]| c.iter().filter(|c| !c.modules().contains(&gone)).count();
        assert_eq!(left.start.connections.len(), count(&problem.start.connections));
    }
    assert_eq!(without(&problem, "nobody").unwrap_err(), ChangeError::UnknownModule("nobody".into()));
}

#[test]
fn what_names_modules_by_index_follows_when_one_is_taken_out() {
    let mut start = cubes("overhang").start;
    start.require.stay = vec![0, 1, 2];
    let (first, second) = (start.modules[0].clone(), start.modules[2].clone());
    start.take_out(1);
    assert_eq!(start.require.stay, [0, 1]);
    assert_eq!((&start.modules[0], &start.modules[1]), (&first, &second));
    let touching = start.touching_connections();
    assert!(start.connections.iter().all(|connection| touching.contains(connection)));
}

#[test]
fn a_job_tells_what_happens_and_answers_as_planning_does() {
    let problem = cubes("overhang");
    let job = Job::start(problem.clone(), fewest_moves());
    let events = job.events().count();
    assert!(events > 0);
    let report = job.wait().unwrap();
    assert_eq!(report.plan, Some(plan_of(&problem)));
}

#[test]
fn a_job_is_cancelled_from_another_thread() {
    let job = Job::start(cubes("wall_of_twelve"), Options::default());
    let canceller = job.canceller();
    std::thread::spawn(move || canceller.cancel()).join().unwrap();
    let began = Instant::now();
    let report = job.wait().unwrap();
    assert!(matches!(report.outcome, Outcome::OutOfBudget(Limit::Cancelled) | Outcome::Solved));
    assert!(began.elapsed() < Duration::from_secs(60));
}

#[test]
fn a_deadline_that_has_passed_ends_planning() {
    let options = until(Instant::now(), fewest_moves());
    let report = cubes("wall_of_twelve").plan(&options, &mut |_| {}).unwrap();
    assert_eq!(report.outcome, Outcome::OutOfBudget(Limit::Deadline));
    let sooner = until(
        Instant::now() + Duration::from_secs(9),
        Options { time_limit: Some(Duration::from_secs(1)), ..Options::default() },
    );
    assert_eq!(sooner.time_limit, Some(Duration::from_secs(1)));
}

#[test]
fn a_batch_answers_in_order_each_within_its_own_limits() {
    let problem = cubes("overhang");
    let at_once = Options { max_expansions: Some(0), ..fewest_moves() };
    let batch = [(problem.clone(), fewest_moves()), (problem.clone(), at_once), (problem.clone(), fewest_moves())];
    let cancel = Arc::new(AtomicBool::new(false));
    let reports: Vec<_> = plan_batch(&batch, &cancel).into_iter().map(Result::unwrap).collect();
    let plan = plan_of(&problem);
    assert_eq!(reports[0].plan.as_ref(), Some(&plan));
    assert_eq!(reports[1].outcome, Outcome::OutOfBudget(Limit::Expansions));
    assert_eq!(reports[2].plan.as_ref(), Some(&plan));
    assert_eq!(best(&reports), Some(0));
    cancel.store(true, Ordering::Relaxed);
    let stopped = plan_batch(&batch[..1], &cancel).remove(0).unwrap();
    assert_eq!(stopped.outcome, Outcome::OutOfBudget(Limit::Cancelled));
}
