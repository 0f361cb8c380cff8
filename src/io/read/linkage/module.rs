//! A module with its joints, and its pose if it says one.

use nalgebra::Translation3;

use super::super::super::findings::{Findings, Place};
use super::super::super::json::clipped;
use super::super::super::{codes, wire};
use super::super::angle::steps;
use super::super::module_type::refuse;
use super::super::names::Names;
use super::super::rotation::{orientation, rotation, vector};
use crate::robot::linkage::Module;
use crate::robot::{Catalogue, ModuleType, Orientation, Placement};
use crate::spatial::{Pose, Rotation};

/// The module at `place`, and whether it has a pose of its own; without one it is at the origin.
pub(super) fn module(
    wire: &wire::Module,
    types: &Names<'_>,
    catalogue: &Catalogue,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<(Module, bool)> {
    let module_type = types.find(&wire.module_type, &place.key("type"), findings)?;
    let kind = &catalogue.module_types[module_type];
    let joints = joints(wire, kind, place, findings);
    let pose = pose(wire, kind, place, findings);
    let (placed, pose) = (pose.is_some(), pose.unwrap_or_default());
    Some((Module { id: wire.id.clone(), module_type, pose, joints: joints?, fixed: wire.fixed }, placed))
}

fn pose(wire: &wire::Module, kind: &ModuleType, place: &Place<'_>, findings: &mut Findings) -> Option<Pose> {
    let turn_at = place.key("rotation_xyzw");
    let Some(cell) = wire.cell else {
        let turned = wire.rotation_xyzw.map(|xyzw| rotation(xyzw, &turn_at, findings));
        let Some(position) = wire.position_m else {
            if turned.is_some() {
                let hint = "give the `position_m` that goes with the rotation, or leave both to a connection";
                findings.add(&place.key("position_m"), codes::MISSING_KEY, "the key is missing", hint.to_string());
            }
            return None;
        };
        let position = Translation3::from(vector(position));
        return Some(Pose::from_parts(position, turned.unwrap_or_else(Rotation::identity)));
    };
    if wire.position_m.is_some() {
        let hint = "give either the cell or the position";
        refuse(&place.key("position_m"), "its cell places it already", hint, findings);
    }
    let Some(lattice) = &kind.lattice else {
        let message = format!("a module of type `{}` is in no lattice", clipped(&kind.name));
        refuse(&place.key("cell"), &message, "give its `position_m`, and `rotation_xyzw` if it is turned", findings);
        return None;
    };
    let orientation = wire.rotation_xyzw.map_or(Orientation::IDENTITY, |xyzw| orientation(xyzw, &turn_at, findings));
    Some(Placement { cell, orientation }.pose(lattice.pitch))
}

/// Positions of all joints in steps; 0 where the file says nothing.
fn joints(wire: &wire::Module, kind: &ModuleType, place: &Place<'_>, findings: &mut Findings) -> Option<Vec<i32>> {
    let place = place.key("joints_deg");
    let names = kind.joints.iter().map(|joint| joint.name.as_str()).collect();
    let names = Names::new("joints", names, |_| place.clone(), findings);
    let mut positions = vec![0; kind.joints.len()];
    let mut sound = true;
    for (name, degrees) in wire.joints_deg.iter().flatten() {
        let place = place.key(name);
        let Some(index) = names.find(name, &place, findings) else {
            sound = false;
            continue;
        };
        let joint = &kind.joints[index];
        let (step, degrees) = (joint.step_degrees, degrees.0);
        match steps(degrees, step) {
            Some(position) if joint.allows(position) => positions[index] = position,
            Some(_) => {
                let [low, high] = joint.range.unwrap_or_default().map(|end| f64::from(end) * step);
                let message = format!("beyond the joint's range, found {degrees}");
                let hint = format!("it turns from {low} to {high} degrees");
                findings.add(&place, codes::OUT_OF_RANGE, message, hint);
                sound = false;
            }
            None => {
                let message = format!("{degrees} degrees are no whole number of steps of {step}");
                let hint = format!("the nearest step is at {} degrees", (degrees / step).round() * step);
                findings.add(&place, codes::OUT_OF_RANGE, message, hint);
                sound = false;
            }
        }
    }
    sound.then_some(positions)
}
