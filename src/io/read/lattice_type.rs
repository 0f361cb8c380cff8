//! Module types that sit in a lattice: ports `faces`.

use super::super::findings::{Findings, Place};
use super::super::{codes, wire};
use super::module_type::{body, refuse};
use super::motion::of_lattice_type;
use super::names::Names;
use crate::robot::{BodyType, LatticeType, ModuleType};

/// The lattice module type at `place`; names of connectors and motions are among these.
pub(super) fn lattice_type(
    name: &str,
    wire: &wire::ModuleType,
    connectors: &Names<'_>,
    motions: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<ModuleType> {
    let body = the_body(wire, place, findings);
    let lattice = lattice(wire, connectors, motions, place, findings);
    Some(ModuleType::of_lattice(name, body?, lattice?))
}

fn lattice(
    wire: &wire::ModuleType,
    connectors: &Names<'_>,
    motions: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<LatticeType> {
    let motions = of_lattice_type(wire, motions, place, findings);
    let mut needs = |key: &str, missing: bool, hint: &str| {
        if missing {
            findings.add(&place.key(key), codes::MISSING_KEY, "the key is missing", hint.to_string());
        }
    };
    needs("pitch_m", wire.pitch_m.is_none(), "a module with ports \"faces\" needs the edge length of its cell");
    needs("connector", wire.connector.is_none(), "a module with ports \"faces\" needs the connector of its faces");
    let hint = "a module that can pivot needs the connector that holds it at the edge meanwhile";
    needs("hinge", wire.hinge.is_none() && wire.motions.iter().any(|motion| motion == "pivot"), hint);
    if !wire.joints.is_empty() {
        let hint = "list its ports instead of \"faces\", or leave the joints out";
        refuse(&place.key("joints"), "a lattice module has no joints", hint, findings);
    }
    if wire.roll_step_deg.is_some() {
        let hint = "leave it out";
        refuse(&place.key("roll_step_deg"), "a lattice module does not roll", hint, findings);
    }
    let mut find = |key: &str, name: &str| connectors.find(name, &place.key(key), findings);
    let face = wire.connector.as_ref().and_then(|name| find("connector", name));
    let hinge = wire.hinge.as_ref().map(|name| find("hinge", name));
    if hinge == Some(None) {
        return None; // it names a connector that is not there
    }
    Some(LatticeType { pitch: wire.pitch_m?.0, face: face?, hinge: hinge.flatten(), motions: motions? })
}

fn the_body(wire: &wire::ModuleType, place: &Place<'_>, findings: &mut Findings) -> Option<BodyType> {
    let place = place.key("bodies");
    let [only] = wire.bodies.as_slice() else {
        let message = format!("a lattice module has one body, found {}", wire.bodies.len());
        refuse(&place, &message, "join the bodies to one, or list ports instead of \"faces\"", findings);
        return None;
    };
    let place = place.index(0);
    let off_centre = [
        ("shape_position_m", only.shape_position_m.is_some()),
        ("shape_rotation_xyzw", only.shape_rotation_xyzw.is_some()),
    ];
    for (key, _) in off_centre.iter().filter(|(_, present)| *present) {
        let hint = "the solid is the cell: leave it out";
        refuse(&place.key(key), "the solid of a lattice module is centred on its frame", hint, findings);
    }
    body(only, &place, findings).filter(|_| !off_centre.iter().any(|(_, present)| *present))
}
