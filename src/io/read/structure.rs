//! `structure/1` to a structure with names.

use nalgebra::Translation3;

use super::super::codes;
use super::super::document::NamedStructure;
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::connector::connectors;
use super::decode::decode;
use super::faults;
use super::names::Names;
use super::rotation::{normal, rotation, vector};
use crate::robot::Catalogue;
use crate::spatial::{Pose, Vec3};
use crate::statics::{Anchor, Body, Connection, Connector, Contact, Load, Model, Structure};

/// The name of what is no body.
const WORLD: &str = "world";

pub(super) fn read(root: &Place<'_>, findings: &mut Findings) -> Option<NamedStructure> {
    let wire: wire::Structure = decode("structure", root, findings)?;
    let place = |list: &str, index: usize| root.key(list).index(index);
    let body_ids: Vec<_> = wire.bodies.iter().map(|body| body.id.as_str()).collect();
    for (index, _) in body_ids.iter().enumerate().filter(|(_, id)| **id == WORLD) {
        let hint = "`world` means what is no body: rename the body, or make it `fixed`";
        findings.add(&place("bodies", index).key("id"), codes::BAD_ID, "`world` is no id for a body", hint.to_string());
    }
    let bodies = Names::new("bodies", body_ids.clone(), |index| place("bodies", index).key("id"), findings);
    let connector_names =
        Names::new("connectors", wire.connectors.keys().map(String::as_str).collect(), |_| root.clone(), findings);
    let reader = Reader { bodies, connectors: connector_names };

    let connection_names = names_of("connections", wire.connections.iter().map(|c| c.id.as_deref()), root, findings);
    let contact_names = names_of("contacts", wire.contacts.iter().map(|c| c.id.as_deref()), root, findings);
    let structure = Structure {
        gravity: vector(wire.gravity_m_s2),
        bodies: wire.bodies.iter().map(body).collect(),
        connectors: check_connectors(&wire, root, findings),
        connections: collect(&wire.connections, |i, c| reader.connection(c, &place("connections", i), findings)),
        contacts: collect(&wire.contacts, |i, c| reader.contact(c, &place("contacts", i), findings)),
        loads: collect(&wire.loads, |i, l| reader.load(l, &place("loads", i), findings)),
    };
    let bodies = body_ids.into_iter().map(str::to_string).collect();
    Some(NamedStructure { structure, bodies, connections: connection_names, contacts: contact_names })
}

fn check_connectors(wire: &wire::Structure, root: &Place<'_>, findings: &mut Findings) -> Vec<Connector> {
    let connectors = connectors(&wire.connectors);
    for (index, connector) in connectors.iter().enumerate() {
        if matches!(&connector.model, Model::Patch { points, .. } if points.is_empty()) {
            let place = root.key("connectors").entry(index).key("points_m");
            let hint =
                "only in a catalogue may a patch leave them out: it takes the corners of the face it sits on there";
            findings.add(&place, codes::MISSING_KEY, "a patch needs its contact points", hint.to_string());
        }
    }
    let catalogue = Catalogue { name: String::new(), connectors, motions: Vec::new(), module_types: Vec::new() };
    faults::of_catalogue(&catalogue.problems(), 0, root, findings);
    catalogue.connectors
}

/// Converts what can be converted.
fn collect<W, T>(list: &[W], mut convert: impl FnMut(usize, &W) -> Option<T>) -> Vec<T> {
    list.iter().enumerate().filter_map(|(index, wire)| convert(index, wire)).collect()
}

/// Ids of a list's items; an item without one is called by its place.
fn names_of<'w>(
    list: &'static str,
    ids: impl Iterator<Item = Option<&'w str>>,
    root: &Place<'_>,
    findings: &mut Findings,
) -> Vec<String> {
    let named: Vec<_> =
        ids.enumerate().map(|(index, id)| id.map_or_else(|| format!("{list}[{index}]"), str::to_string)).collect();
    Names::new(
        list,
        named.iter().map(String::as_str).collect(),
        |index| root.key(list).index(index).key("id"),
        findings,
    );
    named
}

fn body(wire: &wire::Body) -> Body {
    Body { mass: wire.mass_kg.0, com: vector(wire.com_m), fixed: wire.fixed }
}

struct Reader<'a> {
    bodies: Names<'a>,
    connectors: Names<'a>,
}

impl Reader<'_> {
    fn anchor(&self, name: &str, place: &Place<'_>, findings: &mut Findings) -> Option<Anchor> {
        if name == WORLD {
            return Some(Anchor::World);
        }
        self.bodies.find(name, place, findings).map(Anchor::Body)
    }

    fn connection(&self, wire: &wire::Connection, place: &Place<'_>, findings: &mut Findings) -> Option<Connection> {
        let parent = self.anchor(&wire.parent, &place.key("parent"), findings);
        let child = self.anchor(&wire.child, &place.key("child"), findings);
        if parent.is_some() && parent == child {
            let message = format!("connects `{}` to itself", wire.child);
            let hint = "parent and child are two different bodies, or a body and `world`";
            findings.add(&place.key("child"), codes::SELF_CONNECTION, message, hint.to_string());
        }
        let connector = self.connectors.find(&wire.connector, &place.key("connector"), findings);
        let rotation = rotation(wire.rotation_xyzw, &place.key("rotation_xyzw"), findings);
        let frame = Pose::from_parts(Translation3::from(vector(wire.position_m)), rotation);
        Some(Connection { parent: parent?, child: child?, connector: connector?, frame })
    }

    fn contact(&self, wire: &wire::Contact, place: &Place<'_>, findings: &mut Findings) -> Option<Contact> {
        let body = self.bodies.find(&wire.body, &place.key("body"), findings);
        let against = self.anchor(&wire.against, &place.key("against"), findings);
        if body.is_some() && against == body.map(Anchor::Body) {
            let message = format!("`{}` cannot touch itself", wire.body);
            findings.add(
                &place.key("against"),
                codes::SELF_CONNECTION,
                message,
                "name another body, or `world`".to_string(),
            );
        }
        let normal = normal(wire.normal, &place.key("normal"), findings);
        let (position, friction) = (vector(wire.position_m), wire.friction.0);
        Some(Contact { body: body?, against: against?, position, normal, friction })
    }

    fn load(&self, wire: &wire::Load, place: &Place<'_>, findings: &mut Findings) -> Option<Load> {
        let body = self.bodies.find(&wire.body, &place.key("body"), findings)?;
        let torque = wire.torque_nm.map_or_else(Vec3::zeros, vector);
        Some(Load { body, force: vector(wire.force_n), torque, at: wire.at_m.map(vector) })
    }
}
