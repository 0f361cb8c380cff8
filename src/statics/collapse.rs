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

use super::blocks::{Block, Link, Vertex};
use super::clusters::{Clusters, Reduced};
use super::conic::{Attempt, solve};
use super::connector::{Connector, Model};
use super::frame::LinkFrame;
use super::interior_point::InteriorPoint;
use super::loads::BodyLoad;
use super::program::{Program, Purpose};
use super::reductions::Reductions;
use super::second_order::norm;
use super::structure::Structure;
use super::tolerances::{DATA, ROUNDING};

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

/// Whether there may be a mechanism, and looking for it costs next to nothing beside solving the block.
pub(super) fn is_quick(structure: &Structure, block: &Block) -> bool {
    let clusters = rigid_clusters(structure, block).count();
    clusters > 0 && QUICK * clusters <= block.bodies.len()
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
/// resisting it, both beyond what rounding of the data leaves open.
fn proves(reduced: &Reduced, program: &Program, twists: &[Twist]) -> bool {
    let Reduced { structure, block, loads, .. } = reduced;
    let (mut power, mut size) = (0.0, 0.0);
    for (twist, load) in twists.iter().zip(loads) {
        power += twist.power(&load.wrench);
        // Directions are data too: a fast motion across the loads does no work for sure.
        size += twist.linear.norm() * load.force_size.norm() + twist.angular.norm() * load.torque_size.norm();
    }
    if !(power > DATA * size) {
        return false;
    }
    // Not the link's own force: what flows through a body without weight is tiny,
    // what it could hold is not.
    let negligible = power / (FORCE_MULTIPLE * program.scales.force.iter().copied().fold(0.0, f64::max));
    block.links.iter().zip(&program.frames).all(|(&link, frame)| {
        let relative = frame.relative_twist(structure, |body| twists[body]);
        let resisting = match link {
            Link::Contact(i) => {
                let v = relative.linear;
                structure.contacts[i].friction * v.xy().norm() - v.z
            }
            Link::Connection(i) => resisted(&structure.connectors[structure.connections[i].connector], &relative),
        };
        resisting + rounding(structure, frame, twists) <= negligible
    })
}

/// Rounding of what a link resists of the twists of its ends, in m/s.
fn rounding(structure: &Structure, frame: &LinkFrame, twists: &[Twist]) -> f64 {
    let ends = frame.sides().into_iter().filter_map(|(side, _)| match side {
        Vertex::Body(i) => Some((&twists[i], frame.origin - structure.bodies[i].com)),
        Vertex::Ground => None,
    });
    ROUNDING * ends.map(|(twist, arm)| twist.linear.norm() + twist.angular.norm() * arm.norm()).sum::<f64>()
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spatial::{Pose, Rotation};
    use crate::statics::loads::own_loads;
    use crate::statics::structure::{Anchor, Body, Connection, Contact};

    /// A pile of cubes on each other, joined by magnets, the lowest on four contacts, on
    /// a ground that is inclined by the tangent `slope`.
    fn pile(count: usize, friction: f64, slope: f64) -> Structure {
        let mut pile = Structure { gravity: Vec3::new(slope, 0.0, -1.0).normalize() * 9.81, ..Structure::default() };
        let model = Model::Cone { friction: [0.5; 2], radius: [0.03; 3] };
        pile.connectors.push(Connector { name: "magnet".to_owned(), strength: 1e-3, model });
        for i in 0..count {
            pile.bodies.push(Body { mass: 0.3, com: Vec3::z() * (0.02 + 0.04 * i as f64), fixed: false });
            if i > 0 {
                let frame = Pose::from_parts((Vec3::z() * (0.04 * i as f64)).into(), Rotation::identity());
                let (parent, child) = (Anchor::Body(i - 1), Anchor::Body(i));
                pile.connections.push(Connection { parent, child, connector: 0, frame });
            }
        }
        for [x, y] in [[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]] {
            let (against, position, normal) = (Anchor::World, Vec3::new(x, y, 0.0), Vec3::z());
            pile.contacts.push(Contact { body: 0, against, position, normal, friction });
        }
        pile
    }

    /// A body on two rails along x that hold it in every other direction, however weak.
    fn on_rails(gravity: Vec3) -> Structure {
        let mut sled = Structure { gravity, ..Structure::default() };
        let model =
            Model::Box { shear: [0.0, 1e-3], tension: 1e-3, compression: 1e-3, bending: [1e-3; 2], torsion: 1e-3 };
        sled.connectors.push(Connector { name: "rail".to_owned(), strength: 1e-3, model });
        sled.bodies.push(Body { mass: 1.0, com: Vec3::new(0.02, 0.01, 0.1), fixed: false });
        for y in [-0.1, 0.1] {
            let frame = Pose::from_parts(Vec3::new(0.0, y, 0.0).into(), Rotation::identity());
            sled.connections.push(Connection { parent: Anchor::World, child: Anchor::Body(0), connector: 0, frame });
        }
        sled
    }

    /// The mechanism that is found for the whole as one block, by body.
    fn collapse(structure: &Structure) -> Option<Vec<Twist>> {
        let links = (0..structure.connections.len()).map(Link::Connection);
        let links = links.chain((0..structure.contacts.len()).map(Link::Contact)).collect();
        let block = Block { root: Vertex::Ground, bodies: (0..structure.bodies.len()).collect(), links };
        let twists = find(structure, &block, &own_loads(structure))?;
        lawful(structure, &twists);
        Some(twists)
    }

    /// Whether the loads work, no contact resists and no connector but along what it leaves free.
    fn lawful(structure: &Structure, twists: &[Twist]) {
        let loads = own_loads(structure);
        let power: f64 = twists.iter().zip(&loads).map(|(twist, load)| twist.power(&load.wrench)).sum();
        assert!(power > 0.0, "{power}");
        let speed = twists.iter().map(|twist| twist.linear.norm()).fold(0.0, f64::max);
        let relative = |link| LinkFrame::new(structure, link).relative_twist(structure, |body| twists[body]);
        for (i, contact) in structure.contacts.iter().enumerate() {
            let v = relative(Link::Contact(i)).linear;
            assert!(v.z - contact.friction * v.xy().norm() >= -1e-9 * speed, "contact {i}: {v}");
        }
        for (i, connection) in structure.connections.iter().enumerate() {
            let Twist { linear: mut v, angular: w } = relative(Link::Connection(i));
            if let Model::Box { shear: [0.0, _], .. } = structure.connectors[connection.connector].model {
                v.x = 0.0;
            }
            assert!(v.norm() <= 1e-9 * speed && w.norm() <= 1e-8 * speed, "connection {i}: {v} {w}");
        }
    }

    #[test]
    fn a_pile_slides_where_the_ground_is_steeper_than_friction() {
        for count in [1, 3] {
            for friction in [0.0, 1e-3, 0.2, 0.5] {
                for over in [1e-4, 1e-2, 0.3] {
                    let slides = collapse(&pile(count, friction, friction + over));
                    let downhill = slides.expect("nothing holds it")[0].linear;
                    assert!(downhill.x > 0.0, "{downhill}");
                    let held = collapse(&pile(count, friction, (friction - over).max(0.0)));
                    assert!(held.is_none(), "{friction} {over}: {held:?}");
                }
            }
        }
    }

    /// Its centre of mass is at 0.02 m for every cube, its feet 0.1 m from the middle.
    #[test]
    fn a_pile_tips_where_its_weight_leaves_the_feet() {
        for (count, friction) in [(4, 10.0), (8, 1e3)] {
            let limit = 0.1 / (0.02 * count as f64);
            let tips = collapse(&pile(count, friction, limit * 1.01)).expect("it tips");
            assert!(tips.iter().all(|twist| twist.angular.y > 0.0), "{tips:?}");
            assert!(collapse(&pile(count, friction, limit * 0.99)).is_none());
        }
    }

    /// However weak, what holds is held with strength without bound; along the rails nothing holds.
    #[test]
    fn only_what_no_strength_holds_collapses() {
        let slides = collapse(&on_rails(Vec3::new(-1.0, 3.0, -9.0))).expect("nothing holds it along x");
        assert!(slides[0].linear.x < 0.0 && slides[0].angular.norm() <= 1e-8 * slides[0].linear.norm());
        assert!(collapse(&on_rails(Vec3::new(0.0, 3.0, -9.0))).is_none());
    }
}
