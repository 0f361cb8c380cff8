//! JSON worlds: modules, the joints between their docks, and where components are.

use std::collections::HashMap;

use nalgebra::{Matrix3, Rotation3};

use super::super::super::findings::{Findings, Place};
use super::super::super::json::clipped;
use super::super::super::rofi::{COMPONENTS, DOCKS, ORIENTATIONS, QUARTERS};
use super::super::super::{codes, suggest, wire};
use super::super::decode::decode;
use super::world::{Anchor, Joint, Joints, Kind, Mark, Module, World};
use crate::spatial::{Pose, Rotation, Vec3};

/// Largest error of a rotation matrix's products that passes as the rounding of decimal input.
const ORTHONORMAL: f64 = 1e-5;

pub(super) fn parse<'a>(place: &Place<'a>, findings: &mut Findings) -> Option<World<'a>> {
    let before = findings.count();
    let wire: wire::RofiWorld = decode("rofi-world", place, findings)?;
    let mut numbers = HashMap::new();
    let mut modules = Vec::new();
    for (index, wire) in wire.modules.iter().enumerate() {
        let place = place.key("modules").index(index);
        let (id, kind) = match wire {
            wire::RofiModule::Universal { id, alpha, beta, gamma, .. } => {
                let joints = [("alpha", alpha), ("beta", beta), ("gamma", gamma)];
                (*id, Kind::Universal(joints.map(|(key, degrees)| (degrees.0, place.key(key).into()))))
            }
            wire::RofiModule::Pad { id, width, height, .. } => (*id, Kind::Pad([*width, *height])),
        };
        let first = *numbers.entry(id).or_insert(index);
        if first != index {
            let message = format!("the id `{id}` is taken already, by number {} of the modules", first + 1);
            findings.add(&place.key("id"), codes::DUPLICATE_ID, message, "ids are unique".to_string());
        }
        modules.push(Module { id: id.to_string(), kind, mark: place.into() });
    }
    let scope = Scope { modules: &modules, numbers: &numbers };
    let joints = wire.module_joints.iter().enumerate();
    let joints = joints.filter_map(|(i, wire)| scope.joint(wire, &place.key("moduleJoints").index(i), findings));
    let joints = Joints::Listed(joints.collect());
    let anchors = wire.space_joints.iter().enumerate();
    let anchors = anchors.filter_map(|(i, wire)| scope.anchor(wire, &place.key("spaceJoints").index(i), findings));
    let anchors = anchors.collect();
    (findings.count() == before).then_some(World { modules, joints, anchors, whole: Mark::from(place.clone()) })
}

/// The modules that joints refer to.
struct Scope<'s, 'a> {
    modules: &'s [Module<'a>],
    numbers: &'s HashMap<i64, usize>,
}

impl Scope<'_, '_> {
    fn joint<'a>(&self, wire: &wire::ModuleJoint, place: &Place<'a>, findings: &mut Findings) -> Option<Joint<'a>> {
        let from = self.dock(&wire.from, &place.key("from"), findings);
        let to = self.dock(&wire.to, &place.key("to"), findings);
        let orientation = orientation(&wire.orientation, &place.key("orientation"), findings)?;
        Some(Joint { ends: [from?, to?], quarters: QUARTERS[orientation], mark: place.clone().into() })
    }

    fn dock(&self, wire: &wire::DockOf, place: &Place<'_>, findings: &mut Findings) -> Option<(usize, usize)> {
        let module = self.module(wire.id, &place.key("id"), findings)?;
        let count = self.modules[module].kind.docks();
        Some((module, self.part(module, &wire.connector, count, &place.key("connector"), findings)?))
    }

    fn anchor<'a>(&self, wire: &wire::SpaceJoint, place: &Place<'a>, findings: &mut Findings) -> Option<Anchor<'a>> {
        let to = place.key("to");
        let module = self.module(wire.to.id, &to.key("id"), findings);
        let component = module.and_then(|module| {
            let count = match &self.modules[module].kind {
                Kind::Universal(_) => COMPONENTS,
                pad @ Kind::Pad(_) => pad.docks(),
            };
            self.part(module, &wire.to.component, count, &to.key("component"), findings)
        });
        let matrix = place.key("joint").key("sourceToDestination");
        let pose = transform(&wire.joint.source_to_destination, &matrix, findings)?;
        let point = Vec3::from(wire.point.map(|x| x.0));
        let pose = Pose::translation(point.x, point.y, point.z) * pose;
        Some(Anchor { module: module?, component: component?, pose, mark: place.clone().into() })
    }

    fn module(&self, id: i64, place: &Place<'_>, findings: &mut Findings) -> Option<usize> {
        let found = self.numbers.get(&id).copied();
        if found.is_none() {
            let ids: Vec<_> = self.modules.iter().map(|module| module.id.as_str()).collect();
            let hint = suggest::hint(&id.to_string(), "modules", ids);
            findings.add(place, codes::UNKNOWN_NAME, format!("there is no module {id}"), hint);
        }
        found
    }

    /// A dock or another component of a module, by name or number.
    fn part(
        &self,
        module: usize,
        part: &wire::NameOrNumber,
        count: usize,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<usize> {
        let is_universal = matches!(self.modules[module].kind, Kind::Universal(_));
        let (found, shown) = match part {
            wire::NameOrNumber::Number(number) => (Some(*number as usize).filter(|n| *n < count), number.to_string()),
            wire::NameOrNumber::Name(name) => {
                (DOCKS.iter().position(|dock| is_universal && dock == name), format!("\"{}\"", clipped(name)))
            }
        };
        if found.is_none() {
            let id = &self.modules[module].id;
            let docks = if is_universal { format!("{}, or ", suggest::listed(&DOCKS)) } else { String::new() };
            let hint = format!("{docks}a number from 0 to {}", count.saturating_sub(1));
            findings.add(place, codes::UNKNOWN_VALUE, format!("module {id} has no {shown}"), hint);
        }
        found
    }
}

/// The number of an orientation.
fn orientation(wire: &wire::NameOrNumber, place: &Place<'_>, findings: &mut Findings) -> Option<usize> {
    let (found, shown) = match wire {
        wire::NameOrNumber::Number(number) => (Some(*number as usize).filter(|n| *n < 4), number.to_string()),
        wire::NameOrNumber::Name(name) => {
            let is_it = |known: &&str| *known == name || known.get(..1) == Some(name);
            (ORIENTATIONS.iter().position(is_it), format!("\"{}\"", clipped(name)))
        }
    };
    if found.is_none() {
        let hint = format!("one of {}, or its number from 0 to 3", suggest::listed(&ORIENTATIONS));
        findings.add(place, codes::UNKNOWN_VALUE, format!("expected an orientation, found {shown}"), hint);
    }
    found
}

fn transform(wire: &wire::Transform, place: &Place<'_>, findings: &mut Findings) -> Option<Pose> {
    let rows = match wire {
        wire::Transform::Identity(_) => return Some(Pose::identity()),
        wire::Transform::Matrix(rows) => rows.map(|row| row.map(|x| x.0)),
    };
    let matrix = Matrix3::from_fn(|i, j| rows[i][j]);
    let product = matrix * matrix.transpose() - Matrix3::identity();
    let is_rigid = product.amax() <= ORTHONORMAL && matrix.determinant() > 0.0 && rows[3] == [0.0, 0.0, 0.0, 1.0];
    if !is_rigid {
        let hint = "the upper left 3 x 3 is a rotation, the last row 0, 0, 0, 1; or write \"identity\"";
        findings.add(place, codes::NOT_UNIT, "the matrix is no rigid transform", hint.to_string());
        return None;
    }
    let rotation = Rotation::from_rotation_matrix(&Rotation3::from_matrix_unchecked(matrix));
    Some(Pose::from_parts(Vec3::new(rows[0][3], rows[1][3], rows[2][3]).into(), rotation))
}
