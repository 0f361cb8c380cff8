//! The bound from above: forces that balance, within all friction cones, prove that
//! their largest demand suffices.

use std::collections::BinaryHeap;

use crate::spatial::Vec3;
use crate::statics::{Anchor, Model, Structure};

use super::check::Fault;
use super::interval::{Axes, Interval, Vector};
use super::models::{Allowance, Push, demand, holding};
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
        let push = Push { force: weight, torque: Vector::ZERO };
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
        let push = Push { force: Vector::exact(force), torque: Vector::ZERO };
        act(Anchor::Body(contact.body), &push, &contact.position, push.sizes());
        act(contact.against, &push.negative(), &contact.position, push.sizes());
    }
    sums
}

fn arm(structure: &Structure, body: usize, at: &Vec3) -> Vector {
    Vector::exact(at) - Vector::exact(&structure.bodies[body].com)
}

/// The wrench on the child that a connection carries, in the connection frame, and the
/// sizes of the forces and torques that it is the sum of.
fn wrench(model: &Model, carried: &Carried) -> (Push, [f64; 2]) {
    let parts = match (carried, model) {
        (Carried::Wrench(wrench), _) => {
            vec![Push { force: Vector::exact(&wrench.force), torque: Vector::exact(&wrench.torque) }]
        }
        (Carried::Points { preload, forces }, Model::Patch { points, .. }) => {
            let preload = Vector { z: Interval::exact(-preload), ..Vector::ZERO };
            let at = |p: &[f64; 2]| Vector { x: Interval::exact(p[0]), y: Interval::exact(p[1]), z: Interval::ZERO };
            let forces = forces.iter().map(|force| Push { force: Vector::exact(force), torque: Vector::ZERO });
            let forces = forces.zip(points).map(|(push, point)| push.moved(&at(point)));
            std::iter::once(Push { force: preload, torque: Vector::ZERO }).chain(forces).collect()
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

/// For each body, the loads on all that it is linked with other than through the
/// ground: their sum in N, and the most that they can turn a body by, in N m. What is
/// forgiven is judged by these and not by the certificate's own forces, which could
/// be as large as one likes where a structure can be clamped.
fn loads(structure: &Structure) -> Vec<(f64, f64)> {
    let mut links = vec![Vec::new(); structure.bodies.len()];
    let mut points: Vec<Vec<Vec3>> = structure.bodies.iter().map(|body| vec![body.com]).collect();
    let mut join = |a: Anchor, b: Anchor, at: &Vec3| {
        let ends = [movable(structure, a), movable(structure, b)];
        for body in ends.into_iter().flatten() {
            points[body].push(*at);
        }
        if let [Some(a), Some(b)] = ends {
            links[a].push(b);
            links[b].push(a);
        }
    };
    for connection in &structure.connections {
        join(connection.parent, connection.child, &connection.frame.translation.vector);
    }
    for contact in &structure.contacts {
        join(Anchor::Body(contact.body), contact.against, &contact.position);
    }
    let mut own: Vec<(f64, f64)> =
        structure.bodies.iter().map(|body| (body.mass * structure.gravity.norm(), 0.0)).collect();
    for load in &structure.loads {
        own[load.body].0 += load.force.norm();
        own[load.body].1 += load.torque.norm();
        points[load.body].extend(load.at);
    }
    let mut found: Vec<Option<(f64, f64)>> = vec![None; structure.bodies.len()];
    for body in 0..structure.bodies.len() {
        if found[body].is_some() {
            continue;
        }
        found[body] = Some((0.0, 0.0));
        let mut part = vec![body];
        let (mut force, mut torque, mut low, mut high) = (0.0, 0.0, points[body][0], points[body][0]);
        let mut next = 0;
        while next < part.len() {
            let here = part[next];
            next += 1;
            force += own[here].0;
            torque += own[here].1;
            for point in &points[here] {
                (low, high) = (low.inf(point), high.sup(point));
            }
            for &other in &links[here] {
                if found[other].is_none() {
                    found[other] = Some((0.0, 0.0));
                    part.push(other);
                }
            }
        }
        for here in part {
            found[here] = Some((force, torque + force * (high - low).norm()));
        }
    }
    found.into_iter().map(|loads| loads.unwrap_or_default()).collect()
}

/// A body, and the connection that holds it with the body behind that one; both
/// `None` where no connection leads on to the ground, and the latter at the ground.
pub(super) type Branch = (usize, Option<(usize, Option<usize>)>);

/// A forest of connections that can carry any wrench, each body after the one that
/// holds it: strong connections first, since what they carry on top costs least.
/// Any forest would make a proof.
pub(super) fn forest(structure: &Structure) -> Vec<Branch> {
    let mut links = vec![Vec::new(); structure.bodies.len() + 1];
    let ground = structure.bodies.len();
    for (index, connection) in structure.connections.iter().enumerate() {
        let ends = [connection.parent, connection.child].map(|end| movable(structure, end).unwrap_or(ground));
        if let Some(holding) = holding(&structure.connectors[connection.connector])
            && ends[0] != ends[1]
        {
            // The bits of positive numbers are in their order.
            links[ends[0]].push((holding.to_bits(), index, ends[1]));
            links[ends[1]].push((holding.to_bits(), index, ends[0]));
        }
    }
    let mut branches = Vec::with_capacity(structure.bodies.len());
    let mut reached = vec![false; structure.bodies.len() + 1];
    // Where the ground is not reached the heaviest body is the root: what rounding leaves
    // on it need not be carried by what carries less.
    let mut roots: Vec<usize> = (0..structure.bodies.len()).collect();
    roots.sort_by(|a, b| structure.bodies[*b].mass.total_cmp(&structure.bodies[*a].mass));
    for root in std::iter::once(ground).chain(roots) {
        if reached[root] || (root != ground && structure.bodies[root].fixed) {
            continue;
        }
        reached[root] = true;
        if root != ground {
            branches.push((root, None));
        }
        let mut waiting: BinaryHeap<_> = links[root].iter().map(|&(h, index, to)| (h, index, root, to)).collect();
        while let Some((_, index, from, body)) = waiting.pop() {
            if !reached[body] {
                reached[body] = true;
                branches.push((body, Some((index, (from != ground).then_some(from)))));
                waiting.extend(links[body].iter().map(|&(h, index, to)| (h, index, body, to)));
            }
        }
    }
    branches
}

/// Carries what every body lacks along the forest: the wrench that each connection has
/// to carry on top, on its child in its frame, and what is left at the forest's roots
/// that are not the ground.
pub(super) fn carry(structure: &Structure, forest: &[Branch], sums: &[Sum]) -> (Vec<Push>, Vec<(usize, Push)>) {
    let mut surplus: Vec<Push> = sums.iter().map(|sum| sum.surplus).collect();
    let mut rest = vec![Push::ZERO; structure.connections.len()];
    let mut left = Vec::new();
    for &(body, holder) in forest.iter().rev() {
        let Some((index, behind)) = holder else {
            left.push((body, surplus[body]));
            continue;
        };
        let connection = &structure.connections[index];
        let at = &connection.frame.translation.vector;
        let here = surplus[body].moved(&-arm(structure, body, at));
        if let Some(behind) = behind {
            surplus[behind] = surplus[behind].plus(&here.moved(&arm(structure, behind, at)));
        }
        let axes = Axes::of(&connection.frame.rotation);
        let local = Push { force: axes.to_local(&here.force), torque: axes.to_local(&here.torque) };
        // The connection takes the surplus away from the body.
        rest[index] = if connection.child == Anchor::Body(body) { local.negative() } else { local };
    }
    (rest, left)
}
