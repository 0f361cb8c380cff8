//! Proof that no connection strength helps: whole-body instability.
//!
//! With strength without bound a connection is rigid, so bodies joined by
//! connections move as one. The structure cannot stand exactly if these rigid
//! clusters have a motion that separates every contact, or lets it slip at more
//! than its friction angle, and in which the loads do positive work. The motion
//! is found by a cone program of its own (far smaller than the block's) and
//! checked here against the contacts.
//!
//! A connector that leaves some motion free whatever its strength (a limit of
//! 0, a frictionless or degenerate patch) does not join a cluster, it is a
//! constraint between two of them.

use crate::spatial::{Twist, Vec3};

use super::blocks::{Block, Link};
use super::clusters::{Clusters, Reduced};
use super::conic::{Attempt, solve};
use super::connector::{Connector, Model};
use super::interior_point::InteriorPoint;
use super::loads::BodyLoad;
use super::program::{Program, Purpose};
use super::reductions::Reductions;
use super::second_order::norm;
use super::structure::Structure;
use super::tolerances::DATA;

/// Largest force, as a multiple of the loads, that could still save a structure
/// whose mechanism violates a contact by rounding.
const FORCE_MULTIPLE: f64 = 1e10;

/// Bodies for every rigid cluster from which on looking for a mechanism is quick.
const QUICK: usize = 4;

/// Share of the loads that is left unheld: 1 where the block collapses and 0 where it
/// can be held. From here on it is worth looking at the motion.
const UNHELD: f64 = 0.5;

/// Share below which the method has found that the loads are held.
const HELD: f64 = 1e-6;

/// Iterations after which the block's own method gives up.
const ITERATIONS: usize = 40;

/// Insets with which it is asked for the mechanism, tried in turn.
const INSETS: [f64; 2] = [1e-4, 1e-8];

/// Ways of asking the general solver for it where that was not enough.
const ATTEMPTS: [Attempt; 4] = [
    Attempt { tolerance: 1e-9, inset: 1e-4, regularization: 1e-8 },
    Attempt { tolerance: 1e-10, inset: 1e-8, regularization: 1e-8 },
    Attempt { tolerance: 1e-10, inset: 0.0, regularization: 1e-8 },
    Attempt { tolerance: 1e-11, inset: 0.0, regularization: 1e-9 },
];

/// Whether looking for a mechanism costs next to nothing beside solving the block.
pub(super) fn is_quick(structure: &Structure, block: &Block) -> bool {
    QUICK * rigid_clusters(structure, block).count() <= block.bodies.len()
}

/// What any strength at all would let move as one.
fn rigid_clusters(structure: &Structure, block: &Block) -> Clusters {
    Clusters::new(structure, block, |_, link| match link {
        Link::Connection(i) => structure.connectors[structure.connections[i].connector].model.is_rigid(),
        Link::Contact(_) => false,
    })
}

/// A mechanism (a twist per body of the block, at its centre of mass, in W) that
/// proves that no strength lets the block stand; `None` when none was found.
pub(super) fn find(structure: &Structure, block: &Block, loads: &[BodyLoad]) -> Option<Vec<Twist>> {
    let clusters = rigid_clusters(structure, block);
    let mut reduced = clusters.reduce(structure, block, loads)?;
    for connector in &mut reduced.structure.connectors {
        unbound(&mut connector.model);
    }
    let program = Program::new(&reduced.structure, &reduced.block, &reduced.loads, Purpose::Support);
    let spread = |twists: Vec<Twist>| clusters.spread(structure, block, &reduced, &twists);
    for inset in INSETS {
        if let Some(twists) = quickly(&reduced, &program, inset) {
            return Some(spread(twists));
        }
    }
    for attempt in &ATTEMPTS {
        let Some(iterate) = solve(&program, attempt) else { continue };
        if !(iterate.t > UNHELD) {
            continue;
        }
        let twists = program.twists(&iterate.v);
        if proves(&reduced, &program, &twists) {
            return Some(spread(twists));
        }
    }
    None
}

/// Asks the block's own method until its motion proves that the loads are not held.
fn quickly(reduced: &Reduced, program: &Program, inset: f64) -> Option<Vec<Twist>> {
    let mut method = InteriorPoint::new(program, inset, 1.0, Reductions::ALL);
    for _ in 0..ITERATIONS {
        let estimate = method.estimate();
        if estimate.lower > UNHELD {
            let twists = program.twists(&method.iterate().v);
            if proves(reduced, program, &twists) {
                return Some(twists);
            }
        }
        if estimate.upper < HELD || !method.step() {
            break;
        }
    }
    None
}

/// Whether a mechanism of the clusters does positive work without any contact
/// resisting it.
fn proves(reduced: &Reduced, program: &Program, twists: &[Twist]) -> bool {
    let Reduced { structure, block, loads, .. } = reduced;
    let (mut power, mut size) = (0.0, 0.0);
    for (twist, load) in twists.iter().zip(loads) {
        power += twist.power(&load.wrench);
        size += twist.linear.abs().dot(&load.force_size) + twist.angular.abs().dot(&load.torque_size);
    }
    if !(power > DATA * size) {
        return false;
    }
    // Not the link's own force: what flows through a body without weight is tiny,
    // what it could hold is not.
    let negligible = power / (FORCE_MULTIPLE * program.scales.force.iter().copied().fold(0.0, f64::max));
    block.links.iter().zip(&program.frames).all(|(&link, frame)| {
        let relative = frame.relative_twist(structure, |body| twists[body]);
        let v = relative.linear;
        match link {
            Link::Contact(i) => v.z - structure.contacts[i].friction * v.xy().norm() >= -negligible,
            Link::Connection(i) => {
                let connector = &structure.connectors[structure.connections[i].connector];
                resisted(connector, &relative) <= negligible
            }
        }
    })
}

/// How far a relative twist is from being free of any resistance, in m/s.
fn resisted(connector: &Connector, relative: &Twist) -> f64 {
    let Twist { linear: v, angular: w } = relative;
    match &connector.model {
        Model::Cone { .. } => norm(&[v.x, v.y, v.z, w.x, w.y, w.z]),
        Model::Box { shear, tension, compression, bending, torsion } => {
            let held = |limit: f64, velocity: f64| if limit > 0.0 { velocity.abs() } else { 0.0 };
            let normal = if v.z > 0.0 { held(*tension, v.z) } else { held(*compression, v.z) };
            let sideways = held(shear[0], v.x) + held(shear[1], v.y);
            sideways + normal + held(bending[0], w.x) + held(bending[1], w.y) + held(*torsion, w.z)
        }
        Model::Patch { friction, points } => {
            let closing = points.iter().map(|p| {
                let at = relative.at(&Vec3::new(p[0], p[1], 0.0));
                friction * at.xy().norm() - at.z
            });
            closing.fold(v.z.abs(), f64::max)
        }
    }
}

/// Lifts every limit of a model that strength lifts.
fn unbound(model: &mut Model) {
    if let Model::Box { shear, tension, compression, bending, torsion } = model {
        for limit in shear.iter_mut().chain([tension, compression]).chain(bending).chain([torsion]) {
            if *limit > 0.0 {
                *limit = f64::INFINITY;
            }
        }
    }
}
