//! A world of the platform to a linkage.

use std::collections::{HashMap, VecDeque};
use std::sync::Arc;

use super::super::super::codes;
use super::super::super::findings::Findings;
use super::super::super::json::clipped;
use super::super::configuration::Surroundings;
use super::super::faults;
use super::world::{Anchor, Joint, Joints, Kind, Module, World};
use crate::geometry::linkage_problems;
use crate::robot::linkage::{self, Connection, Linkage, Port, mated};
use crate::robot::{Catalogue, Fault, ModuleType, Part, PortPlace, rofi};
use crate::spatial::Pose;

/// Steps of joints that are tried, in degrees: divisors of 90.
const STEPS: [u32; 12] = [90, 45, 30, 18, 15, 10, 9, 6, 5, 3, 2, 1];

/// Difference in degrees up to which an angle is one that is meant.
const SAME_DEGREES: f64 = 1e-6;

/// Distance in cells, and angle in rad, up to which places agree.
const SAME_PLACE: f64 = 1e-5;

/// Numbers of the components shoe A, body A, body B, shoe B of a universal module start here.
const FIRST_BODY: usize = 6;

/// What a catalogue must have for some worlds.
#[derive(Clone, Debug, Default)]
pub(in super::super) struct Needs {
    degrees: Vec<u32>,
    pads: Vec<[u32; 2]>,
}

impl Needs {
    /// Adds what a world needs; what no catalogue has is for [`build`] to report.
    pub(in super::super) fn add(&mut self, world: &World<'_>) {
        for module in &world.modules {
            match &module.kind {
                Kind::Universal(joints) => {
                    let whole = joints.iter().map(|(degrees, _)| degrees.rem_euclid(90.0).round() as u32);
                    self.degrees.extend(whole);
                }
                Kind::Pad(size) => self.pads.push(*size),
            }
        }
    }

    /// The catalogue with the largest step of joints that reaches all positions, and with all pads.
    pub(in super::super) fn catalogue(&self) -> Catalogue {
        let reaches = |step: &u32| self.degrees.iter().all(|degrees| degrees % step == 0);
        let step = STEPS.into_iter().find(reaches).unwrap_or(1);
        Catalogue::rofi_with(step, &self.pads)
    }
}

/// The robot of a world, of modules of this catalogue.
pub(in super::super) fn build(
    world: &World<'_>,
    catalogue: Arc<Catalogue>,
    surroundings: Surroundings,
    findings: &mut Findings,
) -> Option<Linkage> {
    let before = findings.count();
    let modules: Vec<_> = world.modules.iter().filter_map(|module| module_of(module, &catalogue, findings)).collect();
    if findings.count() > before {
        return None;
    }
    let Surroundings { gravity, environment, loads, require } = surroundings;
    let mut linkage = Linkage { catalogue, gravity, environment, modules, connections: Vec::new(), loads, require };
    let listed: &[Joint<'_>] = match &world.joints {
        Joints::Listed(listed) => listed,
        Joints::Facing => &[],
    };
    check_docks(world, listed, findings);
    place(&mut linkage, world, listed, findings);
    if findings.count() > before {
        return None;
    }
    linkage.connections = match world.joints {
        Joints::Listed(_) => listed.iter().map(connection).collect(),
        Joints::Facing => linkage.touching(),
    };
    linkage.connections.sort_unstable();
    let ids: Vec<_> = linkage.modules.iter().map(|module| module.id.as_str()).collect();
    for problem in linkage.problems().iter().chain(&linkage_problems(&linkage)) {
        let mark = match problem.part {
            Part::Module(module) => &world.modules[module].mark,
            _ => &world.whole,
        };
        if let Some((code, message, hint)) = faults::describe(problem, &ids) {
            // These files have no way to say that a robot may be in parts.
            let hint = if problem.fault == Fault::Disconnected { "join it to the others" } else { hint };
            mark.report(findings, code, message, hint);
        }
    }
    Some(linkage)
}

/// A module, still without a place.
fn module_of(module: &Module<'_>, catalogue: &Catalogue, findings: &mut Findings) -> Option<linkage::Module> {
    let name = match module.kind {
        Kind::Universal(_) => "universal".to_string(),
        Kind::Pad(size) => rofi::pad_name(size),
    };
    let Some(module_type) = catalogue.find(&name) else {
        let message = format!("the start's catalogue `{}` has no `{name}`", clipped(&catalogue.name));
        let hint = "start and goal are of one catalogue: take \"rofi\", or give the start as a RoFI file too";
        module.mark.report(findings, codes::MODULE_TYPES, message, hint);
        return None;
    };
    let joints = match &module.kind {
        Kind::Pad(_) => Vec::new(),
        Kind::Universal(joints) => {
            let kinds = &catalogue.module_types[module_type].joints;
            let named = ["alpha", "beta", "gamma"].into_iter().zip(joints);
            let positions: Vec<_> = named
                .zip(kinds)
                .filter_map(|((name, (degrees, mark)), kind)| {
                    let steps = degrees / kind.step_degrees;
                    let position = steps.round();
                    let is_whole = (position - steps).abs() * kind.step_degrees <= SAME_DEGREES;
                    let (code, message, hint) = if !is_whole || !(position.abs() < 1e6) {
                        let message =
                            format!("{name} is {degrees} degrees, and turns in steps of {}", kind.step_degrees);
                        (codes::UNSUPPORTED, message, "joints of RoFI modules turn in whole degrees here")
                    } else if !kind.allows(position as i32) {
                        let message = format!("{name} is {degrees} degrees");
                        (codes::OUT_OF_RANGE, message, "alpha and beta turn from -90 to 90 degrees")
                    } else {
                        return Some(kind.canonical(position as i32));
                    };
                    mark.report(findings, code, message, hint);
                    None
                })
                .collect();
            if positions.len() != kinds.len() {
                return None;
            }
            positions
        }
    };
    let fixed = matches!(module.kind, Kind::Pad(_));
    Some(linkage::Module { id: module.id.clone(), module_type, pose: Pose::identity(), joints, fixed })
}

fn port((module, port): (usize, usize)) -> Port {
    Port { module, port }
}

fn connection(joint: &Joint<'_>) -> Connection {
    let [a, b] = joint.ends.map(port);
    Connection::new(a, b)
}

/// Every dock is joined to at most one other, of another module.
fn check_docks(world: &World<'_>, joints: &[Joint<'_>], findings: &mut Findings) {
    let mut taken = HashMap::new();
    for (index, joint) in joints.iter().enumerate() {
        if joint.ends[0].0 == joint.ends[1].0 {
            let message = format!("joins module {} with itself", world.modules[joint.ends[0].0].id);
            joint.mark.report(findings, codes::SELF_CONNECTION, message, "a joint joins docks of two modules");
            continue;
        }
        for end in joint.ends {
            let first = *taken.entry(end).or_insert(index);
            if first != index {
                let message = format!(
                    "a dock of module {} is joined already, by number {} of the joints",
                    world.modules[end.0].id,
                    first + 1
                );
                joint.mark.report(findings, codes::DUPLICATE_CONNECTION, message, "a dock joins one other");
                break;
            }
        }
    }
}

/// Puts the modules where the anchors and the joints say, and reports what contradicts that.
fn place(linkage: &mut Linkage, world: &World<'_>, joints: &[Joint<'_>], findings: &mut Findings) {
    let mut placed = vec![false; linkage.modules.len()];
    let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); linkage.modules.len()];
    for (index, joint) in joints.iter().enumerate() {
        for (module, _) in joint.ends {
            neighbours[module].push(index);
        }
    }
    let reach = |linkage: &mut Linkage, placed: &mut Vec<bool>, from: usize| {
        placed[from] = true;
        let mut queue = VecDeque::from([from]);
        while let Some(module) = queue.pop_front() {
            for &index in &neighbours[module] {
                let [first, second] = joints[index].ends;
                let (near, far) = if first.0 == module { (first, second) } else { (second, first) };
                if !placed[far.0] {
                    linkage.modules[far.0].pose = beyond(linkage, port(near), port(far), joints[index].quarters);
                    placed[far.0] = true;
                    queue.push_back(far.0);
                }
            }
        }
    };
    for anchor in &world.anchors {
        let pose = in_metres(&anchor.pose) * component(linkage, anchor).inverse();
        let module = &mut linkage.modules[anchor.module];
        if !placed[anchor.module] {
            module.pose = pose;
            reach(linkage, &mut placed, anchor.module);
        } else if !same(&module.pose, &pose) {
            let message =
                format!("module {} is elsewhere already, by what is said before of it or by joints", module.id);
            anchor.mark.report(
                findings,
                codes::APART,
                message,
                "one place for every group of joined modules is enough",
            );
        }
    }
    if world.anchors.is_empty() && !linkage.modules.is_empty() {
        reach(linkage, &mut placed, 0);
    }
    for (module, _) in placed.iter().enumerate().filter(|(_, placed)| !**placed) {
        let message = format!("nothing says where module {} is", world.modules[module].id);
        let hint = "join it to a module that has a place";
        world.modules[module].mark.report(findings, codes::DISCONNECTED, message, hint);
    }
    for joint in joints.iter().filter(|joint| joint.ends.iter().all(|end| placed[end.0])) {
        let [first, second] = joint.ends.map(port);
        if first.module != second.module
            && !same(&beyond(linkage, first, second, joint.quarters), &linkage.modules[second.module].pose)
        {
            let hint = "follow the joints around the loop: a position or an orientation on it is not what is meant";
            joint.mark.report(findings, codes::APART, "the two docks do not meet so", hint);
        }
    }
}

/// Pose of the module of `far`, joined to `near`.
fn beyond(linkage: &Linkage, near: Port, far: Port, quarters: u8) -> Pose {
    let frame = linkage.port_frame(near).expect("docks are at points");
    let module = &linkage.modules[far.module];
    let met = mated(&frame, f64::from(quarters) * std::f64::consts::FRAC_PI_2);
    linkage::child_pose(linkage.module_type(far.module), far.port, &module.joints, &met).expect("docks are at points")
}

/// Pose of a component in its module.
fn component(linkage: &Linkage, anchor: &Anchor<'_>) -> Pose {
    let module_type: &ModuleType = linkage.module_type(anchor.module);
    let bodies = module_type.body_poses(&linkage.modules[anchor.module].joints);
    match module_type.ports.get(anchor.component) {
        Some(port) => {
            let PortPlace::Point { frame, .. } = &port.place else { return Pose::identity() };
            bodies[port.body] * frame * rofi::port_in_dock().inverse()
        }
        None => {
            let body = anchor.component - FIRST_BODY;
            bodies[body] * if body < 2 { Pose::identity() } else { rofi::other_half() }
        }
    }
}

fn in_metres(pose: &Pose) -> Pose {
    Pose::from_parts((pose.translation.vector * rofi::CELL).into(), pose.rotation)
}

fn same(a: &Pose, b: &Pose) -> bool {
    let apart = (a.translation.vector - b.translation.vector).norm();
    apart <= SAME_PLACE * rofi::CELL && a.rotation.angle_to(&b.rotation) <= SAME_PLACE
}
