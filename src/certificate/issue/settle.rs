//! Makes parts without a connection to the ground balance, by what they stand on.
//!
//! A part is a tree of the checker's forest. What its root lacks is taken up by the
//! contacts and the weak connections that lead nearer to the ground, by the smallest
//! change relative to what they carry; what that does to the parts there is taken up
//! in their turn.

use nalgebra::{DMatrix, Vector6};

use crate::spatial::{Vec3, Wrench};
use crate::statics::{Anchor, Connection, Structure};

use super::super::balance::movable;
use super::super::forest::Branch;
use super::super::interval::{Interval, Vector};
use super::super::models::{Push, limits};

/// Most iterations of a singular value decomposition of six rows; it needs about ten.
const SWEEPS: usize = 200;

/// Relative size of what is left of a direction in which a part is not held at all.
const UNHELD: f64 = 1e-15;

/// What may be changed.
pub(super) struct Forces<'f> {
    /// By connection, on the child in its frame.
    pub wrenches: &'f mut [Wrench],
    /// By contact, on its body in W.
    pub contacts: &'f mut [Vec3],
}

/// Takes up `left`, what the roots of `forest` lack. What carries nothing changes as if
/// it carried `floor` of the most that anything around its part does.
pub(super) fn settle(
    structure: &Structure,
    forest: &[Branch],
    left: &[(usize, Push)],
    floor: f64,
    forces: &mut Forces<'_>,
) {
    if left.is_empty() {
        return;
    }
    let parts = Parts::new(structure, forest, left, forces);
    let mut lacking: Vec<Wrench> = left.iter().map(|(_, push)| middle(push)).collect();
    let mut done = vec![false; left.len()];
    for part in parts.farthest_first() {
        let held = parts.around[part].iter().filter(|hold| hold.other.is_none_or(|other| !done[other]));
        let held: Vec<&Hold> = held.collect();
        if let Some(changes) = changes(&lacking[part], &held, floor) {
            for (hold, change) in held.iter().zip(changes) {
                hold.component.add(change, forces);
                lacking[part] += hold.effect * change;
                if let Some(other) = hold.other {
                    lacking[other] += hold.effect.moved(&(parts.coms[part] - parts.coms[other])) * -change;
                }
            }
        }
        done[part] = true;
    }
}

/// A wrench within the intervals, near their middles.
pub(super) fn middle(push: &Push) -> Wrench {
    let within = |x: Interval| x.lower / 2.0 + x.upper / 2.0;
    let vector = |v: &Vector| Vec3::new(within(v.x), within(v.y), within(v.z));
    Wrench::new(vector(&push.force), vector(&push.torque))
}

/// One component of what a contact or connection carries, as a part feels it.
struct Hold {
    component: Component,
    /// The part on the other side; `None` for the ground.
    other: Option<usize>,
    /// What a unit of it does to the part, about its root's centre of mass in W.
    effect: Wrench,
    /// How much of it there is, or may be without slipping.
    amount: f64,
}

#[derive(Clone, Copy)]
enum Component {
    /// Of a connection's wrench, in its frame.
    Connection(usize, usize),
    /// Of a contact's force, along a direction in W.
    Contact(usize, Vec3),
}

impl Component {
    fn add(self, change: f64, forces: &mut Forces<'_>) {
        match self {
            Self::Contact(index, along) => forces.contacts[index] += along * change,
            Self::Connection(index, k) if k < 3 => forces.wrenches[index].force[k] += change,
            Self::Connection(index, k) => forces.wrenches[index].torque[k - 3] += change,
        }
    }
}

/// Changes of what holds a part, smallest relative to what they change, that take away
/// what it lacks; `None` where nothing holds it.
fn changes(lacking: &Wrench, held: &[&Hold], floor: f64) -> Option<Vec<f64>> {
    let reach = |effect: &Wrench| effect.torque.norm() / effect.force.norm();
    let lever = held.iter().map(|hold| reach(&hold.effect)).filter(|x| x.is_finite()).fold(0.0, f64::max);
    let lever = if lever > 0.0 { lever } else { 1.0 };
    let scaled = |w: &Wrench| {
        let torque = w.torque / lever;
        Vector6::new(w.force.x, w.force.y, w.force.z, torque.x, torque.y, torque.z)
    };
    let effects: Vec<Vector6<f64>> = held.iter().map(|hold| scaled(&hold.effect)).collect();
    let amounts: Vec<f64> = held.iter().zip(&effects).map(|(hold, e)| hold.amount * e.norm()).collect();
    let most = amounts.iter().copied().fold(0.0, f64::max);
    let wanted = -scaled(lacking);
    if !(most > 0.0 && most < f64::INFINITY && wanted.iter().all(|x| x.is_finite())) {
        return None;
    }
    let weights: Vec<f64> = amounts
        .iter()
        .zip(&effects)
        .map(|(amount, e)| (amount / most + floor) / e.norm().max(f64::MIN_POSITIVE))
        .collect();
    // Of a least-squares problem, not of its squares: a part may stand on a needle's point.
    let rows = DMatrix::from_fn(held.len(), 6, |i, k| effects[i][k] * weights[i]);
    let (q, r) = rows.qr().unpack();
    let factors = r.transpose().try_svd(true, true, f64::EPSILON, SWEEPS)?;
    let held_at_all = UNHELD * factors.singular_values.amax();
    let pull = q * factors.solve(&wanted, held_at_all).ok()?;
    let found: Vec<f64> = pull.iter().zip(&weights).map(|(pull, weight)| pull * weight).collect();
    found.iter().all(|x| x.is_finite()).then_some(found)
}

/// The trees of a forest that do not stand on the ground, and what is around them.
struct Parts {
    /// Centre of mass of each root.
    coms: Vec<Vec3>,
    around: Vec<Vec<Hold>>,
}

impl Parts {
    fn new(structure: &Structure, forest: &[Branch], left: &[(usize, Push)], forces: &Forces<'_>) -> Self {
        let mut part: Vec<Option<usize>> = vec![None; structure.bodies.len()];
        for (index, (root, _)) in left.iter().enumerate() {
            part[*root] = Some(index);
        }
        for &(body, holder) in forest {
            if let Some((_, behind)) = holder {
                part[body] = behind.and_then(|behind| part[behind]);
            }
        }
        let part = |anchor: Anchor| movable(structure, anchor).and_then(|body| part[body]);
        let coms: Vec<Vec3> = left.iter().map(|(root, _)| structure.bodies[*root].com).collect();
        let mut around: Vec<Vec<Hold>> = coms.iter().map(|_| Vec::new()).collect();
        let mut join = |[a, b]: [Option<usize>; 2], at: &Vec3, component: Component, unit: &Wrench, amount: f64| {
            for (here, other, sign) in [(a, b, 1.0), (b, a, -1.0)].into_iter().filter(|_| a != b) {
                if let Some(here) = here {
                    let effect = unit.moved(&(at - coms[here])) * sign;
                    around[here].push(Hold { component, other, effect, amount });
                }
            }
        };
        for (index, contact) in structure.contacts.iter().enumerate() {
            let ends = [part(Anchor::Body(contact.body)), part(contact.against)];
            let normal = contact.normal.normalize();
            let x = if normal.x.abs() < 0.6 { Vec3::x() } else { Vec3::y() }.cross(&normal).normalize();
            let pressing = forces.contacts[index].dot(&normal).abs();
            let grip = pressing * contact.friction.min(1.0);
            let directions = [(normal, pressing), (x, grip), (normal.cross(&x), grip)];
            for (along, amount) in directions.into_iter().take(if contact.friction > 0.0 { 3 } else { 1 }) {
                let unit = Wrench::new(along, Vec3::zeros());
                join(ends, &contact.position, Component::Contact(index, along), &unit, amount);
            }
        }
        for (index, connection) in structure.connections.iter().enumerate() {
            let ends = [part(connection.child), part(connection.parent)];
            let Wrench { force, torque } = &forces.wrenches[index];
            for (k, unit) in units(structure, connection) {
                let amount = if k < 3 { force[k] } else { torque[k - 3] }.abs();
                join(ends, &connection.frame.translation.vector, Component::Connection(index, k), &unit, amount);
            }
        }
        Self { coms, around }
    }

    /// Every part before those that are between it and the ground.
    fn farthest_first(&self) -> Vec<usize> {
        let grounded = |part: &usize| self.around[*part].iter().any(|hold| hold.other.is_none());
        let mut order: Vec<usize> = (0..self.around.len()).filter(grounded).collect();
        let mut reached = vec![false; self.around.len()];
        order.iter().for_each(|&part| reached[part] = true);
        let mut next = 0;
        while next < order.len() {
            for other in self.around[order[next]].iter().filter_map(|hold| hold.other) {
                if !std::mem::replace(&mut reached[other], true) {
                    order.push(other);
                }
            }
            next += 1;
        }
        order.reverse();
        order
    }
}

/// What units of a connection's components are in W, of those that it can carry.
fn units(structure: &Structure, connection: &Connection) -> impl Iterator<Item = (usize, Wrench)> {
    let limits = limits(&structure.connectors[connection.connector].model);
    let rotation = connection.frame.rotation;
    (0..6).filter(move |k| limits[*k] != [0.0; 2]).map(move |k| {
        let axis = rotation * Vec3::ith(k % 3, 1.0);
        let zero = Vec3::zeros();
        (k, if k < 3 { Wrench::new(axis, zero) } else { Wrench::new(zero, axis) })
    })
}
