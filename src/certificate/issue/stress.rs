//! Prepares the oracle's wrenches and contact forces for the checker.

use crate::spatial::Wrench;
use crate::statics::{Assessment, Model, Structure, face_forces};

use super::super::balance::{carry, forest, sums};
use super::super::{Carried, Stress};

/// Shares of extra pressure on faces, tried in turn.
const SPARE: [f64; 6] = [1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10];

/// Rounds of carrying what bodies lack along the forest.
const ROUNDS: usize = 3;

/// Stresses near the answer's, the tightest first.
pub(super) fn prepare<'s>(structure: &'s Structure, answer: &'s Assessment) -> impl Iterator<Item = Stress> + 's {
    let faces = structure.connectors.iter().any(|connector| matches!(connector.model, Model::Patch { .. }));
    let tries = if faces { SPARE.len() } else { 1 };
    SPARE.iter().take(tries).filter_map(move |spare| balanced(structure, answer, *spare))
}

fn balanced(structure: &Structure, answer: &Assessment, spare: f64) -> Option<Stress> {
    let forest = forest(structure);
    let model = |index: usize| &structure.connectors[structure.connections[index].connector].model;
    let mut wrenches: Vec<Wrench> = (answer.connections.iter().enumerate())
        .map(|(index, state)| without_what_cannot_be(model(index), state.wrench))
        .collect();
    let express = |wrenches: &[Wrench]| {
        let carried = wrenches.iter().enumerate().map(|(index, wrench)| carried(model(index), wrench, spare));
        Some(Stress { connections: carried.collect::<Option<_>>()?, contacts: answer.contacts.clone() })
    };
    let mut stress = express(&wrenches)?;
    for _ in 0..ROUNDS {
        let (rest, _) = carry(structure, &forest, &sums(structure, &stress));
        for (wrench, rest) in wrenches.iter_mut().zip(rest) {
            *wrench += Wrench::new(rest.force.middle(), rest.torque.middle());
        }
        stress = express(&wrenches)?;
    }
    Some(stress)
}

/// The wrench without the traces of components whose limit is 0.
fn without_what_cannot_be(model: &Model, mut wrench: Wrench) -> Wrench {
    if let Model::Box { shear, tension, compression, bending, torsion } = model {
        let normal = if wrench.force.z < 0.0 { *tension } else { *compression };
        let limits = [shear[0], shear[1], normal, bending[0], bending[1], *torsion];
        let components = wrench.force.iter_mut().chain(wrench.torque.iter_mut());
        for (component, _) in components.zip(limits).filter(|(_, limit)| *limit == 0.0) {
            *component = 0.0;
        }
    }
    wrench
}

fn carried(model: &Model, wrench: &Wrench, spare: f64) -> Option<Carried> {
    let Model::Patch { friction, points } = model else { return Some(Carried::Wrench(*wrench)) };
    let forces = face_forces(wrench, *friction, points, spare)?;
    let pressing: f64 = forces.iter().map(|force| force.z).sum();
    Some(Carried::Points { preload: (pressing - wrench.force.z).max(0.0), forces })
}
