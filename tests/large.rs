//! Decomposition of problems beyond exact search: whatever it plans is replayed.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use steadfast::generate::{Family, Pair, Request, generate};
use steadfast::io::{SourceFile, no_references, read_problem};
use steadfast::reconfigure::replay::replay;
use steadfast::reconfigure::{Event, Limit, Method, Nearest, Objective, Options, Outcome, Plan, Report, solve};
use steadfast::robot::{
    Catalogue, Cell, Configuration, Environment, Goal, Ground, Matching, Module, ModuleLoad, Placement, Requirement,
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

#[test]
fn several_plans_are_ranked_and_replayed() {
    let (start, goal) = random_pair(20, 3);
    for objective in [Objective::Margin, Objective::Pareto] {
        let report = decompose(&start, &goal, Options { objective, plans: 3, ..Options::default() });
        let best = verified(&start, &goal, &report);
        assert!(
            objective == Objective::Pareto || !report.alternatives.is_empty(),
            "larger and larger margins are tried"
        );
        let mut before = best;
        for plan in &report.alternatives {
            assert_eq!(replay(&start, &goal, plan, report.required.unwrap()).unwrap().failures, []);
            let [margin, next] = [before, plan].map(|plan| plan.margin.unwrap().lower);
            assert!(next <= margin && (objective == Objective::Margin || plan.moves < before.moves));
            before = plan;
        }
        let is_cut = objective == Objective::Pareto || report.alternatives.len() < 2;
        assert_eq!(report.alternatives_cut_by, is_cut.then_some(Limit::Incomplete));
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

/// Two modules that only their names tell apart are in each other's cells.
#[test]
fn named_modules_change_places() {
    let cells: Vec<Cell> = (0..6).map(|i| [i % 3, i / 3, 0]).collect();
    let mut swapped = cells.clone();
    swapped.swap(0, 5);
    let start = cubes(&cells);
    let mut goal = goal(&swapped);
    goal.matching.labelled = true;
    let report = decompose(&start, &goal, Options::default());
    let plan = verified(&start, &goal, &report);
    assert!(plan.moves >= 2);
}

/// The heavy module is wanted at the other end.
#[test]
fn modules_of_two_types_go_where_theirs_is_wanted() {
    let mut catalogue = Catalogue::cube();
    let mut heavy = catalogue.module_types[0].clone();
    heavy.name = "heavy".to_string();
    heavy.bodies[0].mass *= 2.0;
    let kind = catalogue.module_types.len();
    catalogue.module_types.push(heavy);
    let catalogue = Arc::new(catalogue);
    let robot = |cells: &[Cell], heavy: usize| {
        let mut robot = cubes(cells);
        robot.catalogue = Arc::clone(&catalogue);
        robot.modules[heavy].module_type = kind;
        robot
    };
    let cells: Vec<Cell> = (0..8).map(|i| [i % 4, 0, i / 4]).collect();
    let start = robot(&cells, 0);
    let goal = Goal { configuration: robot(&cells, 3), matching: Matching::default() };
    let report = decompose(&start, &goal, Options::default());
    verified(&start, &goal, &report);
}

/// A module with a load of its own stays where it is, and where the goal wants it elsewhere the report says what it lacks.
#[test]
fn a_loaded_module_stays_where_it_is() {
    let loaded = |module: usize| {
        let mut start = cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 0, 1]]);
        start.loads = vec![ModuleLoad { module, force: Vec3::new(0.0, 0.0, -0.5), torque: Vec3::zeros(), at: None }];
        start
    };
    let options = Options { explain: true, ..Options::default() };
    let goal = goal(&[[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 0, 1]]);
    let report = decompose(&loaded(1), &goal, options.clone());
    verified(&loaded(1), &goal, &report);
    let report = decompose(&loaded(3), &goal, options);
    assert_eq!((report.outcome, report.plan), (Outcome::OutOfBudget(Limit::Incomplete), None));
    let nearest = report.in_the_way.unwrap().nearest;
    assert_eq!(nearest, Some(Nearest { modules: 4, in_place: 3, stuck: 1 }));
}

/// The problems of the library that are too large for exact search.
#[test]
fn library_problems_are_solved_as_well_as_expected() {
    for (name, case) in problems::manifest().unwrap().large {
        let directory = problems::root().join("large").join(&name);
        let file = |which: &str| SourceFile::new(which, std::fs::read(directory.join(which)).unwrap());
        let problem = read_problem(&file("start.json"), &file("goal.json"), &no_references).unwrap();
        let problem = problem.into_lattice().unwrap();
        assert_eq!(problem.start.modules.len(), case.modules, "{name}");
        let options = Options { min_margin: Some(case.margin_at_least), ..Options::default() };
        let report = solve(&problem.start, &problem.goal, &options, &mut |_: &Event| {}).unwrap();
        let plan = verified(&problem.start, &problem.goal, &report);
        assert!(plan.margin.unwrap().lower >= case.margin_at_least, "{name}: {:?}", plan.margin);
    }
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
