//! Motions of lattice modules, and which of them a module type makes.

use super::super::findings::{Findings, Place};
use super::super::{codes, wire};
use super::lattice_plan::{face, turn};
use super::module_type::refuse;
use super::names::Names;
use crate::robot::{BUILT_IN_MOTIONS, Face, Motion, MotionType, Stencil};

/// Motions of modules outside lattices.
pub(super) const OUTSIDE_LATTICES: [&str; 2] = ["roll", "rotate"];

/// The motions of a catalogue, which stand at `place`: after the built-in ones, if it has modules that could make them.
pub(super) fn motions(wire: &wire::Catalogue, place: &Place<'_>, findings: &mut Findings) -> Option<Vec<MotionType>> {
    let is_of_lattice = |wire: &wire::ModuleType| matches!(wire.ports, wire::Ports::Faces(_));
    let mut motions = Vec::new();
    if !wire.motions.is_empty() || wire.module_types.values().any(is_of_lattice) {
        motions.extend(BUILT_IN_MOTIONS.map(MotionType::built_in));
    }
    for (index, (name, stencils)) in wire.motions.iter().enumerate() {
        let place = place.entry(index);
        if BUILT_IN_MOTIONS.contains(&name.as_str()) || OUTSIDE_LATTICES.contains(&name.as_str()) {
            let message = format!("`{name}` is a built-in motion");
            findings.add(&place, codes::DUPLICATE_ID, message, "give yours a name of its own".to_string());
        }
        if name.is_empty() {
            findings.add(&place, codes::BAD_ID, "a motion needs a name", "e.g. \"leap\"".to_string());
        }
        let read = |(i, wire): (usize, &wire::Stencil)| stencil(wire, &place.index(i), findings);
        let stencils: Vec<_> = stencils.iter().enumerate().map(read).collect();
        motions.push(
            stencils.into_iter().collect::<Option<_>>().map(|stencils| MotionType { name: name.clone(), stencils }),
        );
    }
    motions.into_iter().collect()
}

fn stencil(wire: &wire::Stencil, place: &Place<'_>, findings: &mut Findings) -> Option<Stencil> {
    let motion = match &wire.about {
        None => Motion::Translation { by: wire.to },
        Some(about) => {
            let motion = rotation(about, &place.key("about"), findings)?;
            if motion.by() != wire.to {
                let message = format!("the turn leads to cell {:?}", motion.by());
                let hint = "`to` is counted from the module's own cell; it turns over the edge towards `about.towards`";
                findings.add(&place.key("to"), codes::MIXED, message, hint.to_string());
                return None;
            }
            motion
        }
    };
    Some(Stencil { motion, occupied: wire.occupied.clone(), free: wire.free.clone(), mirrored: wire.mirrored })
}

fn rotation(wire: &wire::Edge, place: &Place<'_>, findings: &mut Findings) -> Option<Motion> {
    let support = Face::from_step(wire.support);
    if support.is_none() {
        let message = format!("{:?} is not a neighbouring cell", wire.support);
        let hint = "one coordinate is 1 or -1, the others are 0: the module stands face to face with its support";
        findings.add(&place.key("support"), codes::OUT_OF_RANGE, message, hint.to_string());
    }
    let towards = face(wire.towards);
    if support.is_some_and(|support| support.axis() == towards.axis()) {
        let message = "the faces towards the support and in this direction share no edge";
        let hint = "the edge lies between two faces that are perpendicular to each other";
        findings.add(&place.key("towards"), codes::MIXED, message, hint.to_string());
        return None;
    }
    let turn = turn(wire.angle_deg, "the direction is in `towards`", &place.key("angle_deg"), findings);
    Some(Motion::Rotation { support: support?, towards, turn: turn? })
}

/// What the lattice module type at `place` is capable of, of the catalogue's motions.
pub(super) fn of_lattice_type(
    wire: &wire::ModuleType,
    motions: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<Vec<usize>> {
    let mut found: Vec<Option<usize>> = Vec::with_capacity(wire.motions.len());
    for (index, name) in wire.motions.iter().enumerate() {
        let place = place.key("motions").index(index);
        if OUTSIDE_LATTICES.contains(&name.as_str()) {
            let hint = "a lattice module can \"slide\" and \"pivot\", and what the catalogue's `motions` say";
            refuse(&place, "not a motion of lattice modules", hint, findings);
        } else {
            found.push(motions.find(name, &place, findings));
        }
    }
    let mut found: Vec<usize> = found.into_iter().collect::<Option<_>>()?;
    found.sort_unstable();
    found.dedup();
    Some(found)
}
