//! A robot of RoFI modules to the platform's files.
//!
//! What such a file cannot express is a reason not to write it, never dropped in silence: only where the robot as a whole is,
//! which means nothing without surroundings, is lost in text.

use super::super::rofi::{self as words, QUARTERS};
use super::super::wire;
use crate::robot::linkage::{Code, Connection, Linkage, Port};
use crate::robot::{Requirement, rofi};
use crate::spatial::{Pose, Rotation, Vec3};

/// Distance in cells and sine of the angle up to which a pose is in the lattice.
const IN_LATTICE: f64 = 1e-5;

/// Numbers below this are the rounding of a zero in a matrix or a position.
const ROUNDING: f64 = 1e-12;

/// Why a robot cannot be written, one sentence each.
pub(super) type Reasons = Vec<String>;

/// What no format of the platform can express.
fn surroundings(linkage: &Linkage) -> Reasons {
    let environment = &linkage.environment;
    let said = [
        (linkage.gravity != Vec3::zeros(), "gravity"),
        (environment.ground.is_some(), "the ground"),
        (!environment.obstacles.is_empty(), "obstacles"),
        (!linkage.loads.is_empty(), "loads"),
        (linkage.require != Requirement::default(), "what transient states must satisfy"),
    ];
    said.into_iter()
        .filter(|(there, _)| *there)
        .map(|(_, what)| format!("the format has no place for {what}"))
        .collect()
}

/// What a module is, in the platform's terms.
enum Kind {
    /// With its joints alpha, beta and gamma in degrees, gamma from -180 below 180.
    Universal([f64; 3]),
    Pad([u32; 2]),
}

/// The modules, or which of them are none of the platform's.
fn kinds(linkage: &Linkage) -> Result<Vec<Kind>, Reasons> {
    let (mut kinds, mut reasons) = (Vec::new(), Vec::new());
    for (index, module) in linkage.modules.iter().enumerate() {
        match kind(linkage, index) {
            Some(Kind::Universal(_)) if module.fixed => {
                reasons.push(format!("the format has no place for a fixed module, and `{}` is fixed", module.id));
            }
            Some(Kind::Pad(_)) if !module.fixed => {
                reasons.push(format!("a pad is fixed in these formats, and `{}` is not", module.id));
            }
            Some(kind) => kinds.push(kind),
            None => {
                let name = &linkage.module_type(index).name;
                reasons.push(format!("the module `{}` is a `{name}`, not one of the RoFI platform", module.id));
            }
        }
    }
    if reasons.is_empty() { Ok(kinds) } else { Err(reasons) }
}

/// What a module is: its type must be as the built-in catalogue has it, whatever its step.
fn kind(linkage: &Linkage, module: usize) -> Option<Kind> {
    let found = linkage.module_type(module);
    if let Some(size) = found.name.strip_prefix("pad-") {
        let (width, height) = size.split_once('x')?;
        let size = [width.parse().ok()?, height.parse().ok()?];
        let docks = |[width, height]: [u32; 2]| width as usize * height as usize;
        let is_pad = size.iter().all(|side| (1..=1000).contains(side)) && docks(size) == found.ports.len();
        return is_pad.then_some(Kind::Pad(size));
    }
    let names = found.ports.iter().map(|port| port.name.as_str());
    let is_universal = found.name == "universal" && found.joints.len() == 3 && names.eq(words::DOCKS);
    is_universal.then(|| {
        let steps = &linkage.modules[module].joints;
        let degrees: Vec<_> =
            steps.iter().zip(&found.joints).map(|(&p, joint)| f64::from(p) * joint.step_degrees).collect();
        let gamma = degrees[2].rem_euclid(360.0);
        Kind::Universal([degrees[0], degrees[1], if gamma < 180.0 { gamma } else { gamma - 360.0 }])
    })
}

/// The modules' numbers: their ids where all of them are numbers, or else counted from 1.
fn numbers(linkage: &Linkage) -> Vec<i64> {
    let own = |id: &str| id.parse().ok().filter(|number: &i64| number.to_string() == id);
    let ids: Option<Vec<_>> = linkage.modules.iter().map(|module| own(&module.id)).collect();
    ids.unwrap_or_else(|| (1..=linkage.modules.len() as i64).collect())
}

/// The number of the orientation of a connection.
fn orientation(linkage: &Linkage, connection: &Connection) -> usize {
    match linkage.code(connection) {
        Code::Docked { roll } => usize::from(QUARTERS[roll.rem_euclid(4) as usize]),
        Code::OnSurface(_) => 0, // docks are at points
    }
}

/// A number without what is rounding.
fn clean(x: f64) -> f64 {
    let whole = x.round();
    if (x - whole).abs() <= ROUNDING { whole + 0.0 } else { x }
}

/// As a JSON world. Of every group of joined modules the first one's shoe A, or its dock 0 for a pad, says where it is.
pub(super) fn world(linkage: &Linkage) -> Result<wire::RofiWorld, Reasons> {
    let mut reasons = surroundings(linkage);
    let kinds = kinds(linkage).unwrap_or_else(|more| {
        reasons.extend(more);
        Vec::new()
    });
    if !reasons.is_empty() {
        return Err(reasons);
    }
    let numbers = numbers(linkage);
    let modules = kinds.iter().zip(&numbers).map(|(kind, &id)| match kind {
        Kind::Universal([alpha, beta, gamma]) => {
            let [alpha, beta, gamma] = [*alpha, *beta, *gamma].map(wire::Real);
            wire::RofiModule::Universal { id, alpha, beta, gamma, attributes: None }
        }
        Kind::Pad([width, height]) => wire::RofiModule::Pad { id, width: *width, height: *height, attributes: None },
    });
    let dock = |port: Port| wire::DockOf {
        id: numbers[port.module],
        connector: match kinds[port.module] {
            Kind::Universal(_) => wire::NameOrNumber::Name(words::DOCKS[port.port].into()),
            Kind::Pad(_) => wire::NameOrNumber::Number(port.port as u32),
        },
    };
    let joints = linkage.connections.iter().map(|connection| wire::ModuleJoint {
        from: dock(connection.ports[0]),
        to: dock(connection.ports[1]),
        orientation: wire::NameOrNumber::Name(words::ORIENTATIONS[orientation(linkage, connection)].into()),
        attributes: None,
    });
    let components = linkage.components();
    let first = (0..linkage.modules.len()).filter(|&module| components[module] == module);
    let spaces = first.map(|module| {
        let pose = linkage.modules[module].pose;
        let matrix = pose.rotation.to_rotation_matrix();
        let row = |i: usize| [0, 1, 2, 3].map(|j| wire::Real(if j < 3 { clean(matrix[(i, j)]) } else { 0.0 }));
        let is_identity = pose.rotation.angle() <= ROUNDING;
        let last = [0.0, 0.0, 0.0, 1.0].map(wire::Real);
        let component = match kinds[module] {
            Kind::Universal(_) => SHOE_A,
            Kind::Pad(_) => 0,
        };
        wire::SpaceJoint {
            point: [0, 1, 2].map(|i| wire::Real(clean(pose.translation.vector[i] / rofi::CELL))),
            joint: wire::PlacingJoint {
                kind: wire::PlacingKind::Rigid,
                source_to_destination: match is_identity {
                    true => wire::Transform::Identity(wire::IdentityTransform::Identity),
                    false => wire::Transform::Matrix([row(0), row(1), row(2), last]),
                },
                positions: Vec::new(),
            },
            to: wire::ComponentOf { id: numbers[module], component: wire::NameOrNumber::Number(component) },
            attributes: None,
        }
    });
    Ok(wire::RofiWorld { modules: modules.collect(), module_joints: joints.collect(), space_joints: spaces.collect() })
}

/// Number of the component shoe A.
const SHOE_A: u32 = 6;

/// As text.
pub(super) fn text(linkage: &Linkage) -> Result<String, Reasons> {
    let (mut reasons, kinds) = universal_only(linkage);
    if !linkage.is_connected() {
        reasons.push("text says where modules are by their joints only, and these do not join all modules".into());
    }
    if !reasons.is_empty() {
        return Err(reasons);
    }
    let numbers = numbers(linkage);
    let mut out = "C\n".to_string();
    for ([alpha, beta, gamma], number) in kinds.iter().zip(&numbers) {
        out.push_str(&format!("M {number} {alpha} {beta} {gamma}\n"));
    }
    for connection in &linkage.connections {
        let [a, b] = connection.ports;
        let per_side = words::text::DOCKS.len();
        let side = |port: Port| words::text::SIDES[port.port / per_side];
        let dock = |port: Port| words::text::DOCKS[port.port % per_side];
        let orientation = words::text::ORIENTATIONS[orientation(linkage, connection)];
        let (from, to) = (numbers[a.module], numbers[b.module]);
        out.push_str(&format!("E {from} {} {} {orientation} {} {} {to}\n", side(a), dock(a), dock(b), side(b)));
    }
    Ok(out)
}

/// The joints of universal modules, and what stands against writing these where only such can be.
fn universal_only(linkage: &Linkage) -> (Reasons, Vec<[f64; 3]>) {
    let mut reasons = surroundings(linkage);
    let mut universal = Vec::new();
    match kinds(linkage) {
        Ok(kinds) => {
            for (kind, module) in kinds.into_iter().zip(&linkage.modules) {
                match kind {
                    Kind::Universal(joints) => universal.push(joints),
                    Kind::Pad(_) => reasons.push(format!("the format has no place for the pad `{}`", module.id)),
                }
            }
        }
        Err(more) => reasons.extend(more),
    }
    (reasons, universal)
}

/// As voxels, moved so that the smallest coordinates are 0.
pub(super) fn voxels(linkage: &Linkage) -> Result<wire::VoxelWorld, Reasons> {
    let (mut reasons, kinds) = universal_only(linkage);
    if !reasons.is_empty() {
        return Err(reasons);
    }
    let origin = linkage.modules[0].pose;
    let mut bodies = Vec::new();
    for (index, module) in linkage.modules.iter().enumerate() {
        let poses = linkage.body_poses(index);
        // Relative to the first module, so that a robot as a whole may be anywhere.
        let halves = [poses[1], poses[2] * rofi::other_half()].map(|pose| origin.inverse() * pose);
        for (pose, degrees) in halves.iter().zip(&kinds[index]) {
            match voxel(pose, *degrees) {
                Some(voxel) => bodies.push(voxel),
                None => {
                    let id = &module.id;
                    reasons.push(format!("voxels are at right angles and in cells, and `{id}` is not"));
                    break;
                }
            }
        }
    }
    let open =
        linkage.touching().into_iter().filter(|connection| linkage.connections.binary_search(connection).is_err());
    reasons.extend(open.map(|connection| {
        let port = |port: Port| {
            format!("{}:{}", linkage.modules[port.module].id, linkage.module_type(port.module).ports[port.port].name)
        };
        let [a, b] = connection.ports.map(port);
        format!("voxels join all docks that face each other, and {a} and {b} are not joined")
    }));
    if !reasons.is_empty() {
        return Err(reasons);
    }
    let least = [0, 1, 2].map(|i| bodies.iter().map(|body: &wire::Voxel| body.pos[i]).min().unwrap_or(0));
    for body in &mut bodies {
        body.pos = [0, 1, 2].map(|i| body.pos[i] - least[i]);
    }
    bodies.sort_by_key(|body| body.pos);
    Ok(wire::VoxelWorld { bodies })
}

/// A body with the position of its shoe's joint; `None` outside the lattice.
fn voxel(pose: &Pose, degrees: f64) -> Option<wire::Voxel> {
    let cell = pose.translation.vector / rofi::CELL;
    let pos = cell.map(f64::round);
    if !((cell - pos).norm() <= IN_LATTICE) {
        return None;
    }
    let (z, is_positive) = along(&pose.rotation, Vec3::z())?;
    let (x, _) = along(&pose.rotation, Vec3::x())?;
    let (_, is_y_positive) = along(&pose.rotation, Vec3::y())?;
    let joint = if is_y_positive { degrees } else { -degrees };
    let joint_pos = [-90, 0, 90].into_iter().find(|angle| (f64::from(*angle) - joint).abs() <= IN_LATTICE)?;
    let axis = [wire::CoordinateAxis::X, wire::CoordinateAxis::Y, wire::CoordinateAxis::Z][z];
    Some(wire::Voxel {
        pos: [0, 1, 2].map(|i| pos[i] as i32),
        body_dir: Some(wire::Direction { axis, is_positive }),
        other_body_dir: None,
        shoe_rotated: Some((z + 1) % 3 != x),
        is_shoe_rotated: None,
        joint_pos,
    })
}

/// The axis along which a turned axis lies, and whether it looks along it.
fn along(rotation: &Rotation, axis: Vec3) -> Option<(usize, bool)> {
    let turned = rotation * axis;
    let index = turned.iamax();
    (turned[index].abs() >= 1.0 - IN_LATTICE * IN_LATTICE).then_some((index, turned[index] > 0.0))
}
