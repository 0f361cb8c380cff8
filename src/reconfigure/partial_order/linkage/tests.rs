//! Whatever the order of a linkage's plan allows holds: orders by the replay, overlaps by moments of random runs.

use nalgebra::Vector3;
use petgraph::graph::NodeIndex;

use crate::geometry::{SKIN, Solid, Surroundings, overlap};
use crate::reconfigure::linkage::assembly::{Assembler, Held, Touched, Transient};
use crate::reconfigure::linkage::replay::legality::transition;
use crate::reconfigure::linkage::replay::{after, replay};
use crate::reconfigure::linkage::tests::{chain, goal, module, robot, solved, standing, string};
use crate::reconfigure::linkage::{Action, Half};
use crate::reconfigure::partial_order::random_runs::{Draw, Run, waits};
use crate::reconfigure::partial_order::{Because, OrderError, OrderOptions, PartialOrder};
use crate::reconfigure::{Objective, Options, Plan, PlannedAction};
use crate::robot::linkage::{Code, Connection, Linkage, Port, Spot};
use crate::robot::{Catalogue, JointType, Shape};
use crate::spatial::{Pose, Rotation, Vec3};
use crate::statics::{Question, assess};

use super::nesting::Turn;
use super::{difference, partial_order};

type LinkagePlan = Plan<Action, Held>;

/// A robot and a plan for it.
type Case = (Linkage, LinkagePlan);

fn plan_of(actions: &[Action]) -> LinkagePlan {
    let planned = |&action: &Action| PlannedAction { action, margin: None, phase: None };
    let moves = actions.iter().filter(|action| action.is_move()).count() as u32;
    Plan { moves, actions: actions.iter().map(planned).collect(), ..Plan::EMPTY }
}

fn end(start: &Linkage, plan: &LinkagePlan) -> Linkage {
    after(start, plan.actions.iter().map(|planned| &planned.action)).expect("the plan is legal")
}

fn verified(start: &Linkage, plan: &LinkagePlan, required: f64) -> bool {
    let end = goal(end(start, plan));
    replay(start, &end, plan, required).expect("the structures are sound").failures.is_empty()
}

fn order(start: &Linkage, plan: &LinkagePlan) -> PartialOrder<Touched> {
    partial_order(start, plan, &OrderOptions::default()).expect("the plan holds")
}

/// Why an action waits for another directly.
fn reason(order: &PartialOrder<Touched>, action: usize, other: usize) -> Option<&Because<Touched>> {
    let edge = order.graph.find_edge(NodeIndex::new(other), NodeIndex::new(action))?;
    order.graph.edge_weight(edge)
}

/// Three modules end to end; the first half of the one in the middle is held, and the outer ones swing aside.
fn two_arms() -> Case {
    let mut robot = chain(&[[0, 0, 0]; 3], &[0, 0]);
    robot.gravity = Vec3::new(0.0, 0.0, -9.81);
    robot.modules[1].fixed = true;
    let swing = |module: usize, joint: usize| Action::Rotate { module, joint, to: 1, carried: Half::Parent };
    (robot, plan_of(&[swing(0, 1), swing(2, 0)]))
}

/// Three modules end to end, the first one held; two joints bend, one beyond the other.
fn snake() -> Case {
    let mut robot = standing(chain(&[[0, 0, 0]; 3], &[0, 0]), None);
    robot.gravity = Vec3::new(0.0, 0.0, -3.0);
    let inner = Action::Rotate { module: 0, joint: 1, to: 1, carried: Half::Child };
    let outer = Action::Rotate { module: 2, joint: 0, to: 1, carried: Half::Parent };
    (robot, plan_of(&[inner, outer]))
}

/// A node that is held, with slender struts at these spots in degrees (azimuth, polar); on a mast or not.
fn star(spots: &[[i32; 2]], on_a_mast: bool) -> (Linkage, Vec<Connection>) {
    let mut catalogue = Catalogue::freesn();
    catalogue.module_types[1].bodies[0].shape = Shape::Cylinder { radius: 0.012, height: 0.075 };
    let mut modules = vec![module(&catalogue, "node", 0, Pose::identity(), &[])];
    if on_a_mast {
        modules.push(module(&catalogue, "strut", 1, Pose::translation(0.0, 0.0, 0.1035), &[]));
        modules.push(module(&catalogue, "node", 2, Pose::translation(0.0, 0.0, 0.207), &[]));
    }
    let hub = modules.len() - 1;
    let mut connections = Vec::new();
    for &[azimuth, polar] in spots {
        let index = modules.len();
        modules.push(module(&catalogue, "strut", index, Pose::identity(), &[]));
        let held = Connection::new(Port { module: hub, port: 0 }, Port { module: index, port: 0 });
        let across = robot(catalogue.clone(), modules.clone()).across(&held, Code::OnSurface(spot(azimuth, polar)));
        modules[index].pose = modules[hub].pose * across;
        connections.push(held);
    }
    (standing(robot(catalogue, modules), None), connections)
}

fn spot(azimuth: i32, polar: i32) -> Spot {
    Spot::new(azimuth * 1_000_000, polar * 1_000_000, 0)
}

fn roll(connection: Connection, to: Spot) -> Action {
    Action::Roll { connection, to, carried: connection.ports[1].module }
}

/// Two struts on one node whose ways cross half-way, where each is clear of the ends of the other.
fn crossing() -> Case {
    let (mut robot, held) = star(&[[0, 90], [45, 45]], false);
    robot.gravity = Vec3::zeros();
    (robot, plan_of(&[roll(held[0], spot(90, 90)), roll(held[1], spot(45, 135))]))
}

/// Two struts at right angles on a mast, each of which rolls past where it is level.
fn on_a_mast() -> Case {
    let (robot, held) = star(&[[0, 45], [90, 45]], true);
    (robot, plan_of(&[roll(held[0], spot(0, 135)), roll(held[1], spot(90, 135))]))
}

/// A square of struts and nodes that is opened, folded up about one of its struts and closed again, and a strut of
/// its own on the node that is held.
fn square() -> Case {
    let catalogue = Catalogue::freesn();
    let (length, up) = (0.207, Vec3::z());
    let corners = [Vec3::zeros(), Vec3::x(), Vec3::x() + Vec3::y(), Vec3::y()];
    let mut modules = Vec::new();
    let mut add = |kind: &str, at: Vec3, along: Vec3| {
        let turn = Rotation::rotation_between(&up, &along).expect("not straight down");
        let pose = Pose::from_parts((at * length).into(), turn);
        modules.push(module(&catalogue, kind, modules.len(), pose, &[]));
    };
    corners.iter().for_each(|corner| add("node", *corner, up));
    for i in 0..4 {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        add("strut", (a + b) / 2.0, b - a);
    }
    add("strut", -Vec3::x() / 2.0, -Vec3::x());
    let mut robot = robot(catalogue, modules);
    robot.modules[0].fixed = true;
    let held = |node: usize, strut: usize| {
        *robot.connections.iter().find(|held| held.modules() == [node, strut]).expect("they touch")
    };
    let about_y = Rotation::from_axis_angle(&Vector3::y_axis(), -std::f64::consts::FRAC_PI_2);
    let folded = |connection: Connection| {
        let Code::OnSurface(from) = robot.code(&connection) else { panic!("a strut on a node") };
        roll(connection, Spot::of(&(about_y * from.rotation())))
    };
    let (closing, fold, own) = (held(3, 7), folded(held(0, 4)), folded(held(0, 8)));
    let plan = plan_of(&[Action::Detach(closing), fold, Action::Attach(closing), own]);
    (robot, plan)
}

/// What the planner finds for a chain and for a string.
fn planned() -> [Case; 2] {
    let found = |mut start: Linkage, end: Linkage| {
        start.gravity /= 4.0;
        let options = Options { objective: Objective::Moves, ..Options::default() };
        let report = crate::reconfigure::linkage::tests::plan(&start, &goal(end), &options);
        let plan = solved(&report).clone();
        (start, plan)
    };
    [
        found(
            standing(chain(&[[0, 0, 0], [0, 0, 0]], &[0]), None),
            standing(chain(&[[0, 1, 0], [1, 0, 0]], &[0]), None),
        ),
        found(standing(string(&[[0, 90, 0], [90, 90, 0]]), None), standing(string(&[[90, 90, 0], [180, 90, 0]]), None)),
    ]
}

fn all() -> Vec<Case> {
    [two_arms(), snake(), crossing(), on_a_mast(), square()].into_iter().chain(planned()).collect()
}

#[test]
fn arms_on_either_side_of_what_is_held_swing_at_once() {
    let (start, plan) = two_arms();
    assert!(verified(&start, &plan, 0.0));
    let order = order(&start, &plan);
    assert!(!waits(&order, 1, 0), "{:?}", order.graph);
    assert_eq!(order.timetable(|_| 1.0).makespan, 1.0);
    assert!(order.is_complete && order.checked.overlaps > 0 && order.margin.lower >= 0.0);
}

#[test]
fn joints_of_a_snake_bend_at_once() {
    let (start, plan) = snake();
    assert!(verified(&start, &plan, 0.0));
    let order = order(&start, &plan);
    assert!(!waits(&order, 1, 0), "{:?}", order.graph);
}

#[test]
fn struts_that_could_hit_each_other_wait() {
    let (start, plan) = crossing();
    let reversed = plan_of(&[plan.actions[1].action, plan.actions[0].action]);
    assert!(verified(&start, &plan, 0.0) && verified(&start, &reversed, 0.0));
    assert_eq!(reason(&order(&start, &plan), 1, 0), Some(&Because::WaysCross));
}

#[test]
fn what_stands_one_by_one_but_not_at_once_waits() {
    let (start, plan) = on_a_mast();
    let reversed = plan_of(&[plan.actions[1].action, plan.actions[0].action]);
    let margin = |plan: &LinkagePlan| {
        let end = goal(end(&start, plan));
        replay(&start, &end, plan, 0.0).expect("the structures are sound").margin.lower
    };
    let required = margin(&plan).min(margin(&reversed)) - 1e-3;
    assert!(required > 0.0 && verified(&start, &plan, required) && verified(&start, &reversed, required));
    let lenient = order(&start, &plan);
    assert!(!waits(&lenient, 1, 0) && lenient.margin.lower < required, "{} {required}", lenient.margin.lower);
    let options = OrderOptions { required, ..OrderOptions::default() };
    let strict = partial_order(&start, &plan, &options).expect("it holds in its own order");
    assert_eq!(reason(&strict, 1, 0), Some(&Because::Unstable));
    assert!(strict.margin.lower >= required - 1e-6);
}

#[test]
fn what_opens_and_closes_a_loop_keeps_its_order_and_the_rest_does_not_wait() {
    let (start, plan) = square();
    assert!(verified(&start, &plan, 0.0));
    let order = order(&start, &plan);
    let [detach, fold, attach, own] = [0, 1, 2, 3];
    assert!(waits(&order, fold, detach) && waits(&order, attach, fold));
    assert_eq!(order.waits_for(own), [] as [usize; 0], "{:?}", order.graph);
}

#[test]
fn who_turns_what_the_other_turns_on_waits() {
    // Nothing is held: whoever moves last would have to be told where the other has taken the robot.
    let start = chain(&[[0, 0, 0]; 3], &[0, 0]);
    let first = Action::Rotate { module: 0, joint: 1, to: 1, carried: Half::Child };
    let last = Action::Rotate { module: 2, joint: 0, to: 1, carried: Half::Child };
    let order = order(&start, &plan_of(&[first, last]));
    assert_eq!(reason(&order, 1, 0), Some(&Because::OtherPlaces));
    let state = start.clone();
    let turns: Vec<Turn> = [first, last].iter().filter_map(|action| Turn::of(&state, action).unwrap()).collect();
    assert_eq!(super::Nesting::of(&state, &turns).err(), Some(Because::Entangled));
}

#[test]
fn one_joint_turns_once_at_a_time() {
    let (start, _) = snake();
    let turn = |to: i32| Action::Rotate { module: 0, joint: 2, to, carried: Half::Child };
    let order = order(&start, &plan_of(&[turn(1), turn(2)]));
    assert_eq!(reason(&order, 1, 0), Some(&Because::SameJoint));
}

#[test]
fn a_plan_that_does_not_hold_has_no_order() {
    let (start, plan) = snake();
    let twice = plan_of(&[plan.actions[0].action, plan.actions[0].action]);
    let broken = partial_order(&start, &twice, &OrderOptions::default()).map(|order| order.checked);
    assert!(matches!(broken, Err(OrderError::Broken { action: Some(1), .. })), "{broken:?}");
}

#[test]
fn the_order_does_not_depend_on_the_number_of_threads() {
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let (start, plan) = on_a_mast();
        pool.install(|| order(&start, &plan))
    };
    let [one, three] = [of(1), of(3)];
    assert_eq!((one.margin, one.checked), (three.margin, three.checked));
}

#[test]
fn every_order_that_the_graph_allows_replays_to_the_same_state() {
    for (start, plan) in all() {
        let order = order(&start, &plan);
        let expected = end(&start, &plan);
        for seed in 0..4 {
            let mut draw = Draw(seed);
            let mut shuffled = Vec::new();
            let mut left: Vec<usize> = (0..plan.actions.len()).collect();
            while !left.is_empty() {
                let free = |action: usize| order.waits_for(action).iter().all(|before| !left.contains(before));
                let free: Vec<usize> = left.iter().copied().filter(|&action| free(action)).collect();
                let next = free[draw.below(free.len())];
                left.retain(|&action| action != next);
                shuffled.push(plan.actions[next].action);
            }
            let shuffled = plan_of(&shuffled);
            assert_eq!(difference(&end(&start, &shuffled), &expected), None);
            assert!(verified(&start, &shuffled, 0.0));
        }
    }
}

#[test]
fn every_moment_of_every_overlap_holds() {
    for (start, plan) in all() {
        let order = order(&start, &plan);
        for seed in 0..4 {
            let mut draw = Draw(seed);
            let run = Run::random(&order, plan.actions.len(), &mut draw);
            for now in run.moments(&mut draw) {
                holds_at(&start, &plan, &run, now);
            }
        }
    }
}

/// Checks a run at one moment.
fn holds_at(start: &Linkage, plan: &LinkagePlan, run: &Run, now: f64) {
    let action = |i: usize| &plan.actions[i].action;
    let mut state = start.clone();
    state.connections.sort_unstable();
    for done in run.done(now, |i| matches!(action(i), Action::Detach(_))) {
        state = transition(&state, action(done)).unwrap().after;
    }
    // One after the other, each about its line where the ones before have taken that.
    let mut bodies: Vec<Vec<Pose>> = (0..state.modules.len()).map(|module| state.body_poses(module)).collect();
    let mut taken: Vec<Vec<Pose>> = bodies.iter().map(|of| vec![Pose::identity(); of.len()]).collect();
    for (index, phase) in run.under_way(now).filter(|&(i, _)| action(i).is_move()) {
        let path = transition(&state, action(index)).unwrap().path.unwrap();
        let [module, body] = rests_on(&state, action(index));
        let frame = taken[module][body];
        let by = frame * path.motion.at(phase) * frame.inverse();
        for carried in &path.carried {
            let (pose, taken) = (&mut bodies[carried.module][carried.body], &mut taken[carried.module][carried.body]);
            (*pose, *taken) = (by * *pose, by * *taken);
        }
    }
    let solids: Vec<(usize, usize, Solid)> = (0..state.modules.len())
        .flat_map(|m| state.module_type(m).bodies.iter().enumerate().map(move |(b, kind)| (m, b, kind)))
        .map(|(m, b, kind)| (m, b, Solid::new(kind.shape.clone(), bodies[m][b] * kind.shape_pose)))
        .collect();
    let around = Surroundings::new(&state.environment);
    for (index, (m, b, solid)) in solids.iter().enumerate() {
        let skin = 2.0 * SKIN * solid.size();
        for (other_m, other_b, other) in &solids[..index] {
            let joint = |j: &JointType| [j.parent + j.child, j.parent.min(j.child)] == [b + other_b, *b.min(other_b)];
            let joined = m == other_m && state.module_type(*m).joints.iter().any(joint);
            assert!(joined || !overlap(solid, other, skin), "{m}.{b} and {other_m}.{other_b} at {now}: {run:?}");
        }
        assert_eq!(around.overlaps(solid, skin), []);
    }
    let engaged = &state.connections;
    let structure = Assembler::new(start).assemble(&Transient { bodies: &bodies, engaged }).structure;
    assert!(assess(&structure, Question::VALUE).unwrap().margin().lower >= 0.0);
    assert!(state.is_connected());
}

/// The module and the body that a move turns its side against.
fn rests_on(state: &Linkage, action: &Action) -> [usize; 2] {
    match *action {
        Action::Rotate { module, joint, carried, .. } => {
            let kind = &state.module_type(module).joints[joint];
            [module, if carried == Half::Child { kind.parent } else { kind.child }]
        }
        Action::Roll { connection, carried, .. } => {
            let port = connection.ports.into_iter().find(|port| port.module != carried).unwrap();
            [port.module, state.module_type(port.module).ports[port.port].body]
        }
        Action::Attach(_) | Action::Detach(_) => panic!("no move"),
    }
}
