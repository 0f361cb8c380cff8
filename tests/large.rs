//! Decomposition of problems beyond exact search: whatever it plans is replayed.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use steadfast::generate::{Family, Pair, Request, generate};
use steadfast::reconfigure::replay::replay;
use steadfast::reconfigure::{Event, Limit, Method, Options, Outcome, Plan, Report, solve};
use steadfast::robot::{
    Catalogue, Cell, Configuration, Environment, Goal, Ground, Matching, Module, Placement, Requirement,
};
use steadfast::spatial::Vec3;

/// Interchangeable cubes on the ground, all touching faces connected.
fn cubes(cells: &[Cell]) -> Configuration {
    let module = |(index, &cell): (usize, &Cell)| Module {
        id: format!("m{index}"),
        module_type: 0,
        placement: Placement::new(cell),
        fixed: false,
    };
    let mut configuration = Configuration {
        catalogue: Arc::new(Catalogue::cube()),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        environment: Environment {
            ground: Some(Ground { height: 0.0, friction: 0.8 }),
            obstacles: Vec::new(),
            module_friction: 0.4,
        },
        modules: cells.iter().enumerate().map(module).collect(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    };
    configuration.connections = configuration.touching_connections();
    configuration
}

fn goal(cells: &[Cell]) -> Goal {
    Goal { configuration: cubes(cells), matching: Matching::default() }
}

/// A random pair, both ends of which stand.
fn random_pair(modules: usize, seed: u64) -> (Configuration, Goal) {
    match generate(&Request::new(Family::Cubes, modules, seed)).unwrap().pair {
        Pair::Lattice { start, goal } => (start, goal),
        Pair::Linkage { .. } => panic!("cubes sit in a lattice"),
    }
}

fn decompose(start: &Configuration, goal: &Goal, options: Options) -> Report {
    let options = Options { method: Method::Decompose, ..options };
    solve(start, goal, &options, &mut |_: &Event| {}).unwrap()
}

/// The plan of a report, replayed.
fn verified<'r>(start: &Configuration, goal: &Goal, report: &'r Report) -> &'r Plan {
    let plan = report.plan.as_ref().unwrap_or_else(|| panic!("{report:?}"));
    let replayed = replay(start, goal, plan, report.required.unwrap()).unwrap();
    assert_eq!(replayed.failures, []);
    assert_eq!(replayed.actions_replayed, plan.actions.len());
    let claimed = plan.margin.unwrap();
    assert!(claimed.lower >= report.required.unwrap() && claimed.upper <= report.proof.margin_at_most);
    assert!(!report.proof.optimal && plan.moves >= report.proof.moves_at_least);
    plan
}

#[test]
fn random_pairs_are_solved_and_replayed() {
    // In the second the goal alone limits the margin, while bounds on moves before it are as low; in the third
    // that is so of the last move.
    for (modules, seed) in [(12, 1), (14, 4), (20, 3)] {
        let (start, goal) = random_pair(modules, seed);
        verified(&start, &goal, &decompose(&start, &goal, Options::default()));
    }
}

/// A box of walls around one cell that is to be filled.
#[test]
fn an_enclosed_cell_is_opened_and_filled() {
    let shell = |x: i32, y: i32, z: i32| [x, y, z];
    let mut cells: Vec<Cell> =
        (0..27).map(|i| shell(i % 3, i / 3 % 3, i / 9)).filter(|cell| *cell != [1, 1, 1]).collect();
    let full: Vec<Cell> = (0..27).map(|i| shell(i % 3, i / 3 % 3, i / 9)).collect();
    cells.push([3, 1, 0]);
    let (start, goal) = (cubes(&cells), goal(&full));
    let report = decompose(&start, &goal, Options::default());
    verified(&start, &goal, &report);
}

/// No module is where one is wanted: the robot has to go there.
#[test]
fn a_robot_walks_to_where_it_is_wanted() {
    let row = |from: i32| -> Vec<Cell> { (0..8).map(|i| [from + i % 4, i / 4, 0]).collect() };
    let (start, goal) = (cubes(&row(0)), goal(&row(6)));
    let report = decompose(&start, &goal, Options::default());
    verified(&start, &goal, &report);
}

#[test]
fn plans_depend_on_the_seed_and_not_on_threads() {
    let (start, goal) = random_pair(12, 2);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| decompose(&start, &goal, Options { seed: 7, ..Options::default() }).plan)
    };
    let one = with(1);
    assert!(one.is_some());
    assert_eq!(one, with(2));
}

#[test]
fn what_was_not_found_is_not_called_impossible() {
    let (start, goal) = random_pair(12, 2);
    let cancel = Some(Arc::new(AtomicBool::new(true)));
    let report = decompose(&start, &goal, Options { cancel, ..Options::default() });
    assert_eq!((report.outcome, report.plan), (Outcome::OutOfBudget(Limit::Cancelled), None));
}
