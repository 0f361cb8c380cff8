//! The bound from above: forces that balance, within all friction cones, prove that
//! their largest demand suffices.

use crate::spatial::Vec3;
use crate::statics::{Anchor, Model, Structure};

use super::allowance::Allowance;
use super::check::Fault;
use super::forest::{carry, forest};
use super::interval::{Axes, Interval, Vector};
use super::loads::loads;
use super::models::{Push, demand};
use super::{Carried, DATA, Stress};

/// What a stress proves: an upper bound on the utilisation.
///
/// # Errors
/// Every body that is out of balance, contact that slips and connection that gives.
pub(super) fn upper_bound(
    structure: &Structure,
    stress: &Stress,
    allowance: &mut Allowance,
) -> Result<f64, Vec<Fault>> {
    let mut faults = Vec::new();
    let sums = sums(structure, stress);
    for (body, sum) in sums.iter().enumerate() {
        let (force, torque) = (sum.surplus.force.norm().upper, sum.surplus.torque.norm().upper);
        if movable(structure, Anchor::Body(body)).is_some()
            && !(force <= DATA * sum.force && torque <= DATA * sum.torque)
        {
            let lacks = format!("lacks {force:e} N and {torque:e} N m of {:e} N and {:e} N m", sum.force, sum.torque);
            faults.push(Fault::Body { body, problem: lacks });
        }
    }
    let loads = loads(structure);
    for (contact, force) in stress.contacts.iter().enumerate() {
        let excess = slip(structure, contact, force);
        let data = &structure.contacts[contact];
        let size = match movable(structure, Anchor::Body(data.body)).or(movable(structure, data.against)) {
            Some(body) => sums[body].force.min(loads[body].0),
            None => 0.0,
        };
        if !allowance.forgives(excess, size) {
            faults.push(Fault::Contact { contact, problem: format!("is outside its friction cone by {excess:e} N") });
        }
    }
    let forest = forest(structure);
    let (rest, left) = carry(structure, &forest, &sums);
    for (body, lacking) in left {
        let (force, lever) = loads[body];
        let forgiven = allowance.forgives(lacking.force.norm().upper, force)
            && allowance.forgives(lacking.torque.norm().upper, lever);
        if !forgiven {
            let lacking = format!("{:e} N, {:e} N m", lacking.force.norm().upper, lacking.torque.norm().upper);
            let problem = format!("and what hangs with it, without a connection to the ground, lacks {lacking}");
            faults.push(Fault::Body { body, problem });
        }
    }
    let mut largest = 0.0_f64;
    for (connection, (carried, rest)) in stress.connections.iter().zip(&rest).enumerate() {
        let connector = &structure.connectors[structure.connections[connection].connector];
        match demand(connector, carried, rest) {
            Ok(utilisation) => largest = largest.max(utilisation),
            Err(problem) => faults.push(Fault::Connection { connection, problem }),
        }
    }
    if faults.is_empty() { Ok(largest) } else { Err(faults) }
}

/// The body that an anchor stands for, if it needs balance.
pub(super) fn movable(structure: &Structure, anchor: Anchor) -> Option<usize> {
    match anchor {
        Anchor::Body(i) if !structure.bodies[i].fixed => Some(i),
        Anchor::Body(_) | Anchor::World => None,
    }
}

/// All that acts on a body.
pub(super) struct Sum {
    /// The sum itself, about the centre of mass, in W: zero in balance.
    pub surplus: Push,
    /// Sum of the sizes of all forces, in N.
    pub force: f64,
    /// Sum of the sizes of all torques and moments, in N m.
    pub torque: f64,
}

/// What acts on each body; nothing on fixed ones.
pub(super) fn sums(structure: &Structure, stress: &Stress) -> Vec<Sum> {
    let nothing = || Sum { surplus: Push::ZERO, force: 0.0, torque: 0.0 };
    let mut sums: Vec<Sum> = structure.bodies.iter().map(|_| nothing()).collect();
    let mut act = |anchor: Anchor, push: &Push, at: &Vec3, [force, torque]: [f64; 2]| {
        if let Some(body) = movable(structure, anchor) {
            let moved = push.moved(&arm(structure, body, at));
            let sum = &mut sums[body];
            sum.surplus = sum.surplus.plus(&moved);
            sum.force += force;
            sum.torque += torque + (at - structure.bodies[body].com).norm() * force;
        }
    };
    for (body, data) in structure.bodies.iter().enumerate() {
        let weight = Vector::exact(&structure.gravity).times(Interval::exact(data.mass));
        let push = Push::of(weight);
        act(Anchor::Body(body), &push, &data.com, push.sizes());
    }
    for load in &structure.loads {
        let push = Push { force: Vector::exact(&load.force), torque: Vector::exact(&load.torque) };
        let at = load.at.unwrap_or(structure.bodies[load.body].com);
        act(Anchor::Body(load.body), &push, &at, push.sizes());
    }
    for (connection, carried) in structure.connections.iter().zip(&stress.connections) {
        let axes = Axes::of(&connection.frame.rotation);
        let (local, sizes) = wrench(&structure.connectors[connection.connector].model, carried);
        let push = Push { force: axes.to_world(&local.force), torque: axes.to_world(&local.torque) };
        act(connection.child, &push, &connection.frame.translation.vector, sizes);
        act(connection.parent, &push.negative(), &connection.frame.translation.vector, sizes);
    }
    for (contact, force) in structure.contacts.iter().zip(&stress.contacts) {
        let push = Push::of(Vector::exact(force));
        act(Anchor::Body(contact.body), &push, &contact.position, push.sizes());
        act(contact.against, &push.negative(), &contact.position, push.sizes());
    }
    sums
}

/// From a body's centre of mass to a point.
pub(super) fn arm(structure: &Structure, body: usize, at: &Vec3) -> Vector {
    Vector::exact(at) - Vector::exact(&structure.bodies[body].com)
}

/// The wrench on the child that a connection carries, in the connection frame, and the
/// sizes of the forces and torques that it is the sum of.
fn wrench(model: &Model, carried: &Carried) -> (Push, [f64; 2]) {
    let parts = match (carried, model) {
        (Carried::Wrench(wrench), _) => vec![Push::exact(wrench)],
        (Carried::Points { preload, forces }, Model::Patch { points, .. }) => {
            let preload = Vector { z: Interval::exact(-preload), ..Vector::ZERO };
            let at = |p: &[f64; 2]| Vector { x: Interval::exact(p[0]), y: Interval::exact(p[1]), z: Interval::ZERO };
            let forces = forces.iter().map(|force| Push::of(Vector::exact(force)));
            let forces = forces.zip(points).map(|(push, point)| push.moved(&at(point)));
            std::iter::once(Push::of(preload)).chain(forces).collect()
        }
        (Carried::Points { .. }, Model::Cone { .. } | Model::Box { .. }) => Vec::new(),
    };
    parts.iter().fold((Push::ZERO, [0.0; 2]), |(sum, [force, torque]), part| {
        let sizes = part.sizes();
        (sum.plus(part), [force + sizes[0], torque + sizes[1]])
    })
}

/// By how much a contact force leaves its friction cone, in N; not above 0 inside.
fn slip(structure: &Structure, contact: usize, force: &Vec3) -> f64 {
    let data = &structure.contacts[contact];
    let (normal, force) = (Vector::exact(&data.normal).unit(), Vector::exact(force));
    let pressing = force.dot(&normal);
    let shear = force - normal.times(pressing);
    (shear.norm() - Interval::exact(data.friction) * pressing).upper.max(-pressing.lower)
}
