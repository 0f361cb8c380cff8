//! Scenes in which each reduction has something to leave out, and some in which none has.

use steadfast::io::{SourceFile, read_structure};
use steadfast::spatial::{Pose, Vec3};
use steadfast::statics::{Anchor, Body, Connection, Connector, Model, Structure};

use crate::random::{Kind, Random, Recipe, structure};
use crate::scenes::{tree, truss, wall};

/// A structure with its name.
pub struct Scene {
    pub name: &'static str,
    pub structure: Structure,
}

/// All of them.
pub fn all() -> Vec<Scene> {
    let random = |kind, bodies, seed| structure(&Recipe { kind, bodies, seed });
    let scenes = [
        ("truss 2 x 2 x 2", truss([2, 2, 2])),
        ("truss 6 x 2 x 2", truss([6, 2, 2])),
        ("truss 3 x 3 x 3", truss([3, 3, 3])),
        ("half of a truss welded", welded(truss([4, 2, 2]), 0.5)),
        ("suspension of 76", suspension()),
        ("wall 6 x 4", wall(6, 4)),
        ("wall 8 x 8", wall(8, 8)),
        ("planar truss 6 x 4", held(truss([6, 1, 4]))),
        ("tree of 200", tree(200)),
        ("truss with trees of 40", with_trees(truss([2, 2, 2]), 8, 5)),
        ("eight trusses", beside_each_other(&truss([2, 2, 2]), 8)),
        ("eight large trusses", beside_each_other(&truss([4, 3, 2]), 8)),
        ("row of loops", row_of_loops(12)),
        ("two hanging chains of 1000", hanging_chains(1000)),
        ("cubes on uneven ground", random(Kind::Uneven, 20, 3)),
        ("redundant cubes", random(Kind::Redundant, 20, 5)),
        ("slender cubes", random(Kind::Slender, 40, 4)),
    ];
    scenes.into_iter().map(|(name, structure)| Scene { name, structure }).collect()
}

/// A truss of one layer, held at its lowest nodes: on the ground it would fall over.
fn held(mut structure: Structure) -> Structure {
    for contact in std::mem::take(&mut structure.contacts) {
        let rotation = steadfast::spatial::Rotation::rotation_between(&Vec3::z(), &contact.normal).expect("upwards");
        let frame = Pose::from_parts(contact.position.into(), rotation);
        structure.connections.push(Connection {
            parent: contact.against,
            child: Anchor::Body(contact.body),
            connector: 0,
            frame,
        });
    }
    structure
}

fn suspension() -> Structure {
    let path = problems::root().join("structures/suspension_76.json");
    let bytes = std::fs::read(&path).map_err(|error| error.to_string());
    let file = SourceFile { name: path.display().to_string(), bytes };
    read_structure(&file).expect("a file of the library is sound").structure
}

/// A share of the connections without any limit.
fn welded(mut structure: Structure, share: f64) -> Structure {
    const NONE: f64 = f64::INFINITY;
    let model = Model::Box { shear: [NONE; 2], tension: NONE, compression: NONE, bending: [NONE; 2], torsion: NONE };
    let (weld, mut random) = (structure.connectors.len(), Random::new(11));
    structure.connectors.push(Connector { name: "weld".to_owned(), strength: 1.0, model });
    for connection in &mut structure.connections {
        if random.chance(share) {
            connection.connector = weld;
        }
    }
    structure
}

fn hang(structure: &mut Structure, from: Anchor, above: Vec3, step: Vec3) -> usize {
    let body = structure.bodies.len();
    let rotation = steadfast::spatial::Rotation::rotation_between(&Vec3::z(), &step).expect("not straight down");
    structure.bodies.push(Body { mass: 0.05, com: above + step, fixed: false });
    let frame = Pose::from_parts((above + step * 0.5).into(), rotation);
    structure.connections.push(Connection { parent: from, child: Anchor::Body(body), connector: 0, frame });
    body
}

/// With a tree of `size` bodies on each of the first `hosts`.
fn with_trees(mut structure: Structure, hosts: usize, size: usize) -> Structure {
    let mut random = Random::new(3);
    for host in 0..hosts {
        let mut grown = vec![host];
        for _ in 0..size {
            let from = grown[random.below(grown.len())];
            let above = structure.bodies[from].com;
            let step = (random.vector() + Vec3::z() * 2.0).normalize() * 0.1;
            grown.push(hang(&mut structure, Anchor::Body(from), above, step));
        }
    }
    structure
}

/// The structure `count` times, each with other masses.
fn beside_each_other(one: &Structure, count: usize) -> Structure {
    let mut all = Structure { gravity: one.gravity, connectors: one.connectors.clone(), ..Structure::default() };
    for copy in 0..count {
        let (bodies, aside) = (all.bodies.len(), Vec3::y() * (2.0 * copy as f64));
        let anchor = |anchor: Anchor| match anchor {
            Anchor::World => Anchor::World,
            Anchor::Body(i) => Anchor::Body(i + bodies),
        };
        all.bodies.extend(one.bodies.iter().map(|body| Body {
            mass: body.mass * (1.0 + 0.1 * copy as f64),
            com: body.com + aside,
            ..body.clone()
        }));
        all.connections.extend(one.connections.iter().map(|connection| {
            let mut connection = connection.clone();
            (connection.parent, connection.child) = (anchor(connection.parent), anchor(connection.child));
            connection.frame.translation.vector += aside;
            connection
        }));
        all.contacts.extend(one.contacts.iter().map(|contact| {
            let mut contact = contact.clone();
            (contact.body, contact.against) = (contact.body + bodies, anchor(contact.against));
            contact.position += aside;
            contact
        }));
    }
    all
}

/// Two chains that hang side by side from the world, and a body that both of them hold.
fn hanging_chains(count: usize) -> Structure {
    let mut structure = tree(0);
    let mut ends = Vec::new();
    for side in [-1.0, 1.0] {
        let (mut from, mut above) = (Anchor::World, Vec3::x() * (0.05 * side));
        for link in 0..count {
            // Not quite straight, so that every component of the wrenches counts.
            let step = Vec3::new(0.0, 0.02 * (link as f64 + 1.0).sin(), -0.1);
            let body = hang(&mut structure, from, above, step);
            (from, above) = (Anchor::Body(body), above + step);
        }
        ends.push((from, above));
    }
    let [(one, above), (other, beside)] = ends[..] else { return structure };
    let held = hang(&mut structure, one, above, (beside - above) * 0.5 - Vec3::z() * 0.05);
    let com = structure.bodies[held].com;
    let rotation =
        steadfast::spatial::Rotation::rotation_between(&Vec3::z(), &(com - beside)).expect("not straight down");
    let frame = Pose::from_parts(((beside + com) * 0.5).into(), rotation);
    structure.connections.push(Connection { parent: other, child: Anchor::Body(held), connector: 0, frame });
    structure
}

/// Loops of six bodies, each hanging from a body of the one before.
fn row_of_loops(count: usize) -> Structure {
    let mut structure = tree(0);
    let mut start = (Anchor::World, Vec3::zeros());
    for _ in 0..count {
        let mut ends = Vec::new();
        for side in [1.0, -1.0] {
            let (mut from, mut above) = start;
            for step in [Vec3::new(0.1, 0.06 * side, 0.02), Vec3::new(0.1, 0.0, 0.01)] {
                let body = hang(&mut structure, from, above, step);
                (from, above) = (Anchor::Body(body), above + step);
            }
            ends.push((from, above));
        }
        // Both sides meet in one body.
        let (one, other) = (ends[0], ends[1]);
        let meeting = hang(&mut structure, one.0, one.1, Vec3::new(0.1, -0.06, 0.02));
        let com = structure.bodies[meeting].com;
        let frame = Pose::from_parts(
            ((other.1 + com) * 0.5).into(),
            steadfast::spatial::Rotation::rotation_between(&Vec3::z(), &(com - other.1)).expect("not straight down"),
        );
        structure.connections.push(Connection { parent: other.0, child: Anchor::Body(meeting), connector: 0, frame });
        start = (Anchor::Body(meeting), com);
    }
    structure
}
