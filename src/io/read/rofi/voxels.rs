//! Voxels: an entry for every shoe, in the canonical form of the platform's planner.
//!
//! Of a module's two bodies the one whose direction to the other is positive is body A. The y axis of a body
//! looks along a positive axis, which makes the position of the shoe's joint positive where the -Z dock does so too; the x
//! axis lies along the axis after that of the direction, or the one before when the shoe is rotated. All docks that face each
//! other are joined.

use std::collections::HashMap;

use nalgebra::{Matrix3, Rotation3};

use super::super::super::findings::{Findings, Place};
use super::super::super::{codes, wire};
use super::super::decode::decode;
use super::world::{Anchor, Joints, Kind, Mark, Module, World};
use crate::spatial::{Pose, Rotation, Vec3};

/// Number of the component body A.
const BODY_A: usize = 7;

/// A shoe with its body.
struct Body<'a> {
    cell: [i32; 3],
    /// Index of the axis along which the other body lies, and whether that is ahead.
    axis: usize,
    is_positive: bool,
    is_rotated: bool,
    /// Position of the shoe's joint in degrees.
    joint: f64,
    place: Place<'a>,
}

pub(super) fn parse<'a>(place: &Place<'a>, findings: &mut Findings) -> Option<World<'a>> {
    let before = findings.count();
    let wire: wire::VoxelWorld = decode("rofi-voxels", place, findings)?;
    let list = place.key("bodies");
    let bodies: Vec<_> =
        wire.bodies.iter().enumerate().filter_map(|(i, voxel)| body(voxel, &list.index(i), findings)).collect();
    let mut cells = HashMap::new();
    for (index, body) in bodies.iter().enumerate() {
        let first = *cells.entry(body.cell).or_insert(index);
        if first != index {
            let message = format!("{} is in this cell already", bodies[first].place.path());
            let hint = "two bodies cannot be in one place".to_string();
            findings.add(&body.place.key("pos"), codes::OVERLAP, message, hint);
        }
    }
    let mut modules = Vec::new();
    let mut anchors = Vec::new();
    for body in &bodies {
        let other = cells.get(&body.other()).map(|&index| &bodies[index]);
        let Some(other) = other.filter(|other| other.other() == body.cell) else {
            let message = format!("no body at {:?} belongs to the same module", body.other());
            let hint = "the two bodies of a module lie side by side and their directions look at each other";
            findings.add(&body.place.key(body.direction_key()), codes::APART, message, hint.to_string());
            continue;
        };
        if body.is_positive {
            let mark = |place: &Place<'a>| Mark::from(place.clone());
            let gamma = 90.0 * (f64::from(u8::from(body.is_rotated)) - f64::from(u8::from(other.is_rotated)));
            let joint = |body: &Body<'a>| (body.joint, mark(&body.place.key("joint_pos")));
            let (id, module) = ((modules.len() + 1).to_string(), modules.len());
            let joints = [joint(body), joint(other), (gamma, mark(&body.place))];
            modules.push(Module { id, kind: Kind::Universal(joints), mark: mark(&body.place) });
            anchors.push(Anchor { module, component: BODY_A, pose: body.pose(), mark: mark(&body.place) });
        }
    }
    let world = World { modules, joints: Joints::Facing, anchors, whole: place.clone().into() };
    (findings.count() == before).then_some(world)
}

fn body<'a>(wire: &wire::Voxel, place: &Place<'a>, findings: &mut Findings) -> Option<Body<'a>> {
    let direction = one_of(place, [("body_dir", wire.body_dir), ("other_body_dir", wire.other_body_dir)], findings);
    let rotated =
        one_of(place, [("shoe_rotated", wire.shoe_rotated), ("is_shoe_rotated", wire.is_shoe_rotated)], findings);
    let joint = match wire.joint_pos {
        -90 | -1 => Some(-90.0),
        0 => Some(0.0),
        1 | 90 => Some(90.0),
        other => {
            let message = format!("expected -90, 0 or 90, found {other}");
            let hint = "shoes of a voxel world are at right angles, in degrees (also written -1, 0, 1)";
            findings.add(&place.key("joint_pos"), codes::OUT_OF_RANGE, message, hint.to_string());
            None
        }
    };
    let direction = direction?;
    Some(Body {
        cell: wire.pos,
        axis: direction.axis as usize,
        is_positive: direction.is_positive,
        is_rotated: rotated?,
        joint: joint?,
        place: place.clone(),
    })
}

/// The value under the one of two keys that is there.
fn one_of<T>(place: &Place<'_>, spellings: [(&str, Option<T>); 2], findings: &mut Findings) -> Option<T> {
    let [(key, value), (other_key, other)] = spellings;
    match (value, other) {
        (Some(value), None) | (None, Some(value)) => Some(value),
        (None, None) => {
            let hint = format!("also spelt `{other_key}`");
            findings.add(&place.key(key), codes::MISSING_KEY, "the key is missing", hint);
            None
        }
        (Some(_), Some(_)) => {
            let message = format!("says the same as `{key}`");
            findings.add(&place.key(other_key), codes::DUPLICATE_KEY, message, "leave one out".to_string());
            None
        }
    }
}

impl Body<'_> {
    /// The cell of the other body of its module.
    fn other(&self) -> [i32; 3] {
        let mut cell = self.cell;
        cell[self.axis] += if self.is_positive { 1 } else { -1 };
        cell
    }

    /// The spelling of its direction.
    fn direction_key(&self) -> &'static str {
        if self.place.key("body_dir").node().is_some() { "body_dir" } else { "other_body_dir" }
    }

    /// Pose of the body's frame, in cells.
    fn pose(&self) -> Pose {
        let (next, last) = ((self.axis + 1) % 3, (self.axis + 2) % 3);
        let unit = |axis: usize| Vec3::ith(axis, 1.0);
        let z = unit(self.axis) * if self.is_positive { 1.0 } else { -1.0 };
        let y = unit(if self.is_rotated { next } else { last });
        let matrix = Matrix3::from_columns(&[y.cross(&z), y, z]);
        let rotation = Rotation::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
        Pose::from_parts(Vec3::from(self.cell.map(f64::from)).into(), rotation)
    }
}
