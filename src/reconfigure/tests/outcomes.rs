//! What can be planned for: obstacles, matchings, loads, free frames, and proofs that there is no plan.

use crate::reconfigure::plan::{Objective, Outcome};
use crate::reconfigure::refusal::{Impossible, Refusal, Which};
use crate::reconfigure::replay::{Fault, replay};
use crate::reconfigure::{Options, Reduction, solve};
use crate::robot::{Cell, Configuration, Fault as UnsoundFault, Goal, Matching, ModuleLoad, Obstacle, Part, Shape};
use crate::spatial::{Pose, Vec3};

use super::{cubes, goal, plan, solved, tower_to_row};

/// Under 2.5 times the gravity a hinge cannot lift a cube, though faces hold it.
fn heavy(mut configuration: Configuration) -> Configuration {
    configuration.gravity *= 2.5;
    configuration
}

#[test]
fn geometry_alone_plans_what_breaks_and_the_replay_says_where() {
    let start = heavy(cubes(&[[0, 0, 2], [1, 0, 2], [2, 0, 2], [0, 0, 1]], 3));
    let target = goal(heavy(cubes(&[[0, 0, 2], [1, 0, 2], [2, 0, 2], [2, 0, 3]], 3)));
    let proved = plan(&start, &target, &Options::default());
    assert_eq!(proved.outcome, Outcome::Impossible(Impossible::Exhausted { required: 0.0 }));

    let options = Options { objective: Objective::Moves, ignore_stability: true, ..Options::default() };
    let report = plan(&start, &target, &options);
    let blind = solved(&report);
    assert_eq!((blind.margin, blind.bottleneck.as_ref()), (None, None));
    let replayed = replay(&start, &target, blind, 0.0).unwrap();
    let first = &replayed.failures[0];
    assert!(matches!(first.fault, Fault::Unstable { .. }), "{first:?}");
    assert!(blind.actions[first.action.unwrap()].action.is_move());
    assert!(first.connection.unwrap().modules().contains(&3), "the cube that pivots: {first:?}");
}

#[test]
fn what_cannot_be_reached_is_proved_so() {
    let outcome = |start: &Configuration, target: &Goal| plan(start, target, &Options::default()).outcome;
    let row = cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0]], 0);

    let fewer = goal(cubes(&[[0, 0, 0], [1, 0, 0]], 0));
    assert!(matches!(outcome(&row, &fewer), Outcome::Impossible(Impossible::ModulesDiffer { start: 3, goal: 2, .. })));

    let mut apart = row.clone();
    apart.connections.pop();
    let disconnected = Outcome::Impossible(Impossible::Disconnected(Which::Start));
    assert_eq!(outcome(&apart, &goal(row.clone())), disconnected);

    let held = cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0]], 1);
    let moved = goal(cubes(&[[1, 0, 0], [2, 0, 0], [3, 0, 0]], 0));
    assert!(matches!(outcome(&held, &moved), Outcome::Impossible(Impossible::FixedModule { .. })));

    // Six cubes out from a held one: no face can carry that (0.056 n^2 > 1).
    let cantilever: Vec<Cell> = (0..7).map(|x| [x, 0, 5]).collect();
    let tower: Vec<Cell> = (0..7).map(|z| [0, 0, 5 + z]).collect();
    let (up, out) = (cubes(&tower, 1), cubes(&cantilever, 1));
    let unstable = outcome(&up, &goal(out));
    assert!(matches!(unstable, Outcome::Impossible(Impossible::Unstable { which: Which::Goal, .. })), "{unstable:?}");

    let tall = Options { min_margin: Some(0.999), ..Options::default() };
    let (start, target) = tower_to_row();
    let report = plan(&start, &target, &tall);
    assert!(matches!(report.outcome, Outcome::Impossible(_)), "{:?}", report.outcome);
}

#[test]
fn attaching_and_detaching_alone_is_a_plan_of_no_moves() {
    let square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]];
    let (mut start, mut end) = (cubes(&square, 0), cubes(&square, 0));
    start.connections.remove(0);
    end.connections.remove(3);
    for reduction in [Reduction::Saturated, Reduction::Primitive] {
        let report = plan(&start, &goal(end.clone()), &Options { reduction, ..Options::default() });
        let kinds: Vec<_> = solved(&report).actions.iter().map(|planned| planned.action.kind()).collect();
        assert_eq!(kinds, ["attach", "detach"]);
    }
}

#[test]
fn obstacles_are_gone_round_or_not_at_all() {
    let start = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 2);
    let target = goal(cubes(&[[0, 0, 0], [1, 0, 0], [1, 0, 1]], 2));
    let options = Options { objective: Objective::Moves, ..Options::default() };
    assert_eq!(solved(&plan(&start, &target, &options)).moves, 1);
    // A plate just above the target leaves room to slide, none to pivot.
    let pitch = start.pitch();
    let plate = |gap: f64| Obstacle {
        shape: Shape::Cuboid { half_extents: Vec3::new(2.0, 2.0, 0.01) }.into(),
        pose: Pose::translation(0.0, 0.0, 2.0 * pitch + gap + 0.01),
        friction: 0.5,
    };
    let under = |gap: f64, mut configuration: Configuration| {
        configuration.environment.obstacles.push(plate(gap));
        configuration
    };
    let target = |gap| goal(under(gap, target.configuration.clone()));
    assert_eq!(solved(&plan(&under(0.001, start.clone()), &target(0.001), &options)).moves, 1);
    let refused = solve(&under(-0.01, start.clone()), &target(-0.01), &options, &mut |_| {});
    let Err(Refusal::Unsound { which: Which::Start, problems }) = refused else { panic!("{refused:?}") };
    let on_top = Part::Module(2);
    assert_eq!(problems.len(), 1, "{problems:?}");
    assert_eq!((problems[0].part, problems[0].fault), (on_top, UnsoundFault::InsideObstacle { obstacle: 0 }));
    let down = cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0]], 2);
    let from = cubes(&[[0, 0, 0], [1, 0, 0], [1, 0, 1]], 2);
    let free = plan(&from, &goal(down.clone()), &options);
    assert_eq!(solved(&free).moves, 1);
    let low = plan(&under(0.001, from), &goal(under(0.001, down)), &options);
    assert!(matches!(low.outcome, Outcome::Impossible(Impossible::Exhausted { .. })), "{:?}", low.outcome);
}

#[test]
fn labelled_modules_go_to_their_own_places() {
    let start = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 0);
    let end = cubes(&[[0, 0, 0], [0, 0, 1], [1, 0, 0]], 0);
    let target = |labelled| Goal { configuration: end.clone(), matching: Matching { labelled, free_frame: false } };
    let moves = |labelled| {
        let options = Options { objective: Objective::Moves, ..Options::default() };
        solved(&plan(&start, &target(labelled), &options)).moves
    };
    assert_eq!(moves(false), 0);
    assert!(moves(true) > 0);
}

#[test]
fn a_loaded_module_keeps_its_load_and_its_place() {
    let mut start = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 0);
    let at = Some(Vec3::new(0.0, 0.0, 0.02));
    start.loads.push(ModuleLoad { module: 2, force: Vec3::new(0.0, 0.0, -0.2), torque: Vec3::zeros(), at });
    let end = cubes(&[[0, 0, 0], [0, 0, 1], [1, 0, 0]], 0);
    let report = plan(&start, &goal(end), &Options { objective: Objective::Moves, ..Options::default() });
    let best = solved(&report);
    assert!(best.moves > 0, "module c must come down");
    let without = goal(cubes(&[[0, 0, 0], [0, 0, 1]], 0));
    let refused = solve(&start, &without, &Options::default(), &mut |_| {});
    assert_eq!(refused, Err(Refusal::LoadedModuleMissing { module: "c".into() }));
}

#[test]
fn a_free_goal_is_met_anywhere_on_the_ground() {
    let start = cubes(&[[0, 0, 0], [1, 0, 0], [0, 0, 1]], 0);
    let end = cubes(&[[7, 3, 0], [7, 4, 0], [7, 4, 1]], 0);
    let free = Goal { configuration: end, matching: Matching { labelled: false, free_frame: true } };
    for reduction in [Reduction::Saturated, Reduction::Primitive] {
        let options = Options { objective: Objective::Moves, reduction, ..Options::default() };
        assert_eq!(solved(&plan(&start, &free, &options)).moves, 0, "turned by a half, it is there");
        let row = Goal { configuration: cubes(&[[0, 5, 0], [0, 6, 0], [0, 7, 0]], 0), ..free.clone() };
        assert_eq!(solved(&plan(&start, &row, &options)).moves, 1);
    }
    let mut held = start.clone();
    held.modules[0].fixed = true;
    let refused = solve(&held, &free, &Options::default(), &mut |_| {});
    assert!(matches!(refused, Err(Refusal::NoFreeFrame { .. })), "{refused:?}");
}
