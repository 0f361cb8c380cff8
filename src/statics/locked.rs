//! Locks what does not move, where only resting is admissible.
//!
//! Parts that press against each other whatever the loads, floor and ceiling or a latch
//! that takes any pull and the contact beside it, have no motion that opens all of
//! them: their opening velocities are zero, exactly, and a solver's are noise of
//! either sign. Where whole bodies are at rest against each other they are fused (see
//! `clusters`); where they still hinge or slide, the components at rest are held here,
//! by connections that take any force along them. A mechanism so restricted proves what
//! it proves for the block as well.

use crate::spatial::{Pose, Rotation, Vec3};

use super::blocks::Link;
use super::clusters::Reduced;
use super::connector::{Connector, Model};
use super::structure::{Anchor, Connection, Contact};

/// Which components of every link's relative twist, in its frame, are at rest.
pub(super) type AtRest = Vec<[bool; 6]>;

/// Holds those components of the links of `reduced` that are at rest and that one
/// direction of a force could hold without limit; `at_rest` is by link of the original.
pub(super) fn lock(reduced: &mut Reduced, at_rest: &[[bool; 6]]) {
    let Reduced { structure, block, origins, .. } = reduced;
    let contacts = origins.split_off(structure.connections.len());
    for (connection, origin) in structure.connections.iter_mut().zip(&*origins) {
        let mut connector = structure.connectors[connection.connector].clone();
        if hold(&mut connector.model, &at_rest[*origin]) {
            connection.connector = structure.connectors.len();
            structure.connectors.push(connector);
        }
    }
    let mut left = (Vec::new(), Vec::new());
    for (contact, origin) in std::mem::take(&mut structure.contacts).into_iter().zip(contacts) {
        let resting = at_rest[origin];
        let along = if contact.friction > 0.0 { resting[..3] == [true; 3] } else { resting[2] };
        if along {
            structure.connections.push(pin(&contact, structure.connectors.len()));
            structure.connectors.push(holder(contact.friction > 0.0));
            origins.push(origin);
        } else {
            left.0.push(contact);
            left.1.push(origin);
        }
    }
    (structure.contacts, _) = (left.0, origins.extend(left.1));
    let connections = (0..structure.connections.len()).map(Link::Connection);
    block.links = connections.chain((0..structure.contacts.len()).map(Link::Contact)).collect();
}

/// Takes the other limit away from components at rest that have but one; whether there
/// were any.
fn hold(model: &mut Model, at_rest: &[bool; 6]) -> bool {
    let Model::Box { tension, compression, .. } = model else { return false };
    let one_sided = tension.is_infinite() != compression.is_infinite();
    if one_sided && at_rest[2] {
        (*tension, *compression) = (f64::INFINITY, f64::INFINITY);
    }
    one_sided && at_rest[2]
}

/// A connection where a contact is.
fn pin(contact: &Contact, connector: usize) -> Connection {
    let turn = Rotation::rotation_between(&Vec3::z(), &contact.normal)
        .unwrap_or_else(|| Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI));
    let frame = Pose::from_parts(contact.position.into(), turn);
    Connection { parent: contact.against, child: Anchor::Body(contact.body), connector, frame }
}

/// Takes any force at a point, along the normal only where it is `smooth`, and no torque.
fn holder(rough: bool) -> Connector {
    let shear = if rough { f64::INFINITY } else { 0.0 };
    let model = Model::Box {
        shear: [shear; 2],
        tension: f64::INFINITY,
        compression: f64::INFINITY,
        bending: [0.0; 2],
        torsion: 0.0,
    };
    // No strength limits it, so that it says nothing of the utilisation to expect.
    Connector { name: String::new(), strength: f64::MAX, model }
}
