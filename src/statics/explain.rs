//! What is left out of a structure, and what remains to be optimised.
//!
//! Counted on the very pieces and programs that are solved, but solves nothing:
//! an answer does not pay for its explanation.

use super::assess::pieces;
use super::blocks::{Block, Link};
use super::groups::Cone;
use super::loads::{BodyLoad, lump, own_loads};
use super::network::Network;
use super::parts::{Part, parts};
use super::planar::{NotPlanar, Planar};
use super::program::{Program, Purpose};
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
    /// Equations of balance that are factorised: six for every body outside chains, or
    /// three for every body of a planar block.
    pub equations: usize,
    /// Why it is solved in space; `None` for a planar block.
    pub in_space: Option<InSpace>,
    /// Friction cones of contacts.
    pub friction_cones: usize,
    /// Second-order cones of connectors: one for a `cone`, one per point of a `patch`
    /// with friction.
    pub connector_cones: usize,
    /// Linear inequalities: limits of `box` connectors, frictionless points, and two for every
    /// point with friction, or mirrored pair of them, of a planar block.
    pub inequalities: usize,
}

/// Why a block is solved in space, with six balances per body, not in a plane.
///
/// A block is planar when a reflection maps it onto itself and every body onto itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InSpace {
    /// Planar blocks are to be solved like all others.
    NotAskedFor,
    /// It has long chains: condensing them leaves less.
    Chains,
    /// No plane holds all its centres of mass.
    Bodies,
    /// A load, or what its links are preloaded with, acts across the plane of its centres of mass.
    Loads,
    /// The connection with this index is askew, or beside the plane without another one opposite.
    Connection(usize),
    /// The contact with this index is askew, or beside the plane without another one opposite.
    Contact(usize),
}

impl InSpace {
    fn new(why: NotPlanar, block: &Block) -> Self {
        match why {
            NotPlanar::NotAskedFor => Self::NotAskedFor,
            NotPlanar::Chains => Self::Chains,
            NotPlanar::Bodies => Self::Bodies,
            NotPlanar::Loads => Self::Loads,
            NotPlanar::Link(link) => match block.links[link] {
                Link::Connection(i) => Self::Connection(i),
                Link::Contact(i) => Self::Contact(i),
            },
        }
    }
}

impl Remaining {
    /// Whether three balances per body are enough.
    pub fn is_planar(&self) -> bool {
        self.in_space.is_none()
    }

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
    let in_space = parts(&program);
    match Planar::new(&program, &in_space, reductions) {
        Ok(planar) => {
            left.equations = 3 * block.bodies.len();
            left.count_cones(&planar.parts, block);
        }
        Err(why) => {
            left.in_space = Some(InSpace::new(why, block));
            left.count_cones(&in_space, block);
        }
    }
    left
}

impl Remaining {
    fn count_cones<const D: usize>(&mut self, parts: &[Part<D>], block: &Block) {
        for part in parts {
            match (part.cone, block.links[part.link]) {
                (Cone::Free, _) => {}
                (Cone::NonNegative, _) => self.inequalities += part.len,
                // A wedge.
                (Cone::Lorentz, _) if part.len == 2 => self.inequalities += 2,
                (Cone::Lorentz, Link::Contact(_)) => self.friction_cones += 1,
                (Cone::Lorentz, Link::Connection(_)) => self.connector_cones += 1,
            }
        }
    }
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

    /// A ring of bodies through the world, one of them, in the middle, on a contact, a pendant
    /// on the one before it, and one more welded to the last. Not in a plane.
    fn ring(model: Model, bodies: usize) -> Structure {
        let mut structure = Structure { gravity: Vec3::new(0.0, 0.0, -10.0), ..Structure::default() };
        structure.connectors.push(Connector { name: "joint".to_owned(), strength: 1.0, model });
        structure.connectors.push(Connector { name: "weld".to_owned(), strength: 1.0, model: latch(NONE) });
        let at = |i: usize| Vec3::new(i as f64, (i * i) as f64 * 0.1, 1.0 + 0.01 * (i % 3) as f64);
        for i in 0..bodies + 2 {
            structure.bodies.push(Body { mass: 1.0, com: at(i), fixed: false });
        }
        let anchor = |i: usize| if i == 0 { Anchor::World } else { Anchor::Body(i - 1) };
        let middle = bodies / 2;
        let joints = (0..=bodies).map(|i| (i, (i + 1) % (bodies + 1))).chain([(middle, bodies + 1)]);
        for (connector, (a, b)) in joints.map(|pair| (0, pair)).chain([(1, (bodies, bodies + 2))]) {
            structure.connections.push(Connection {
                parent: anchor(a),
                child: anchor(b),
                connector,
                frame: Pose::from_parts((at(b.max(1) - 1) - Vec3::x() * 0.5).into(), nalgebra::one()),
            });
        }
        structure.contacts.push(Contact {
            body: middle,
            against: Anchor::World,
            position: at(middle) - Vec3::z(),
            normal: Vec3::z(),
            friction: 0.5,
        });
        structure
    }

    #[test]
    fn every_part_of_a_ring_is_counted() {
        let model = Model::Cone { friction: [0.5; 2], radius: [0.1; 3] };
        let found = explain(&ring(model.clone(), 20), Reductions::ALL).expect("sound");
        assert_eq!((found.merged_bodies, found.unlimited_connections, found.closed_form_connections), (1, 1, 1));
        // Chains of ten and of nine bodies on either side of the body that touches.
        let long = Remaining {
            bodies: 20,
            connections: 21,
            contacts: 1,
            chains: 2,
            bodies_in_chains: 19,
            unknown_wrenches: 3,
            equations: 6,
            in_space: Some(InSpace::Chains),
            friction_cones: 1,
            connector_cones: 21,
            inequalities: 0,
        };
        assert_eq!(found.remaining, [long]);
        assert!(!found.is_linear());
        // Short ones are not worth condensing.
        let found = explain(&ring(model, 6), Reductions::ALL).expect("sound");
        let short = Remaining {
            bodies: 6,
            connections: 7,
            contacts: 1,
            unknown_wrenches: 8,
            equations: 36,
            in_space: Some(InSpace::Bodies),
            friction_cones: 1,
            connector_cones: 7,
            ..Remaining::default()
        };
        assert_eq!(found.remaining, [short]);
    }

    /// A block that hangs by two faces from the world, its third one sideways, in the plane y = 0.
    fn hanging(model: Model) -> Structure {
        let mut structure = Structure { gravity: Vec3::new(0.0, 0.0, -10.0), ..Structure::default() };
        structure.connectors.push(Connector { name: "joint".to_owned(), strength: 30.0, model });
        for x in [0.0, 0.2] {
            structure.bodies.push(Body { mass: 1.0, com: Vec3::x() * x, fixed: false });
        }
        let down = nalgebra::UnitQuaternion::from_axis_angle(&Vec3::x_axis(), std::f64::consts::PI);
        for (body, x) in [(0, 0.0), (1, 0.2)] {
            let frame = Pose::from_parts(Vec3::new(x, 0.0, 0.1).into(), down);
            structure.connections.push(Connection {
                parent: Anchor::World,
                child: Anchor::Body(body),
                connector: 0,
                frame,
            });
        }
        for y in [0.1, -0.1] {
            structure.contacts.push(Contact {
                body: 1,
                against: Anchor::Body(0),
                position: Vec3::new(0.1, y, 0.0),
                normal: Vec3::x(),
                friction: 0.5,
            });
        }
        structure
    }

    #[test]
    fn a_planar_block_has_three_equations_a_body_and_wedges() {
        let points = vec![[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]];
        let counted = |model: Model, reductions: Reductions| {
            let found = explain(&hanging(model), reductions).expect("sound");
            let left = &found.remaining[0];
            assert_eq!(left.is_planar(), reductions.planar);
            (left.equations, left.friction_cones, left.connector_cones, left.inequalities)
        };
        let space = Reductions { planar: false, ..Reductions::ALL };
        let face = Model::Patch { friction: 0.5, points };
        assert_eq!(counted(face.clone(), space), (12, 2, 8, 0));
        // Two pairs of points in each face and one beside: five wedges, no cone.
        assert_eq!(counted(face.clone(), Reductions::ALL), (6, 0, 0, 10));
        assert!(explain(&hanging(face), Reductions::ALL).expect("sound").is_linear());
        let cone = Model::Cone { friction: [0.5; 2], radius: [0.1; 3] };
        assert_eq!(counted(cone.clone(), space), (12, 2, 2, 0));
        assert_eq!(counted(cone, Reductions::ALL), (6, 0, 2, 2));
        // Of a latch's components one shear, the tension and one bending lie in the plane.
        assert_eq!(counted(latch(5.0), space), (12, 2, 0, 2 * 11));
        assert_eq!(counted(latch(5.0), Reductions::ALL), (6, 0, 0, 2 * 5 + 2));
    }

    #[test]
    fn what_is_not_planar_says_why() {
        let cone = || Model::Cone { friction: [0.5; 2], radius: [0.1, 0.2, 0.1] };
        let why = |change: fn(&mut Structure)| {
            let mut structure = hanging(cone());
            change(&mut structure);
            explain(&structure, Reductions::ALL).expect("sound").remaining[0].in_space
        };
        assert_eq!(why(|_| ()), None);
        assert_eq!(why(|structure| structure.gravity.y = 1.0), Some(InSpace::Loads));
        assert_eq!(why(|structure| structure.contacts[1].friction = 0.4), Some(InSpace::Contact(0)));
        let askew = nalgebra::UnitQuaternion::from_axis_angle(&Vec3::z_axis(), 0.3);
        let mut structure = hanging(cone());
        structure.connections[1].frame.rotation *= askew;
        let found = explain(&structure, Reductions::ALL).expect("sound");
        assert_eq!(found.remaining[0].in_space, Some(InSpace::Connection(1)));
        let switched_off = Reductions { planar: false, ..Reductions::ALL };
        let found = explain(&structure, switched_off).expect("sound");
        assert_eq!(found.remaining[0].in_space, Some(InSpace::NotAskedFor));
    }

    #[test]
    fn latches_without_friction_are_a_linear_program() {
        let mut structure = ring(latch(1.0), 6);
        structure.contacts[0].friction = 0.0;
        let found = explain(&structure, Reductions::ALL).expect("sound");
        // Five components limited both ways and one only one way, and the point.
        assert_eq!(found.remaining[0].inequalities, 7 * 11 + 1);
        assert!(found.is_linear());
    }

    #[test]
    fn with_nothing_left_out_everything_remains() {
        let found = explain(&ring(latch(1.0), 6), Reductions::NONE).expect("sound");
        let left = &found.remaining[0];
        assert_eq!((found.remaining.len(), found.merged_bodies, found.closed_form_connections), (1, 0, 0));
        assert_eq!((left.bodies, left.unknown_wrenches, left.equations), (8, 10, 48));
    }

    #[test]
    fn without_gravity_nothing_remains() {
        let mut structure = ring(latch(1.0), 6);
        structure.gravity = Vec3::zeros();
        let found = explain(&structure, Reductions::ALL).expect("sound");
        assert_eq!((found.unloaded_blocks, found.remaining.len()), (1, 0));
    }
}
