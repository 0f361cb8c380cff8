//! The bound from below: a motion in which the loads work faster than the
//! connections can dissipate proves that their strengths do not suffice.

use crate::spatial::Vec3;
use crate::statics::{Anchor, Structure};

use super::allowance::Allowance;
use super::balance::movable;
use super::check::Fault;
use super::interval::{Axes, Interval, Vector};
use super::models::{Motion, dissipation, free, opens};
use super::{DATA, Mechanism};

/// What a mechanism proves: a lower bound on the utilisation, 0 when its loads do no
/// provable work. With `collapse` it is to prove that no strength suffices: then
/// nothing may resist it, and the bound is infinite.
///
/// # Errors
/// Every contact and connection that resists without limit, or at all for a collapse.
pub(super) fn lower_bound(
    structure: &Structure,
    mechanism: &Mechanism,
    collapse: bool,
    allowance: &mut Allowance,
) -> Result<f64, Vec<Fault>> {
    let mut faults = Vec::new();
    for (body, twist) in mechanism.twists.iter().enumerate() {
        if structure.bodies[body].fixed && twist.linear.iter().chain(&twist.angular).any(|x| *x != 0.0) {
            faults.push(Fault::Body { body, problem: "is fixed, but moves".to_owned() });
        }
    }
    for (contact, data) in structure.contacts.iter().enumerate() {
        let pair = [Anchor::Body(data.body), data.against];
        let Some(motion) = relative(structure, mechanism, pair, &data.position) else { continue };
        let normal = Vector::exact(&data.normal).unit();
        let opening = motion.linear.dot(&normal);
        let sliding = (motion.linear - normal.times(opening)).norm();
        if let Err(problem) = opens(opening, Interval::exact(data.friction) * sliding) {
            faults.push(Fault::Contact { contact, problem });
        }
    }
    let mut dissipated = Interval::ZERO;
    for (connection, data) in structure.connections.iter().enumerate() {
        let pair = [data.child, data.parent];
        let Some(motion) = relative(structure, mechanism, pair, &data.frame.translation.vector) else { continue };
        let axes = Axes::of(&data.frame.rotation);
        let motion =
            Motion { linear: axes.to_local(&motion.linear), angular: axes.to_local(&motion.angular), ..motion };
        let connector = &structure.connectors[data.connector];
        let resisted = match collapse {
            true => free(connector, &motion, allowance).map(|()| 0.0),
            false => dissipation(connector, &motion, allowance),
        };
        match resisted {
            Ok(power) => dissipated = dissipated + Interval::exact(power),
            Err(problem) => faults.push(Fault::Connection { connection, problem }),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let (power, size) = power(structure, mechanism);
    if collapse {
        return Ok(if power.lower > DATA * size { f64::INFINITY } else { 0.0 });
    }
    Ok(if power.lower > 0.0 { (power / dissipated).lower.max(0.0) } else { 0.0 })
}

/// Motion at a point of the first of two anchors against the second, in W; `None` when
/// they move as one, exactly.
fn relative(structure: &Structure, mechanism: &Mechanism, pair: [Anchor; 2], at: &Vec3) -> Option<Motion> {
    let [first, second] = pair.map(|anchor| movable(structure, anchor));
    let twist = |body: Option<usize>| {
        let parts = body.map(|body| &mechanism.twists[body]);
        let zero = Vec3::zeros();
        let (linear, angular) = parts.map_or((&zero, &zero), |twist| (&twist.linear, &twist.angular));
        (Vector::exact(linear), Vector::exact(angular))
    };
    let (a, b) = (twist(first), twist(second));
    if a == b {
        return None;
    }
    let (linear, angular) = (a.0 - b.0, a.1 - b.1);
    let lever = Vector::exact(at) - Vector::exact(&mechanism.about);
    let linear = linear + angular.cross(&lever);
    let reach = [first, second].into_iter().flatten().map(|body| (at - structure.bodies[body].com).norm());
    let reach = reach.fold(0.0, f64::max);
    // As felt anywhere on the bodies.
    let speed = linear.norm().upper + angular.norm().upper * reach;
    Some(Motion { linear, angular, speed: [speed, if reach > 0.0 { speed / reach } else { angular.norm().upper }] })
}

/// Power in W of gravity and the loads, and the size of its terms.
fn power(structure: &Structure, mechanism: &Mechanism) -> (Interval, f64) {
    let (mut power, mut size) = (Interval::ZERO, 0.0);
    let mut add = |body: usize, force: &Vector, torque: &Vector, at: &Vec3| {
        if movable(structure, Anchor::Body(body)).is_some() {
            let twist = &mechanism.twists[body];
            let (linear, angular) = (Vector::exact(&twist.linear), Vector::exact(&twist.angular));
            let lever = Vector::exact(at) - Vector::exact(&mechanism.about);
            let velocity = linear + angular.cross(&lever);
            power = power + force.dot(&velocity) + torque.dot(&angular);
            size += force.norm().upper * velocity.norm().upper + torque.norm().upper * angular.norm().upper;
        }
    };
    for (body, data) in structure.bodies.iter().enumerate() {
        let weight = Vector::exact(&structure.gravity).times(Interval::exact(data.mass));
        add(body, &weight, &Vector::ZERO, &data.com);
    }
    for load in &structure.loads {
        let at = load.at.unwrap_or(structure.bodies[load.body].com);
        add(load.body, &Vector::exact(&load.force), &Vector::exact(&load.torque), &at);
    }
    (power, size)
}
