//! Levels that no module comes to or leaves for good, against all moves that there are.

use std::collections::HashSet;

use crate::reconfigure::domain::Domain;
use crate::reconfigure::layout::Layout;
use crate::reconfigure::plan::Outcome;
use crate::reconfigure::problem::Problem;
use crate::reconfigure::refusal::{Impossible, Which};
use crate::reconfigure::{Method, Options, Reduction};
use crate::robot::{Cell, Configuration, Obstacle, Shape};
use crate::spatial::{Pose, Vec3};

use super::{cubes, goal, plan, solved};

/// Cubes, the first one held, on a block of two by two cells and the height of one.
fn on_a_block(filled: &[Cell]) -> Configuration {
    let mut robot = cubes(filled, 1);
    let pitch = robot.pitch();
    let shape = Shape::Cuboid { half_extents: Vec3::new(pitch, pitch, pitch / 2.0) }.into();
    let pose = Pose::translation(pitch / 2.0, pitch / 2.0, pitch / 2.0);
    robot.environment.obstacles.push(Obstacle { shape, pose, friction: 0.5 });
    robot
}

const FOOT: [Cell; 4] = [[0, 0, 1], [1, 0, 1], [2, 0, 1], [2, 0, 0]];
const NO_FOOT: [Cell; 4] = [[0, 0, 1], [1, 0, 1], [2, 0, 1], [3, 0, 1]];

#[test]
fn the_last_module_on_the_ground_stays_there() {
    let (foot, none) = (on_a_block(&FOOT), on_a_block(&NO_FOOT));
    for reduction in [Reduction::Saturated, Reduction::Primitive] {
        let options = Options { reduction, ..Options::default() };
        let up = plan(&foot, &goal(none.clone()), &options);
        assert_eq!(up.outcome, Outcome::Impossible(Impossible::Sealed { level: 0, which: Which::Goal }));
        let down = plan(&none, &goal(foot.clone()), &options);
        assert_eq!(down.outcome, Outcome::Impossible(Impossible::Sealed { level: 0, which: Which::Start }));
    }
    let options = Options { method: Method::Decompose, ..Options::default() };
    let up = plan(&foot, &goal(none), &options);
    assert!(matches!(up.outcome, Outcome::Impossible(Impossible::Sealed { .. })), "{up:?}");
}

#[test]
fn with_room_below_it_comes_up_and_goes_down() {
    let airy = |filled: &[Cell]| {
        let mut robot = on_a_block(filled);
        robot.environment.ground = None;
        robot
    };
    for (from, to) in [(FOOT, NO_FOOT), (NO_FOOT, FOOT)] {
        assert_eq!(solved(&plan(&airy(&from), &goal(airy(&to)), &Options::default())).moves, 1);
        // One level higher, the ground is too far away to be in the way.
        let higher = |cells: [Cell; 4]| cubes(&cells.map(|[x, y, z]| [x, y, z + 1]), 1);
        assert_eq!(solved(&plan(&higher(from), &goal(higher(to)), &Options::default())).moves, 1);
    }
}

/// All layouts in a box that lead to each other, by any moves that fit.
#[test]
fn no_sequence_of_moves_empties_the_ground_or_reaches_it() {
    for (from, has_foot) in [(FOOT, true), (NO_FOOT, false)] {
        let start = on_a_block(&from);
        let problem = Problem::new(&start, &goal(start.clone())).unwrap();
        let domain = Domain::new(&problem, false);
        let mut seen: HashSet<Layout> = HashSet::from([problem.start_layout().clone()]);
        let mut next = vec![problem.start_layout().clone()];
        while let Some(layout) = next.pop() {
            for step in domain.moves(&layout) {
                let within = step.to().into_iter().all(|c| (-2..=4).contains(&c));
                let after = domain.after(&layout, step);
                if within && domain.stays_connected(&layout, &layout.touching(), step) && seen.insert(after.clone()) {
                    next.push(after);
                }
            }
        }
        assert!(seen.len() > 100, "{}", seen.len());
        let stands = |layout: &Layout| layout.placed().iter().any(|placed| placed.cell[2] == 0);
        assert!(seen.iter().all(|layout| stands(layout) == has_foot));
    }
}
