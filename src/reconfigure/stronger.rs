//! What a structure would be with stronger connectors.
//!
//! Knows what strength means in each model; does not know what holds on to what.

use crate::statics::{Connector, Model, Structure};

/// A connector that is so many times as strong: a wrench that took a share of its strength takes that share over
/// `factor`. The limits of a latch are those at its rated strength, and go with it; friction and levers stay.
pub fn stronger(connector: &Connector, factor: f64) -> Connector {
    let model = match &connector.model {
        Model::Box { shear, tension, compression, bending, torsion } => Model::Box {
            shear: shear.map(|limit| limit * factor),
            tension: tension * factor,
            compression: compression * factor,
            bending: bending.map(|limit| limit * factor),
            torsion: torsion * factor,
        },
        other @ (Model::Cone { .. } | Model::Patch { .. }) => other.clone(),
    };
    Connector { name: connector.name.clone(), strength: connector.strength * factor, model }
}

/// Makes those connections of a structure that `is_it` picks, by their index, so many times as strong.
pub fn strengthen(structure: &mut Structure, factor: f64, is_it: impl Fn(usize) -> bool) {
    for index in (0..structure.connections.len()).filter(|&index| is_it(index)) {
        let connector = stronger(&structure.connectors[structure.connections[index].connector], factor);
        structure.connections[index].connector = structure.connectors.len();
        structure.connectors.push(connector);
    }
}
