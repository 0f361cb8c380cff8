//! Prepares the oracle's wrenches and contact forces for the checker.

use nalgebra::{Matrix6, Matrix6x3, Vector6};

use crate::spatial::{Vec3, Wrench};
use crate::statics::{Anchor, Assessment, Model, Structure, face_forces};

use super::super::balance::{Branch, carry, forest, movable, sums};
use super::super::models::Push;
use super::super::{Carried, Stress};

/// Extra pressure on faces, relative to the forces on the bodies that they join; tried
/// in turn.
const SPARE: [f64; 8] = [1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8];

/// Most iterations of a singular value decomposition of six rows; it needs about ten.
const SWEEPS: usize = 200;

/// Rounds of making bodies balance.
const ROUNDS: usize = 3;

/// Stresses near the answer's, the tightest first.
pub(super) fn prepare<'s>(structure: &'s Structure, answer: &'s Assessment) -> impl Iterator<Item = Stress> + 's {
    let faces = structure.connectors.iter().any(|connector| matches!(connector.model, Model::Patch { .. }));
    let tries = if faces { SPARE.len() } else { 1 };
    SPARE.iter().take(tries).filter_map(move |spare| balanced(structure, answer, *spare))
}

/// The answer's stress, made to balance: along the forest of connections, and by the
/// contacts where no connection leads to the ground.
fn balanced(structure: &Structure, answer: &Assessment, spare: f64) -> Option<Stress> {
    let forest = forest(structure);
    let model = |index: usize| &structure.connectors[structure.connections[index].connector].model;
    let mut wrenches: Vec<Wrench> = (answer.connections.iter().enumerate())
        .map(|(index, state)| without_what_cannot_be(model(index), state.wrench))
        .collect();
    let mut contacts = answer.contacts.clone();
    let mut spares = vec![0.0; wrenches.len()];
    for round in 0..=ROUNDS {
        let carried = wrenches.iter().zip(&spares).enumerate();
        let carried = carried.map(|(index, (wrench, spare))| carried_by(model(index), wrench, *spare));
        let stress = Stress { connections: carried.collect::<Option<_>>()?, contacts };
        if round == ROUNDS {
            return Some(stress);
        }
        let sums = sums(structure, &stress);
        for (connection, room) in structure.connections.iter().zip(&mut spares) {
            let ends = [connection.parent, connection.child].into_iter().filter_map(|end| movable(structure, end));
            *room = spare * ends.map(|body| sums[body].force).fold(0.0, f64::max);
        }
        let (rest, left) = carry(structure, &forest, &sums);
        for (wrench, rest) in wrenches.iter_mut().zip(rest) {
            *wrench += Wrench::new(rest.force.middle(), rest.torque.middle());
        }
        contacts = stress.contacts;
        settle(structure, &forest, &left, &mut contacts);
    }
    None
}

/// Takes what is left on each part without a connection to the ground by its contacts:
/// by the smallest change relative to what they carry.
fn settle(structure: &Structure, forest: &[Branch], left: &[(usize, Push)], contacts: &mut [Vec3]) {
    let mut root: Vec<Option<usize>> = vec![None; structure.bodies.len()];
    for &(body, holder) in forest {
        root[body] = match holder {
            None => Some(body),
            Some((_, behind)) => behind.and_then(|behind| root[behind]),
        };
    }
    let mut touching = vec![Vec::new(); structure.bodies.len()];
    for (index, contact) in structure.contacts.iter().enumerate() {
        let part = |anchor: Anchor| movable(structure, anchor).and_then(|body| root[body]);
        let (a, b) = (part(Anchor::Body(contact.body)), part(contact.against));
        for (part, sign) in [(a, 1.0), (b, -1.0)].into_iter().filter(|_| a != b) {
            if let Some(part) = part {
                touching[part].push((index, sign));
            }
        }
    }
    for (part, surplus) in left {
        let com = structure.bodies[*part].com;
        let arms: Vec<Vec3> =
            touching[*part].iter().map(|(index, _)| structure.contacts[*index].position - com).collect();
        let lever = arms.iter().map(Vec3::norm).fold(f64::MIN_POSITIVE, f64::max);
        // What a unit force at a contact does to the part, moments over the lever.
        let effects = arms.iter().map(|arm| {
            let mut effect = Matrix6x3::zeros();
            effect.fixed_view_mut::<3, 3>(0, 0).fill_with_identity();
            effect.fixed_view_mut::<3, 3>(3, 0).copy_from(&(arm / lever).cross_matrix());
            effect
        });
        let effects: Vec<Matrix6x3<f64>> = effects.collect();
        let most = touching[*part].iter().map(|(index, _)| contacts[*index].norm_squared()).fold(0.0, f64::max);
        if !(most > 0.0 && most < f64::INFINITY) {
            continue;
        }
        let share = |index: usize| contacts[index].norm_squared() / most;
        let weights: Vec<f64> = touching[*part].iter().map(|(index, _)| share(*index)).collect();
        let metric = effects.iter().zip(&weights).map(|(effect, weight)| effect * effect.transpose() * *weight);
        let metric: Matrix6<f64> = metric.sum();
        let (force, torque) = (surplus.force.middle(), surplus.torque.middle() / lever);
        let wanted = Vector6::new(force.x, force.y, force.z, torque.x, torque.y, torque.z);
        if !metric.iter().chain(&wanted).all(|x| x.is_finite()) {
            continue;
        }
        let Some(factors) = metric.try_svd(true, true, f64::EPSILON, SWEEPS) else { continue };
        let Ok(pull) = factors.solve(&wanted, 1e-12) else { continue };
        for (((index, sign), effect), weight) in touching[*part].iter().zip(&effects).zip(&weights) {
            let change = effect.tr_mul(&pull) * (*weight * *sign);
            if change.iter().all(|x| x.is_finite()) {
                contacts[*index] -= change;
            }
        }
    }
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

fn carried_by(model: &Model, wrench: &Wrench, spare: f64) -> Option<Carried> {
    let Model::Patch { friction, points } = model else { return Some(Carried::Wrench(*wrench)) };
    let forces = face_forces(wrench, *friction, points, spare)?;
    let pressing: f64 = forces.iter().map(|force| force.z).sum();
    Some(Carried::Points { preload: (pressing - wrench.force.z).max(0.0), forces })
}
