//! Laws of linkages' moves and states, and the planner against unlike methods.

mod agreement;
mod laws;
mod motion_range;
mod primitive;
mod stability;

use std::sync::Arc;

use crate::reconfigure::options::Options;
use crate::reconfigure::plan::{Outcome, Plan, Report};
use crate::robot::linkage::{Connection, Goal, Linkage, Module, Port, Spot, child_pose, mated};
use crate::robot::{Catalogue, Environment, Ground, Matching, PortPlace, Requirement};
use crate::spatial::{Pose, Vec3};

use super::action::Action;
use super::assembly::Held;
use super::replay::replay;
use super::solve::solve;

/// A module of a type by name at a pose.
pub fn module(catalogue: &Catalogue, kind: &str, id: usize, pose: Pose, joints: &[i32]) -> Module {
    let module_type = catalogue.find(kind).expect("a type of the catalogue");
    Module { id: format!("m{id}"), module_type, pose, joints: joints.to_vec(), fixed: false }
}

/// A robot of modules in an empty world, everything that meets engaged.
pub fn robot(catalogue: Catalogue, modules: Vec<Module>) -> Linkage {
    let mut linkage = Linkage {
        catalogue: Arc::new(catalogue),
        gravity: Vec3::zeros(),
        environment: Environment::default(),
        modules,
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    };
    linkage.connections = linkage.touching();
    linkage
}

/// A chain of universal modules with these joints, each docked with its -Z of A to -Z of B of the one before,
/// turned by so many quarters.
pub fn chain(joints: &[[i32; 3]], rolls: &[i32]) -> Linkage {
    let catalogue = Catalogue::rofi();
    let kind = &catalogue.module_types[0];
    let [a, b] = ["A-Z", "B-Z"].map(|name| kind.port(name).expect("a dock"));
    let mut modules = vec![module(&catalogue, "universal", 0, Pose::identity(), &joints[0])];
    for (index, (joints, roll)) in joints[1..].iter().zip(rolls).enumerate() {
        let before: &Module = &modules[index];
        let body = before.pose * kind.body_poses(&before.joints)[kind.ports[b].body];
        let PortPlace::Point { frame, .. } = &kind.ports[b].place else { unreachable!("docks are points") };
        let port = mated(&(body * frame), f64::from(*roll) * std::f64::consts::FRAC_PI_2);
        let pose = child_pose(kind, a, joints, &port).expect("docks are points");
        modules.push(module(&catalogue, "universal", index + 1, pose, joints));
    }
    robot(catalogue, modules)
}

/// Nodes and struts in turn, from a node at the origin; each strut leaves the node before it at one of these spots
/// in degrees (azimuth, polar, spin).
pub fn string(spots: &[[i32; 3]]) -> Linkage {
    let catalogue = Catalogue::freesn();
    let mut modules = vec![module(&catalogue, "node", 0, Pose::identity(), &[])];
    for &[azimuth, polar, spin] in spots {
        let micro = 1_000_000;
        let spot = Spot::new(azimuth * micro, polar * micro, spin * micro);
        let index = modules.len();
        let mut linkage = robot(catalogue.clone(), modules.clone());
        linkage.modules.push(module(&catalogue, "strut", index, Pose::identity(), &[]));
        let held = Connection::new(Port { module: index - 1, port: 0 }, Port { module: index, port: 0 });
        let strut = modules[index - 1].pose * linkage.across(&held, crate::robot::linkage::Code::OnSurface(spot));
        linkage.modules.push(module(&catalogue, "node", index + 1, Pose::identity(), &[]));
        let top = Connection::new(Port { module: index, port: 1 }, Port { module: index + 1, port: 0 });
        let straight = crate::robot::linkage::Code::OnSurface(Spot::new(0, 0, 0));
        let node = strut * linkage.across(&top, straight);
        modules.push(module(&catalogue, "strut", index, strut, &[]));
        modules.push(module(&catalogue, "node", index + 1, node, &[]));
    }
    robot(catalogue, modules)
}

/// The same robot, its first module held, under gravity over the ground or without.
pub fn standing(mut linkage: Linkage, ground: Option<f64>) -> Linkage {
    linkage.gravity = Vec3::new(0.0, 0.0, -9.81);
    linkage.modules[0].fixed = true;
    linkage.environment.ground = ground.map(|height| Ground { height, friction: 0.8 });
    linkage
}

/// A goal of interchangeable modules in the world frame.
pub fn goal(linkage: Linkage) -> Goal {
    Goal { linkage, matching: Matching::default() }
}

/// A goal of interchangeable modules anywhere.
fn anywhere(linkage: Linkage) -> Goal {
    Goal { linkage, matching: Matching { labelled: false, free_frame: true } }
}

/// Plans and has every plan replayed.
pub fn plan(start: &Linkage, goal: &Goal, options: &Options) -> Report<Action, Held> {
    let report = solve(start, goal, options, &mut |_| {}).expect("the input is sound");
    let required = report.required.unwrap_or(f64::NEG_INFINITY);
    for plan in report.plan.iter().chain(&report.alternatives) {
        let check = replay(start, goal, plan, required).expect("the structures are sound");
        assert_eq!(check.failures, []);
        assert_eq!(check.actions_replayed, plan.actions.len());
    }
    report
}

/// The plan of a report that must have one.
pub fn solved(report: &Report<Action, Held>) -> &Plan<Action, Held> {
    assert_eq!(report.outcome, Outcome::Solved);
    report.plan.as_ref().expect("solved")
}
