//! Refuses certificates whose data mean nothing: before anything is proved.

use crate::statics::{Anchor, Model};

use super::{Carried, Certificate};

/// The first thing that makes a certificate meaningless; `None` when it is sound.
///
/// What is not finite needs no mention here: nothing can be proved from it.
pub(super) fn unsound(certificate: &Certificate) -> Option<String> {
    let structure = &certificate.structure;
    let exists = |anchor: Anchor| match anchor {
        Anchor::World => true,
        Anchor::Body(i) => i < structure.bodies.len(),
    };
    for (i, body) in structure.bodies.iter().enumerate() {
        if !(body.mass >= 0.0) {
            return Some(format!("body {i} has the mass {}", body.mass));
        }
    }
    for connector in &structure.connectors {
        if !(connector.strength > 0.0) || !positive(&connector.model) {
            return Some(format!("the connector {} has limits that are none", connector.name));
        }
    }
    for (i, connection) in structure.connections.iter().enumerate() {
        let ends = exists(connection.parent) && exists(connection.child) && connection.parent != connection.child;
        if !ends || connection.connector >= structure.connectors.len() {
            return Some(format!("connection {i} joins what is not there"));
        }
    }
    for (i, contact) in structure.contacts.iter().enumerate() {
        let ends = exists(Anchor::Body(contact.body)) && exists(contact.against);
        if !ends || contact.against == Anchor::Body(contact.body) || !(contact.friction >= 0.0) {
            return Some(format!("contact {i} touches what is not there, or has no friction coefficient"));
        }
    }
    if structure.loads.iter().any(|load| load.body >= structure.bodies.len()) {
        return Some("a load acts on no body".to_owned());
    }
    incomplete(certificate)
}

/// Whether every limit is one: friction, radii and forces that are not negative.
fn positive(model: &Model) -> bool {
    match model {
        Model::Cone { friction, radius } => friction.iter().chain(radius).all(|x| *x > 0.0),
        Model::Box { shear, tension, compression, bending, torsion } => {
            shear.iter().chain([tension, compression]).chain(bending).chain([torsion]).all(|x| *x >= 0.0)
        }
        Model::Patch { friction, .. } => *friction >= 0.0,
    }
}

/// What is missing in the fields, or too much.
fn incomplete(certificate: &Certificate) -> Option<String> {
    let structure = &certificate.structure;
    if let Some(stress) = &certificate.stress {
        if stress.connections.len() != structure.connections.len() || stress.contacts.len() != structure.contacts.len()
        {
            return Some("the stress is not one of this structure".to_owned());
        }
        for (i, (connection, carried)) in structure.connections.iter().zip(&stress.connections).enumerate() {
            let fits = match (&structure.connectors[connection.connector].model, carried) {
                (Model::Patch { points, .. }, Carried::Points { forces, .. }) => points.len() == forces.len(),
                (Model::Cone { .. } | Model::Box { .. }, Carried::Wrench(_)) => true,
                (Model::Patch { .. } | Model::Cone { .. } | Model::Box { .. }, _) => false,
            };
            if !fits {
                return Some(format!("connection {i} carries what its connector cannot"));
            }
        }
    }
    let twists = certificate.mechanism.as_ref().map_or(structure.bodies.len(), |mechanism| mechanism.twists.len());
    (twists != structure.bodies.len()).then(|| "the mechanism is not one of this structure".to_owned())
}
