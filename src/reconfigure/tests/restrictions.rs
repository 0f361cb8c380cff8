//! Modules that may not move and regions that none may pass through: for the planner and for the replay.

use crate::reconfigure::replay::{Fault, replay};
use crate::reconfigure::{Action, Impossible, Objective, Options, Outcome};
use crate::robot::Region;
use crate::spatial::Vec3;

use super::{cubes, goal, plan, solved};

/// Where the fourth cube of a row has to get to the other end, over the row or beside it.
fn row() -> (crate::robot::Configuration, crate::robot::Goal) {
    let start = cubes(&[[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], 0);
    let end = cubes(&[[-1, 0, 0], [0, 0, 0], [1, 0, 0], [2, 0, 0]], 0);
    (start, goal(end))
}

fn fewest_moves() -> Options {
    Options { objective: Objective::Moves, ..Options::default() }
}

#[test]
fn a_module_that_may_not_move_does_not_and_is_no_support_of_the_world() {
    let (mut start, goal) = row();
    start.require.stay = vec![1, 2];
    let report = plan(&start, &goal, &fewest_moves());
    let moved = solved(&report).actions.iter().filter_map(|planned| match planned.action {
        Action::Move { module, .. } => Some(module),
        _ => None,
    });
    assert!(moved.into_iter().all(|module| module != 1 && module != 2));
    // Forces are what they were: the margin of the same plan is that without the restriction.
    let free = row().0;
    let replayed = replay(&free, &goal, solved(&report), 0.0).unwrap();
    assert_eq!(replayed.failures, []);
}

#[test]
fn a_goal_elsewhere_for_a_module_that_may_not_move_is_impossible() {
    let (mut start, goal) = row();
    start.require.stay = vec![3];
    let report = plan(&start, &goal, &fewest_moves());
    assert_eq!(report.outcome, Outcome::Impossible(Impossible::FixedModule { module: "d".into() }));
}

#[test]
fn the_replay_rejects_what_is_forbidden() {
    let (start, goal) = row();
    let report = plan(&start, &goal, &fewest_moves());
    let plan = solved(&report);
    for module in 0..4 {
        let mut forbidden = start.clone();
        forbidden.require.stay = vec![module];
        let faults = replay(&forbidden, &goal, plan, 0.0).unwrap().failures;
        let moves = plan.actions.iter().any(|planned| match planned.action {
            Action::Move { module: m, .. } => m == module,
            _ => false,
        });
        assert_eq!(faults.iter().any(|failure| failure.fault == Fault::MustStay), moves);
    }
}

#[test]
fn no_module_passes_a_forbidden_region() {
    let (mut start, goal) = row();
    let moves = |start| solved(&plan(start, &goal, &fewest_moves())).moves;
    let free = moves(&start);
    let pitch = start.pitch();
    // A thin wall across the way over the row, then one on either side as well.
    let wall = |low: [f64; 3], high: [f64; 3]| Region { low: Vec3::from(low) * pitch, high: Vec3::from(high) * pitch };
    start.require.keep_out = vec![wall([1.4, -3.0, 1.2], [1.5, 4.0, 9.0])];
    let over = plan(&start, &goal, &fewest_moves());
    assert!(solved(&over).moves >= free);
    let unrestricted = plan(&row().0, &goal, &fewest_moves());
    let through = replay(&start, &goal, solved(&unrestricted), 0.0).unwrap();
    let over_the_top = solved(&unrestricted).actions.iter().any(|planned| match planned.action {
        Action::Move { to, .. } => to[2] > 0,
        _ => false,
    });
    assert_eq!(through.failures.iter().any(|f| f.fault == Fault::KeepOut { region: 0 }), over_the_top);
    start.require.keep_out.push(wall([1.4, 1.1, 0.0], [1.5, 4.0, 9.0]));
    start.require.keep_out.push(wall([1.4, -3.0, 0.0], [1.5, -0.1, 9.0]));
    let closed = plan(&start, &goal, &Options { max_expansions: Some(400), ..fewest_moves() });
    // The whole robot may still walk round the wall, which takes many moves.
    assert!(closed.plan.is_none_or(|plan| plan.moves > free));
}
