//! Every move reverses exactly, and what makes no difference makes none.

use std::collections::HashSet;

use proptest::prelude::*;
use proptest::sample::Index;

use crate::reconfigure::linkage::action::{Action, Half};
use crate::reconfigure::linkage::arrangement::{Arrangement, Arrangements, Frame};
use crate::reconfigure::linkage::clearance::Clearance;
use crate::reconfigure::linkage::moves::{Rules, Step, View};
use crate::reconfigure::linkage::problem::Problem;
use crate::reconfigure::linkage::state::State;
use crate::robot::ModuleLoad;
use crate::robot::linkage::{Code, Connection, Linkage};
use crate::spatial::{Pose, Rotation, Vec3};

use super::{chain, goal, standing, string};

const RULES: Rules = Rules { connected: true, either_side: false };

/// A problem that starts and ends alike.
fn problem(linkage: &Linkage) -> Problem {
    Problem::new(linkage, &goal(linkage.clone())).expect("it is sound")
}

fn view(problem: &Problem, linkage: &Linkage) -> View {
    problem.view(&problem.described(linkage), linkage.touching())
}

/// What was released, moved and engaged.
struct Taken {
    released: Vec<Connection>,
    step: Step,
    engaged: Vec<Connection>,
    back: Action,
    kept: Vec<Connection>,
}

/// Takes a step with the detachments before it and all attachments after it.
fn take(problem: &Problem, state: &mut State, step: Step) -> Taken {
    let before = view(problem, state.linkage());
    let kept = before.kept(&step);
    let engaged = state.linkage().connections.clone();
    let released: Vec<Connection> = engaged.into_iter().filter(|connection| !kept.contains(connection)).collect();
    for &connection in &released {
        state.detach(connection);
    }
    let before = problem.view(&problem.described(state.linkage()), kept.clone());
    let step = before.once_released(&step, RULES).expect("releasing what is torn leaves the move");
    let back = match step.action {
        Action::Rotate { module, joint, carried, .. } => {
            Action::Rotate { module, joint, to: state.linkage().modules[module].joints[joint], carried }
        }
        Action::Roll { connection, carried, .. } => {
            let Code::OnSurface(to) = state.linkage().code(&connection) else { unreachable!("it is on a ball") };
            Action::Roll { connection, to, carried }
        }
        Action::Attach(_) | Action::Detach(_) => unreachable!("steps are moves"),
    };
    state.take(&before, &step);
    let engaged: Vec<Connection> =
        state.linkage().touching().into_iter().filter(|connection| !kept.contains(connection)).collect();
    for &connection in &engaged {
        state.attach(connection);
    }
    Taken { released, step, engaged, back, kept }
}

/// Takes it back.
fn take_back(problem: &Problem, state: &mut State, taken: &Taken) {
    let all = view(problem, state.linkage());
    for &connection in &taken.engaged {
        state.detach(connection);
    }
    let now = problem.view(&problem.described(state.linkage()), taken.kept.clone());
    let is_back_with_all = |step: &Step| all.kept(step) == taken.kept && step.carried == taken.step.carried;
    assert!(all.steps(RULES).iter().any(is_back_with_all), "every move has a way back");
    let is_back = |step: &Step| step.action == taken.back && step.carried == taken.step.carried;
    let step = now.steps(RULES).into_iter().find(is_back).expect("every move has a way back");
    state.take(&now, &step);
    for &connection in &taken.released {
        state.attach(connection);
    }
}

/// Walks at random and back.
fn there_and_back(linkage: &Linkage, choices: &[Index]) {
    let problem = problem(linkage);
    let first = State::new(problem.start.clone());
    let mut state = first.clone();
    let mut walk = Vec::new();
    let clearance = Clearance::new(&problem);
    for choice in choices {
        let now = view(&problem, state.linkage());
        let free = |step: &Step| clearance.is_free(&now, step);
        let steps: Vec<Step> = now.steps(RULES).into_iter().filter(free).collect();
        if steps.is_empty() {
            break;
        }
        walk.push(take(&problem, &mut state, choice.get(&steps).clone()));
    }
    for taken in walk.iter().rev() {
        take_back(&problem, &mut state, taken);
    }
    assert_eq!(state, first);
}

fn quarters() -> impl Strategy<Value = [i32; 3]> {
    (-1..=1, -1..=1, 0..4).prop_map(|(a, b, c)| [a, b, c])
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn a_chain_comes_back_to_the_identical_state(
        joints in prop::collection::vec(quarters(), 3),
        rolls in prop::collection::vec(0..4, 2),
        choices in prop::collection::vec(any::<Index>(), 40),
    ) {
        there_and_back(&chain(&joints, &rolls), &choices);
    }

    #[test]
    fn a_freeform_robot_comes_back_to_the_identical_state(
        spots in prop::collection::vec((0..360, 0..=180, 0..360), 2),
        choices in prop::collection::vec(any::<Index>(), 40),
    ) {
        let spots: Vec<[i32; 3]> = spots.into_iter().map(|(a, p, s)| [a, p, s]).collect();
        there_and_back(&string(&spots), &choices);
    }

    #[test]
    fn where_and_which_makes_no_difference_in_an_empty_world(
        joints in prop::collection::vec(quarters(), 4),
        rolls in prop::collection::vec(0..4, 3),
        order in Just(vec![0, 1, 2, 3]).prop_shuffle(),
        ways in prop::collection::vec(any::<Index>(), 4),
        turn in prop::array::uniform4(-1.0..1.0_f64),
        by in prop::array::uniform3(-1.0..1.0_f64),
    ) {
        let linkage = chain(&joints, &rolls);
        let problem = problem(&linkage);
        let arrangements = Arrangements::new(&problem.classes, Frame::Free);
        let described = problem.described(&linkage);
        let quaternion = nalgebra::Quaternion::new(turn[0] + 2.0, turn[1], turn[2], turn[3]);
        let displacement = Pose::from_parts(Vec3::from(by).into(), Rotation::from_quaternion(quaternion));
        let other: Vec<_> = order.iter().map(|&index| {
            let (class, pose, joints) = &described[index];
            let kind = &problem.classes[*class].kind;
            let symmetry = ways[index].get(&problem.classes[*class].symmetries);
            let (pose, joints) = symmetry.described(kind, pose, joints);
            (*class, displacement * pose, joints.into())
        }).collect();
        prop_assert_eq!(arrangements.of(&described).arrangement, arrangements.of(&other).arrangement);
    }

    #[test]
    fn a_freeform_robot_moves_alike_however_its_modules_are_described(
        spots in prop::collection::vec((0..4, 0..=2, 0..4), 2),
        grid in prop::sample::select(vec![90, 45]),
        ways in prop::collection::vec(any::<Index>(), 5),
    ) {
        let spots: Vec<[i32; 3]> = spots.into_iter().map(|(a, p, s)| [a * grid, p * grid, s * grid]).collect();
        let linkage = string(&spots);
        let problem = problem(&linkage);
        let mut other = linkage.clone();
        for (module, way) in other.modules.iter_mut().zip(&ways) {
            let class = problem.classes.iter().find(|class| class.module_type == module.module_type);
            let class = class.expect("every module has a class");
            (module.pose, _) = way.get(&class.symmetries).described(&class.kind, &module.pose, &module.joints);
        }
        let arrangements = Arrangements::new(&problem.classes, Frame::World);
        let reached = |linkage: &Linkage| -> HashSet<Arrangement> {
            let view = view(&problem, linkage);
            view.steps(RULES).iter().map(|step| arrangements.of(&view.after(step)).arrangement).collect()
        };
        prop_assert_eq!(reached(&linkage), reached(&other));
    }

    #[test]
    fn a_difference_makes_one(
        joints in prop::collection::vec(quarters(), 3),
        rolls in prop::collection::vec(0..4, 2),
        choice in any::<Index>(),
    ) {
        // A step by 90 degrees about a joint with docks on either side always shows, but where all that turns is
        // symmetric about the joint's axis: distances of centres of mass and docks tell.
        let linkage = chain(&joints, &rolls);
        let problem = problem(&linkage);
        let arrangements = Arrangements::new(&problem.classes, Frame::Free);
        let view = view(&problem, &linkage);
        let steps = view.steps(RULES);
        let step = choice.get(&steps);
        let after = view.after(step);
        let same = arrangements.of(&problem.described(&linkage)).arrangement == arrangements.of(&after).arrangement;
        let marks = |modules: &[super::super::problem::Described]| {
            let mut points: Vec<Vec3> = Vec::new();
            for (class, pose, joints) in modules {
                let kind = &problem.classes[*class].kind;
                for (body, local) in kind.bodies.iter().zip(kind.body_poses(joints)) {
                    points.push((pose * local * nalgebra::Point3::from(body.com)).coords);
                }
            }
            let mut distances: Vec<i64> = Vec::new();
            for a in &points {
                distances.extend(points.iter().map(|b| ((a - b).norm() * 1e7).round() as i64 / 10));
            }
            distances.sort_unstable();
            distances
        };
        if marks(&problem.described(&linkage)) != marks(&after) {
            prop_assert!(!same);
        }
    }
}

#[test]
fn what_is_held_stays() {
    let linkage = standing(chain(&[[0, 0, 0], [1, 0, 0]], &[0]), None);
    let problem = problem(&linkage);
    let view = view(&problem, &linkage);
    for step in view.steps(RULES) {
        assert!(!view.moves(&step, 0, 0), "{step:?}");
        if let Action::Rotate { module: 1, carried, joint, .. } = step.action {
            // The second module hangs by its shoe A, the child of alpha.
            let expected = if joint == 0 { Half::Parent } else { Half::Child };
            assert_eq!(carried, expected);
        }
    }
}

#[test]
fn the_symmetries_of_modules_follow_from_their_types() {
    let count =
        |linkage: &Linkage| problem(linkage).classes.iter().map(|class| class.symmetries.len()).collect::<Vec<_>>();
    // Halves swapped, and either half turned over with its joint's sign: 2 times 2 times 2.
    assert_eq!(count(&chain(&[[0, 0, 0]], &[])), [8]);
    // A node turned like a cube where struts are on its axes only, otherwise by quarters or upside down; a strut by
    // half a turn, since it holds less across than along, or its ends swapped.
    assert_eq!(count(&string(&[[0, 90, 0]])), [24, 4]);
    assert_eq!(count(&string(&[[0, 45, 0]])), [8, 4]);
    // A load at the middle lets them be, one at a strut's end tells its ends apart.
    let load = |module, at| ModuleLoad { module, force: Vec3::z(), torque: Vec3::zeros(), at };
    let mut loaded = string(&[[0, 90, 0], [0, 90, 0]]);
    loaded.loads = vec![load(1, None), load(2, None), load(3, Some(Vec3::new(0.0, 0.0, 0.0435)))];
    assert_eq!(count(&loaded), [24, 4, 24, 2]);
}
