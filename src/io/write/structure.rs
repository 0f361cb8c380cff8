//! A structure with names to `structure/1`.

use super::super::document::NamedStructure;
use super::super::wire::{self, NonNegative};
use super::connector::connectors;
use super::{vector, xyzw};
use crate::statics::Anchor;

pub(super) fn wire(named: &NamedStructure) -> wire::Structure {
    let structure = &named.structure;
    let body = |index: usize| named.bodies[index].clone();
    let anchor = |anchor: Anchor| match anchor {
        Anchor::World => "world".to_string(),
        Anchor::Body(index) => body(index),
    };
    let connector = |index: usize| structure.connectors[index].name.clone();
    let bodies = structure.bodies.iter().zip(&named.bodies).map(|(body, id)| wire::Body {
        id: id.clone(),
        mass_kg: NonNegative(body.mass),
        com_m: vector(body.com),
        fixed: body.fixed,
    });
    let connections = structure.connections.iter().zip(&named.connections).map(|(connection, id)| wire::Connection {
        id: Some(id.clone()),
        parent: anchor(connection.parent),
        child: anchor(connection.child),
        connector: connector(connection.connector),
        position_m: vector(connection.frame.translation.vector),
        rotation_xyzw: xyzw(&connection.frame.rotation),
    });
    let contacts = structure.contacts.iter().zip(&named.contacts).map(|(contact, id)| wire::Contact {
        id: Some(id.clone()),
        body: body(contact.body),
        against: anchor(contact.against),
        position_m: vector(contact.position),
        normal: vector(contact.normal),
        friction: NonNegative(contact.friction),
    });
    let loads = structure.loads.iter().map(|load| wire::Load {
        body: body(load.body),
        force_n: vector(load.force),
        torque_nm: Some(vector(load.torque)),
        at_m: load.at.map(vector),
    });
    wire::Structure {
        format: wire::StructureFormat::V1,
        gravity_m_s2: vector(structure.gravity),
        bodies: bodies.collect(),
        connectors: connectors(&structure.connectors),
        connections: connections.collect(),
        contacts: contacts.collect(),
        loads: loads.collect(),
    }
}
