//! A dead end that the first choice leads into: backtracking leaves it, and the other direction does not meet it.

use crate::reconfigure::domain::Domain;
use crate::reconfigure::hanging::Rests;
use crate::reconfigure::in_the_way::Nearest;
use crate::reconfigure::options::{Method, Options};
use crate::reconfigure::plan::Outcome;
use crate::reconfigure::problem::Problem;
use crate::reconfigure::refusal::Impossible;
use crate::reconfigure::replay::replay;
use crate::reconfigure::solve;
use crate::reconfigure::tests::{cubes, goal};
use crate::robot::{Cell, Configuration, Obstacle, Placement, Shape};
use crate::spatial::{Pose, Vec3};

use super::builder::{Attempt, Builder};
use super::journey::{Direction, Journey};
use super::order::{First, Lessons, Order};
use super::script::{Ends, write};
use super::ways::Ways;

/// A cube between a wall and a row: it can only slide, and that along what stands on the row.
const CORNERED: Cell = [0, 0, 0];

/// What stands on the row.
const LADDER: Cell = [1, 0, 1];

const ROW: [Cell; 3] = [[1, 0, 0], [2, 0, 0], [3, 0, 0]];

/// Two cells that continue the row are wanted.
const WANTED: [Cell; 2] = [[4, 0, 0], [5, 0, 0]];

/// Cubes of which those in `filled` come after the row, beside a wall of one cube's size.
fn beside_a_wall(filled: [Cell; 2]) -> Configuration {
    let mut robot = cubes(&[ROW.as_slice(), filled.as_slice()].concat(), 0);
    let pitch = robot.pitch();
    let shape = Shape::Cuboid { half_extents: Vec3::repeat(pitch / 2.0) }.into();
    let at = Placement::new([-1, 0, 0]).centre(pitch);
    robot.environment.obstacles.push(Obstacle { shape, pose: Pose::translation(at.x, at.y, at.z), friction: 0.5 });
    robot
}

/// An attempt that puts up with so many dead ends.
fn attempt(domain: &Domain, direction: Direction, seed: u64, patience: usize) -> Attempt {
    let problem = domain.problem;
    let journeys = Journey::both(problem, problem.goal().layout());
    let journey = journeys.iter().find(|journey| journey.direction == direction).unwrap();
    let (mut ways, mut rests) = (Ways::new(domain), Rests::new(problem.start()));
    let mut lessons = Lessons::default();
    let order = Order::new(First::Height, &problem.start().gravity, seed);
    Builder::new(domain, journey, &mut lessons, (0.0, order), patience).run(&mut ways, &mut rests, &mut |_| true)
}

#[test]
fn backtracking_leaves_the_dead_end_of_the_first_choice() {
    let start = beside_a_wall([CORNERED, LADDER]);
    let target = goal(beside_a_wall(WANTED));
    let problem = Problem::new(&start, &target).unwrap();
    let domain = Domain::new(&problem, true);
    for seed in 0..4 {
        // The ladder stands higher, leaves first, and is in place then.
        let Attempt::Stuck(nearest) = attempt(&domain, Direction::Forwards, seed, 0) else { panic!("no dead end") };
        assert_eq!(nearest, Nearest { modules: 5, in_place: 4, stuck: 1 });
        let Attempt::Done(carries) = attempt(&domain, Direction::Forwards, seed, 1) else { panic!("stuck") };
        assert_eq!(carries[0].path[0].from, CORNERED, "the other one leaves first");
        assert_eq!(carries.len(), 2, "what led into the dead end is undone");
    }
    // It is one: with what is in place staying there, the exact search proves that nothing leads on.
    let mut stuck = beside_a_wall([WANTED[0], CORNERED]);
    stuck.require.stay = (0..4).collect();
    let options = Options { method: Method::Exact, ..Options::default() };
    let report = solve(&stuck, &target, &options, &mut |_| {}).unwrap();
    assert_eq!(report.outcome, Outcome::Impossible(Impossible::Exhausted { required: 0.0 }));
}

#[test]
fn backwards_the_same_dead_end_is_not_met() {
    let start = beside_a_wall([CORNERED, LADDER]);
    let target = goal(beside_a_wall(WANTED));
    let problem = Problem::new(&start, &target).unwrap();
    let domain = Domain::new(&problem, true);
    let Attempt::Done(carries) = attempt(&domain, Direction::Backwards, 0, 0) else { panic!("stuck") };
    assert_eq!(carries[0].path[0].from, CORNERED);
    let ends = Ends {
        start: Some(domain.of_state(problem.start_layout(), problem.start_bonds())),
        goal: Some(domain.of_state(problem.goal().layout(), problem.goal().listed())),
    };
    let plan = write(&domain, &mut Ways::new(&domain), &carries, &ends);
    let claimed = plan.margin.unwrap();
    assert!(claimed.lower > 0.0, "{claimed:?}");
    let replayed = replay(&start, &target, &plan, claimed.lower).unwrap();
    assert_eq!(replayed.failures, []);
    assert_eq!(replayed.actions_replayed, plan.actions.len());
}
