//! Prepares the oracle's wrenches and contact forces for the checker.

use crate::spatial::{Vec3, Wrench};
use crate::statics::{Anchor, Assessment, Model, Structure, face_forces};

use super::super::balance::{movable, sums};
use super::super::forest::{carry, forest};
use super::super::{Carried, Stress};
use super::settle::{Forces, middle, settle};

/// Extra pressure on faces, relative to the forces on the bodies that they join; tried
/// in turn.
const SPARE: [f64; 9] = [1e-15, 1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7];

/// How much what carries nothing may help to make a part balance, relative to what
/// carries most; tried in turn.
const HELP: [f64; 2] = [0.0, 1e-6];

/// Forces on a body without load, relative to the largest of all, that count as none;
/// tried in turn. No force is needed there, and a trace of one need not balance.
const TRACE: [f64; 2] = [0.0, 1e-7];

/// Rounds of making bodies balance.
const ROUNDS: usize = 3;

/// One way of preparing a stress.
#[derive(Clone, Copy)]
struct Way {
    spare: f64,
    help: f64,
    trace: f64,
}

/// Stresses near the answer's, the tightest first.
pub(super) fn prepare<'s>(structure: &'s Structure, answer: &'s Assessment) -> impl Iterator<Item = Stress> + 's {
    let ways = TRACE.into_iter().flat_map(|trace| {
        HELP.into_iter().flat_map(move |help| SPARE.into_iter().map(move |spare| Way { spare, help, trace }))
    });
    let faces = structure.connectors.iter().any(|connector| matches!(connector.model, Model::Patch { .. }));
    let tells = move |way: &Way| faces || way.spare == SPARE[0];
    ways.filter(tells).filter_map(move |way| balanced(structure, answer, way))
}

/// The answer's stress, made to balance: along the forest of connections, and by what
/// parts stand on where no connection leads to the ground.
fn balanced(structure: &Structure, answer: &Assessment, way: Way) -> Option<Stress> {
    let forest = forest(structure);
    let model = |index: usize| &structure.connectors[structure.connections[index].connector].model;
    let mut wrenches: Vec<Wrench> = (answer.connections.iter().enumerate())
        .map(|(index, state)| without_what_cannot_be(model(index), state.wrench))
        .collect();
    let mut contacts = answer.contacts.clone();
    let mut spares = vec![0.0; wrenches.len()];
    for round in 0..=ROUNDS {
        clear(structure, way.trace, &mut wrenches, &mut contacts);
        let carried = wrenches.iter().zip(&spares).enumerate();
        let carried = carried.map(|(index, (wrench, spare))| carried_by(model(index), wrench, *spare));
        let stress = Stress { connections: carried.collect::<Option<_>>()?, contacts };
        if round == ROUNDS {
            return Some(stress);
        }
        let sums = sums(structure, &stress);
        let most = sums.iter().map(|sum| sum.force).fold(0.0, f64::max);
        for (connection, room) in structure.connections.iter().zip(&mut spares) {
            let ends = [connection.parent, connection.child].into_iter().filter_map(|end| movable(structure, end));
            let around = ends.map(|body| sums[body].force).fold(0.0, f64::max);
            // What carries nothing may still have to carry the rounding of others.
            *room = way.spare * if around > 0.0 { around } else { most };
        }
        let (rest, left) = carry(structure, &forest, &sums);
        for (wrench, rest) in wrenches.iter_mut().zip(rest) {
            *wrench += middle(&rest);
        }
        contacts = stress.contacts;
        let mut forces = Forces { wrenches: &mut wrenches, contacts: &mut contacts };
        settle(structure, &forest, &left, way.help, &mut forces);
    }
    None
}

/// Takes away what acts on bodies without load, where that is no more than a `trace`
/// of the largest force of all, and what nothing needs: contacts of fixed bodies.
fn clear(structure: &Structure, trace: f64, wrenches: &mut [Wrench], contacts: &mut [Vec3]) {
    let mut loaded: Vec<bool> =
        structure.bodies.iter().map(|body| body.mass * structure.gravity.norm() > 0.0).collect();
    for load in &structure.loads {
        loaded[load.body] |= load.force.norm() + load.torque.norm() > 0.0;
    }
    let ends = |a: Anchor, b: Anchor| [movable(structure, a), movable(structure, b)];
    let held = structure.connections.iter().map(|connection| ends(connection.parent, connection.child));
    let held: Vec<_> = held.collect();
    let touching = structure.contacts.iter().map(|contact| ends(Anchor::Body(contact.body), contact.against));
    let touching: Vec<_> = touching.collect();
    let sizes = wrenches.iter().map(|wrench| wrench.force.norm()).chain(contacts.iter().map(Vec3::norm));
    let sizes: Vec<f64> = sizes.collect();
    let most = sizes.iter().copied().fold(0.0, f64::max);
    for (ends, size) in held.iter().chain(&touching).zip(sizes) {
        for body in ends.iter().flatten() {
            loaded[*body] |= size > trace * most;
        }
    }
    let idle = |ends: &[Option<usize>; 2]| *ends == [None, None] || ends.iter().flatten().any(|body| !loaded[*body]);
    for (wrench, _) in wrenches.iter_mut().zip(&held).filter(|(_, ends)| idle(ends)) {
        *wrench = Wrench::ZERO;
    }
    for (force, _) in contacts.iter_mut().zip(&touching).filter(|(_, ends)| idle(ends)) {
        *force = Vec3::zeros();
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

/// How a connector carries `wrench`, a face with the extra pressure `spare` in N: also
/// where it carries nothing, since rounding leaves it something to carry.
fn carried_by(model: &Model, wrench: &Wrench, spare: f64) -> Option<Carried> {
    let Model::Patch { friction, points } = model else { return Some(Carried::Wrench(*wrench)) };
    let pulled = if *wrench == Wrench::ZERO { Wrench::new(-Vec3::z() * spare, Vec3::zeros()) } else { *wrench };
    let forces = face_forces(&pulled, *friction, points, spare)?;
    let pressing: f64 = forces.iter().map(|force| force.z).sum();
    Some(Carried::Points { preload: (pressing - wrench.force.z).max(0.0), forces })
}
