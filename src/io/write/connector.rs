//! Connector models.

use indexmap::IndexMap;

use super::super::wire::{self, NonNegative, Positive};
use crate::statics::{Connector, Model};

/// Connectors by name.
pub(super) fn connectors(connectors: &[Connector]) -> IndexMap<String, wire::Connector> {
    connectors.iter().map(|connector| (connector.name.clone(), wire(connector))).collect()
}

fn wire(connector: &Connector) -> wire::Connector {
    let strength_n = Positive(connector.strength);
    match &connector.model {
        Model::Cone { friction, radius } => {
            wire::Connector::Cone { strength_n, friction: friction.map(Positive), radius_m: radius.map(Positive) }
        }
        Model::Box { shear, tension, compression, bending, torsion } => wire::Connector::Box {
            strength_n,
            shear_n: shear.map(limit),
            tension_n: limit(*tension),
            compression_n: limit(*compression),
            bending_nm: bending.map(limit),
            torsion_nm: limit(*torsion),
        },
        Model::Patch { friction, points } => wire::Connector::Patch {
            strength_n,
            friction: NonNegative(*friction),
            points_m: (!points.is_empty()).then(|| points.iter().map(|point| wire::reals(*point)).collect()),
        },
    }
}

fn limit(limit: f64) -> wire::Limit {
    wire::Limit((limit != f64::INFINITY).then_some(limit))
}
