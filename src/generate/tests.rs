//! Laws of random problems.

use std::collections::BTreeSet;

use super::{Failure, Family, Generated, GoalKind, Pair, Request, Setting, generate};
use crate::geometry::{environment_problems, linkage_problems};
use crate::reconfigure::linkage::solve as solve_linkage;
use crate::reconfigure::{Objective, Options, Outcome, solve};
use crate::robot::Cell;

const SETTINGS: [Setting; 6] =
    [Setting::Space, Setting::Mounted, Setting::Flat, Setting::Slope, Setting::Steps, Setting::Rough];

fn cells(generated: &Generated) -> [BTreeSet<Cell>; 2] {
    let Pair::Lattice { start, goal } = &generated.pair else { panic!("cubes are a lattice") };
    [start, &goal.configuration].map(|robot| robot.modules.iter().map(|module| module.placement.cell).collect())
}

#[test]
fn everything_drawn_is_sound_in_every_setting() {
    for family in [Family::Cubes, Family::Freesn, Family::Rofi] {
        for (seed, setting) in (1..).zip(SETTINGS) {
            for goal in [GoalKind::Grown, GoalKind::Walk] {
                let modules = if family == Family::Rofi { 2 } else { 6 };
                let request = Request { setting, goal, difficulty: None, ..Request::new(family, modules, seed) };
                let generated = generate(&request).unwrap_or_else(|failure| panic!("{request:?}: {failure}"));
                match &generated.pair {
                    Pair::Lattice { start, goal } => {
                        for robot in [start, &goal.configuration] {
                            assert_eq!(
                                (robot.problems(), environment_problems(robot)),
                                (vec![], vec![]),
                                "{request:?}"
                            );
                        }
                        assert_ne!(start.modules, goal.configuration.modules, "{request:?}");
                    }
                    Pair::Linkage { start, goal } => {
                        for robot in [start, &goal.linkage] {
                            assert_eq!((robot.problems(), linkage_problems(robot)), (vec![], vec![]), "{request:?}");
                        }
                        assert_ne!(start.modules, goal.linkage.modules, "{request:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_same_seed_draws_the_same_with_any_number_of_threads() {
    for family in [Family::Cubes, Family::Freesn, Family::Rofi] {
        let request = Request { setting: Setting::Flat, ..Request::new(family, 3, 11) };
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| generate(&request)).unwrap()
        };
        assert_eq!(with(1), with(2));
        assert_ne!(with(1).pair, generate(&Request { seed: 12, ..request }).unwrap().pair);
    }
}

#[test]
fn the_difficulty_of_a_grown_goal_is_how_many_cubes_are_elsewhere() {
    let mut start = None;
    for moved in 1..8 {
        let request = Request { difficulty: Some(moved), ..Request::new(Family::Cubes, 8, 5) };
        let [from, to] = cells(&generate(&request).unwrap());
        assert_eq!(to.difference(&from).count(), moved);
        assert_eq!(*start.get_or_insert(from.clone()), from, "the goal has no say in the start");
    }
}

#[test]
fn the_difficulty_of_a_walk_bounds_the_moves_that_are_needed() {
    for difficulty in 1..4 {
        let request =
            Request { difficulty: Some(difficulty), goal: GoalKind::Walk, ..Request::new(Family::Cubes, 4, 2) };
        let generated = generate(&request).unwrap();
        assert_eq!(generated.difficulty, Some(difficulty));
        let Pair::Lattice { start, goal } = &generated.pair else { panic!("cubes are a lattice") };
        let options = Options { objective: Objective::Moves, min_margin: Some(0.1), ..Options::default() };
        let report = solve(start, goal, &options, &mut |_| {}).unwrap();
        assert_eq!(report.outcome, Outcome::Solved);
        assert!((1..=difficulty).contains(&(report.plan.unwrap().moves as usize)));
    }
    for family in [Family::Freesn, Family::Rofi] {
        let request = Request { difficulty: Some(2), ..Request::new(family, 3, 4) };
        let Pair::Linkage { start, goal } = generate(&request).unwrap().pair else { panic!("they have no cells") };
        let options = Options { objective: Objective::Moves, min_margin: Some(0.1), ..Options::default() };
        let report = solve_linkage(&start, &goal, &options, &mut |_| {}).unwrap();
        assert_eq!(report.outcome, Outcome::Solved, "{family:?}");
        assert!((1..=2).contains(&report.plan.unwrap().moves), "{family:?}");
    }
}

#[test]
fn a_longer_walk_begins_with_the_shorter_one() {
    // So the walk of one move more ends beside the end of the shorter one: one cube is elsewhere.
    let end = |difficulty| {
        let request =
            Request { difficulty: Some(difficulty), goal: GoalKind::Walk, ..Request::new(Family::Cubes, 6, 9) };
        let [_, end] = cells(&generate(&request).unwrap());
        end
    };
    for difficulty in 1..6 {
        assert_eq!(end(difficulty).difference(&end(difficulty + 1)).count(), 1);
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let cubes = Request::new(Family::Cubes, 4, 1);
    let refused = |request: Request| generate(&request).unwrap_err();
    assert_eq!(refused(Request { modules: 1, ..cubes }), Failure::Modules { least: 2, most: 2000 });
    assert_eq!(refused(Request { modules: 2001, ..cubes }), Failure::Modules { least: 2, most: 2000 });
    assert_eq!(refused(Request { difficulty: Some(4), ..cubes }), Failure::Difficulty { least: 1, most: 3 });
    assert_eq!(refused(Request { difficulty: Some(0), ..cubes }), Failure::Difficulty { least: 1, most: 3 });
    assert_eq!(refused(Request { margin: 1.0, ..cubes }), Failure::Margin);
    assert_eq!(refused(Request { margin: f64::NAN, ..cubes }), Failure::Margin);
    let walk = Request { goal: GoalKind::Walk, difficulty: Some(0), ..cubes };
    assert_eq!(refused(walk), Failure::Difficulty { least: 1, most: 10_000 });
    let grown = Request { goal: GoalKind::Grown, difficulty: Some(1), ..Request::new(Family::Rofi, 3, 1) };
    assert_eq!(refused(grown), Failure::NoDifficulty);
    // No shape of eight cubes has a connector that is hardly loaded, on one held cube.
    let proud = Request { margin: 0.999, modules: 8, setting: Setting::Mounted, ..cubes };
    assert!(matches!(refused(proud), Failure::NoneFound(tally) if tally.unstable > 0));
}
