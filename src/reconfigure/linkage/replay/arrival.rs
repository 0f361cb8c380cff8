//! Whether a state of a linkage is the goal: by where masses, ports and connections are, whatever
//! the modules and their parts are called.

use std::f64::consts::FRAC_PI_2;

use crate::robot::linkage::{Goal, Linkage, Port};
use crate::robot::{ModuleType, PortPlace};
use crate::spatial::{Point, Pose, Rotation, Vec3};
use crate::statics::{Connector, Model};

use super::Fault;

/// Distance relative to the size of a module up to which two things are at one place: decimal input, and
/// what integers in micro-degrees leave over a robot of a hundred modules.
const SAME_PLACE: f64 = 1e-3;

/// Sine of the angle up to which two directions are one, likewise.
const SAME_DIRECTION: f64 = 1e-3;

/// Something that a module has in space.
#[derive(Clone, Copy, Debug)]
struct Mark {
    /// A body's mass in kg, or which connector a port has; of a surface none.
    what: What,
    position: Vec3,
    /// z and x of a port.
    axes: Option<[Vec3; 2]>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum What {
    Mass(f64),
    /// A port's connector, and whether it is unchanged by a quarter turn rather than by half a turn.
    Port(Option<usize>, bool),
}

/// What a state lacks to be the goal; `None` if it is.
pub(super) fn missing(start: &Linkage, end: &Linkage, goal: &Goal) -> Option<Fault> {
    let mut placed = false;
    for displacement in displacements(end, goal) {
        if !modules_match(start, end, goal, &displacement) {
            continue;
        }
        placed = true;
        if connections_match(end, goal, &displacement) {
            return None;
        }
    }
    Some(if placed { Fault::ConnectionsDiffer } else { Fault::PlacementsDiffer })
}

/// The displacements of the goal that are worth a try: none, or those that lay a port of its first
/// module that has one on a port of a module of the state.
fn displacements(end: &Linkage, goal: &Goal) -> Vec<Pose> {
    if !goal.matching.free_frame {
        return vec![Pose::identity()];
    }
    let wanted = &goal.linkage;
    let first_frame = |linkage: &Linkage, module: usize| {
        let ports = 0..linkage.module_type(module).ports.len();
        ports.filter_map(|port| linkage.port_frame(Port { module, port })).collect::<Vec<_>>()
    };
    let reference = (0..wanted.modules.len()).find_map(|m| Some((m, *first_frame(wanted, m).first()?)));
    let Some((module, from)) = reference else {
        let by = end.modules[0].pose.translation.vector - wanted.modules[0].pose.translation.vector;
        return vec![Pose::translation(by.x, by.y, by.z)];
    };
    let kind = wanted.modules[module].module_type;
    let candidates = (0..end.modules.len()).filter(|&m| end.modules[m].module_type == kind);
    let frames = candidates.flat_map(|m| first_frame(end, m));
    let turned = frames.flat_map(|frame| {
        (0..4).map(move |quarters| frame * Rotation::from_axis_angle(&Vec3::z_axis(), f64::from(quarters) * FRAC_PI_2))
    });
    turned.map(|frame| frame * from.inverse()).filter(|displacement| is_allowed(end, displacement)).collect()
}

/// Whether a displacement leaves the world as it is: any in an empty one, over the ground in another.
fn is_allowed(world: &Linkage, displacement: &Pose) -> bool {
    let environment = &world.environment;
    let is_empty = environment.ground.is_none() && environment.obstacles.is_empty();
    if is_empty && world.gravity == Vec3::zeros() {
        return true;
    }
    let up = displacement.rotation * Vec3::z();
    let size = (0..world.modules.len()).map(|m| world.module_type(m).size()).fold(0.0, f64::max);
    up.z > 0.0
        && up.x.hypot(up.y) <= SAME_DIRECTION
        && displacement.translation.vector.z.abs() <= SAME_PLACE * size * world.modules.len() as f64
}

/// Whether every module of the displaced goal lies on one of the state's of its kind.
fn modules_match(start: &Linkage, end: &Linkage, goal: &Goal, displacement: &Pose) -> bool {
    let wanted = &goal.linkage;
    let is_loaded = |module: usize| start.loads.iter().any(|load| load.module == module);
    let mut free: Vec<usize> = (0..end.modules.len()).collect();
    (0..wanted.modules.len()).all(|module| {
        let there = &wanted.modules[module];
        let marks = marks(wanted, module, displacement);
        let size = wanted.module_type(module).size();
        let fits = |&candidate: &usize| {
            let here = &end.modules[candidate];
            let labelled = goal.matching.labelled || is_loaded(candidate);
            here.module_type == there.module_type
                && (!labelled || here.id == there.id)
                && coincide(&self::marks(end, candidate, &Pose::identity()), &marks, SAME_PLACE * size)
        };
        match free.iter().position(fits) {
            Some(found) => {
                free.swap_remove(found);
                true
            }
            None => false,
        }
    }) && free.is_empty()
}

/// Whether every engaged connection of the displaced goal is where one of the state's is.
fn connections_match(end: &Linkage, goal: &Goal, displacement: &Pose) -> bool {
    let places = |linkage: &Linkage, by: &Pose| -> Vec<Vec3> {
        let engaged = linkage.connections.iter().filter_map(|connection| linkage.engagement(connection));
        engaged.map(|engagement| (by * engagement.frame).translation.vector).collect()
    };
    let size = (0..end.modules.len()).map(|m| end.module_type(m).size()).fold(0.0, f64::max);
    let mut here = places(end, &Pose::identity());
    let there = places(&goal.linkage, displacement);
    there.len() == here.len()
        && there.iter().all(|place| {
            let found = here.iter().position(|other| (other - place).norm() <= SAME_PLACE * size);
            found.map(|found| here.swap_remove(found)).is_some()
        })
}

/// What a module has in space, displaced.
fn marks(linkage: &Linkage, module: usize, displacement: &Pose) -> Vec<Mark> {
    let module_type = linkage.module_type(module);
    let poses: Vec<Pose> = linkage.body_poses(module).into_iter().map(|pose| displacement * pose).collect();
    let masses = module_type.bodies.iter().zip(&poses).map(|(body, pose)| Mark {
        what: What::Mass(body.mass),
        position: (pose * Point::from(body.com)).coords,
        axes: None,
    });
    let ports = (0..module_type.ports.len()).map(|port| port_mark(linkage, module_type, port, &poses));
    masses.chain(ports).collect()
}

fn port_mark(linkage: &Linkage, module_type: &ModuleType, port: usize, poses: &[Pose]) -> Mark {
    let kind = &module_type.ports[port];
    let quartered = kind.connector.is_none_or(|c| is_quartered(&linkage.catalogue.connectors[c]));
    let what = What::Port(kind.connector, quartered);
    let body = poses[kind.body];
    match &kind.place {
        PortPlace::Point { frame, .. } => {
            let frame = body * frame;
            let axes = Some([frame.rotation * Vec3::z(), frame.rotation * Vec3::x()]);
            Mark { what, position: frame.translation.vector, axes }
        }
        PortPlace::Surface => {
            let centre = body * module_type.bodies[kind.body].shape_pose;
            Mark { what, position: centre.translation.vector, axes: None }
        }
    }
}

/// Whether a connector is unchanged by a quarter turn about its z axis; every connector is by half a turn
/// but for a patch, which counts as unchanged by neither.
fn is_quartered(connector: &Connector) -> bool {
    match &connector.model {
        Model::Cone { friction, radius } => friction[0] == friction[1] && radius[0] == radius[1],
        Model::Box { shear, bending, .. } => shear[0] == shear[1] && bending[0] == bending[1],
        Model::Patch { .. } => false,
    }
}

/// Whether each mark of one module lies on a mark of the other.
fn coincide(here: &[Mark], there: &[Mark], tolerance: f64) -> bool {
    let mut free: Vec<&Mark> = here.iter().collect();
    there.iter().all(|mark| {
        let found = free.iter().position(|other| is_same(mark, other, tolerance));
        found.map(|found| free.swap_remove(found)).is_some()
    })
}

fn is_same(a: &Mark, b: &Mark, tolerance: f64) -> bool {
    let directed = match (a.axes, b.axes) {
        (None, None) => true,
        (Some([za, xa]), Some([zb, xb])) => {
            let parallel = |u: Vec3, v: Vec3| u.cross(&v).norm() <= SAME_DIRECTION;
            let crosswise = matches!(a.what, What::Port(_, true)) && xa.dot(&xb).abs() <= SAME_DIRECTION;
            parallel(za, zb) && za.dot(&zb) > 0.0 && (parallel(xa, xb) || crosswise)
        }
        _ => false,
    };
    a.what == b.what && directed && (a.position - b.position).norm() <= tolerance
}
