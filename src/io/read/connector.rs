//! Connector models.

use super::super::wire;
use crate::statics::{Connector, Model};

/// The connectors that stand at `place`, by name.
pub(super) fn connectors<'w>(wires: impl IntoIterator<Item = (&'w String, &'w wire::Connector)>) -> Vec<Connector> {
    wires.into_iter().map(|(name, wire)| connector(name, wire)).collect()
}

fn connector(name: &str, wire: &wire::Connector) -> Connector {
    let (strength, model) = match wire {
        wire::Connector::Cone { strength_n, friction, radius_m } => {
            (strength_n, Model::Cone { friction: friction.map(|mu| mu.0), radius: radius_m.map(|rho| rho.0) })
        }
        wire::Connector::Box { strength_n, shear_n, tension_n, compression_n, bending_nm, torsion_nm } => {
            let model = Model::Box {
                shear: shear_n.map(limit),
                tension: limit(*tension_n),
                compression: limit(*compression_n),
                bending: bending_nm.map(limit),
                torsion: limit(*torsion_nm),
            };
            (strength_n, model)
        }
        wire::Connector::Patch { strength_n, friction, points_m } => {
            let points = points_m.iter().flatten().map(|point| point.map(|real| real.0)).collect();
            (strength_n, Model::Patch { friction: friction.0, points })
        }
    };
    Connector { name: name.to_string(), strength: strength.0, model }
}

fn limit(wire: wire::Limit) -> f64 {
    wire.0.unwrap_or(f64::INFINITY)
}
