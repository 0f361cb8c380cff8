//! What is left out of a structure, and what remains to be optimised.
//!
//! Counted on the very pieces and programs that are solved, but solves nothing:
//! an answer does not pay for its explanation.

use super::assess::pieces;
use super::blocks::{Block, Link};
use super::loads::{BodyLoad, lump, own_loads};
use super::network::Network;
use super::program::{Cone, Program, Purpose};
use super::reductions::Reductions;
use super::rigid_links::{Merged, unlimited};
use super::structure::Structure;
use super::validate::{InvalidStructure, validate};

/// What is left out of a structure, and what remains.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Explanation {
    /// Bodies that are fixed: they need no balance.
    pub fixed_bodies: usize,
    /// Bodies that unlimited connections hold to another one or to the ground: they move with it.
    pub merged_bodies: usize,
    /// Connections without any finite limit: what they carry follows from balance afterwards.
    pub unlimited_connections: usize,
    /// Other connections and contacts that join what cannot move against each other,
    /// and need carry nothing.
    pub idle_links: usize,
    /// Bodies that nothing leads to from the ground.
    pub afloat: usize,
    /// Connections whose wrench follows from balance alone.
    pub closed_form_connections: usize,
    /// Contacts whose force follows from balance alone.
    pub closed_form_contacts: usize,
    /// Blocks with cycles and nothing to hold, that need no solver either.
    pub unloaded_blocks: usize,
    /// The blocks that remain, each a cone program of its own.
    pub remaining: Vec<Remaining>,
}

/// A block that has to be optimised, and the size of its program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Remaining {
    /// Free bodies.
    pub bodies: usize,
    /// Connections.
    pub connections: usize,
    /// Contacts.
    pub contacts: usize,
    /// Chains of more than one connection that one wrench runs through.
    pub chains: usize,
    /// Bodies within those chains, whose balance is eliminated.
    pub bodies_in_chains: usize,
    /// Unknown wrenches and contact forces once chains are condensed.
    pub unknown_wrenches: usize,
    /// Equations of balance that are factorised: six for every body outside chains.
    pub equations: usize,
    /// Friction cones of contacts.
    pub friction_cones: usize,
    /// Second-order cones of connectors: one for a `cone`, one per point of a `patch`
    /// with friction.
    pub connector_cones: usize,
    /// Linear inequalities: limits of `box` connectors and frictionless points.
    pub inequalities: usize,
}

impl Remaining {
    /// Whether there is no second-order cone, so that the program is a linear one.
    pub fn is_linear(&self) -> bool {
        self.friction_cones + self.connector_cones == 0
    }
}

impl Explanation {
    /// Whether no second-order cone is left anywhere.
    pub fn is_linear(&self) -> bool {
        self.remaining.iter().all(Remaining::is_linear)
    }
}

/// Says what the oracle leaves out of `structure`, and what it has to optimise.
///
/// # Errors
/// As for [`assess`](super::assess).
pub fn explain(structure: &Structure, reductions: Reductions) -> Result<Explanation, Vec<InvalidStructure>> {
    validate(structure)?;
    let merged = if reductions.rigid_links { Merged::new(structure) } else { None };
    let mut explanation = Explanation {
        fixed_bodies: structure.bodies.iter().filter(|body| body.fixed).count(),
        ..Explanation::default()
    };
    if let Some(merged) = &merged {
        explanation.merged_bodies = merged.bodies_saved(structure);
        explanation.unlimited_connections = unlimited(structure).len();
    }
    let seen = merged.as_ref().map_or(structure, |merged| &merged.structure);
    let pieces = pieces(seen, reductions);
    let loads = lump(seen, &pieces.blocks, own_loads(seen));
    let links = seen.connections.len() + seen.contacts.len();
    let used: usize = pieces.blocks.iter().map(|block| block.links.len()).sum();
    explanation.idle_links = links - used - explanation.unlimited_connections;
    explanation.afloat = pieces.afloat.len();
    for block in &pieces.blocks {
        match (reductions.closed_form, &block.links[..]) {
            (true, [Link::Connection(_)]) => explanation.closed_form_connections += 1,
            (true, [Link::Contact(_)]) => explanation.closed_form_contacts += 1,
            _ if block.bodies.iter().all(|&body| loads[body].is_zero()) => explanation.unloaded_blocks += 1,
            _ => explanation.remaining.push(remaining(seen, block, &loads, reductions)),
        }
    }
    Ok(explanation)
}

fn remaining(structure: &Structure, block: &Block, loads: &[BodyLoad], reductions: Reductions) -> Remaining {
    let program = Program::new(structure, block, loads, Purpose::Utilisation);
    let network = Network::new(&program, reductions.chains);
    let connections = block.links.iter().filter(|link| matches!(link, Link::Connection(_))).count();
    let mut left = Remaining {
        bodies: block.bodies.len(),
        connections,
        contacts: block.links.len() - connections,
        chains: network.chains(),
        bodies_in_chains: block.bodies.len() - network.junctions(),
        unknown_wrenches: network.unknown_wrenches(),
        equations: 6 * network.junctions(),
        ..Remaining::default()
    };
    for group in &program.groups {
        match (group.cone, block.links[group.link]) {
            (Cone::Lorentz, Link::Contact(_)) => left.friction_cones += 1,
            (Cone::Lorentz, Link::Connection(_)) => left.connector_cones += 1,
            (Cone::NonNegative, _) => left.inequalities += group.len,
            (Cone::Free, _) => {}
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::super::connector::{Connector, Model};
    use super::super::structure::{Anchor, Body, Connection, Contact};
    use super::*;
    use crate::spatial::{Pose, Vec3};

    const NONE: f64 = f64::INFINITY;

    fn latch(limit: f64) -> Model {
        Model::Box { shear: [limit; 2], tension: limit, compression: NONE, bending: [limit; 2], torsion: limit }
    }

    /// A ring of six bodies through the world, one of them on a contact, a pendant
    /// on the third, and a seventh welded to the sixth.
    fn ring(model: Model) -> Structure {
        let mut structure = Structure { gravity: Vec3::new(0.0, 0.0, -10.0), ..Structure::default() };
        structure.connectors.push(Connector { name: "joint".to_owned(), strength: 1.0, model });
        structure.connectors.push(Connector { name: "weld".to_owned(), strength: 1.0, model: latch(NONE) });
        let at = |i: usize| Vec3::new(i as f64, (i * i) as f64 * 0.1, 1.0);
        for i in 0..8 {
            structure.bodies.push(Body { mass: 1.0, com: at(i), fixed: false });
        }
        let anchor = |i: usize| if i == 0 { Anchor::World } else { Anchor::Body(i - 1) };
        let joints = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 0), (3, 7)];
        for (connector, (a, b)) in joints.map(|pair| (0, pair)).into_iter().chain([(1, (6, 8))]) {
            structure.connections.push(Connection {
                parent: anchor(a),
                child: anchor(b),
                connector,
                frame: Pose::from_parts((at(b.max(1) - 1) - Vec3::x() * 0.5).into(), nalgebra::one()),
            });
        }
        structure.contacts.push(Contact {
            body: 3,
            against: Anchor::World,
            position: at(3) - Vec3::z(),
            normal: Vec3::z(),
            friction: 0.5,
        });
        structure
    }

    #[test]
    fn every_part_of_a_ring_is_counted() {
        let model = Model::Cone { friction: [0.5; 2], radius: [0.1; 3] };
        let found = explain(&ring(model), Reductions::ALL).expect("sound");
        assert_eq!((found.merged_bodies, found.unlimited_connections, found.closed_form_connections), (1, 1, 1));
        // World - 1 - 2 - 3 - 4 and 4 - 5 - 6 - world: chains on either side of the body that touches.
        let ring = Remaining {
            bodies: 6,
            connections: 7,
            contacts: 1,
            chains: 2,
            bodies_in_chains: 5,
            unknown_wrenches: 3,
            equations: 6,
            friction_cones: 1,
            connector_cones: 7,
            inequalities: 0,
        };
        assert_eq!(found.remaining, [ring]);
        assert!(!found.is_linear());
    }

    #[test]
    fn latches_without_friction_are_a_linear_program() {
        let mut structure = ring(latch(1.0));
        structure.contacts[0].friction = 0.0;
        let found = explain(&structure, Reductions::ALL).expect("sound");
        // Five components limited both ways and one only one way, and the point.
        assert_eq!(found.remaining[0].inequalities, 7 * 11 + 1);
        assert!(found.is_linear());
    }

    #[test]
    fn with_nothing_left_out_everything_remains() {
        let found = explain(&ring(latch(1.0)), Reductions::NONE).expect("sound");
        let left = &found.remaining[0];
        assert_eq!((found.remaining.len(), found.merged_bodies, found.closed_form_connections), (1, 0, 0));
        assert_eq!((left.bodies, left.unknown_wrenches, left.equations), (8, 10, 48));
    }

    #[test]
    fn without_gravity_nothing_remains() {
        let mut structure = ring(latch(1.0));
        structure.gravity = Vec3::zeros();
        let found = explain(&structure, Reductions::ALL).expect("sound");
        assert_eq!((found.unloaded_blocks, found.remaining.len()), (1, 0));
    }
}
