//! The scenes of the study, by family, and the families of growing size.
//!
//! Knows no method. Scenes are scaled so that their utilisation lies between
//! 0.5 and 1, where both the verdict and the value matter; by a power of two, which
//! rounds nothing.

use petgraph::unionfind::UnionFind;
use steadfast::io::{SourceFile, read_structure};
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{
    Anchor, Body, Connection, Connector, Contact, Load, Memory, Model, Question, Structure, assess, assess_keeping,
};

use crate::methods::DECIDE;
use crate::random::{Kind, Random, Recipe, structure};
use crate::reference::{Missing, Reference, reference};
use crate::scenes_support as support;

/// Families in the order of the figures.
pub const FAMILIES: [&str; 6] = ["trusses", "cube walls", "latched cubes", "uneven ground", "trees", "random"];

/// A structure to be asked about.
pub struct Scene {
    pub family: &'static str,
    pub name: String,
    pub structure: Structure,
    pub reference: Reference,
    /// What is remembered of the state before a connection on a loop was added, if there is one.
    pub neighbour: Option<Memory>,
}

/// The scenes of the study; of each family only the first if `quick`.
///
/// # Panics
/// Where a scene other than a random one has no reference.
pub fn scenes(quick: bool) -> Vec<Scene> {
    let mut plain: Vec<(&str, String, Structure)> = Vec::new();
    for size in [[2, 2, 2], [5, 2, 2], [20, 2, 2], [3, 3, 3]] {
        let [x, y, z] = size;
        plain.push((FAMILIES[0], format!("truss {x}x{y}x{z}"), support::truss(size)));
    }
    plain.push((FAMILIES[0], "suspension 8x4".to_owned(), suspension()));
    for side in [3, 5, 8] {
        plain.push((FAMILIES[1], format!("wall {side}x{side}"), support::wall(side, side)));
    }
    for size in [[3, 3, 3], [5, 4, 5]] {
        let [x, y, z] = size;
        plain.push((FAMILIES[2], format!("latched {x}x{y}x{z}"), latched(size)));
    }
    for (size, seed) in [([3, 2, 2], 1), ([4, 3, 2], 2), ([8, 2, 2], 3)] {
        let [x, y, z] = size;
        plain.push((FAMILIES[3], format!("uneven {x}x{y}x{z}"), uneven(size, seed)));
    }
    for count in [100, 1000] {
        plain.push((FAMILIES[4], format!("tree {count}"), support::tree(count)));
        plain.push((FAMILIES[4], format!("chain {count}"), chain(count)));
    }
    if quick {
        plain.dedup_by_key(|scene| scene.0);
    }
    let mut scenes: Vec<Scene> = plain
        .into_iter()
        .map(|(family, name, structure)| {
            Scene::new(family, name.clone(), structure).unwrap_or_else(|missing| panic!("{name}: {missing}"))
        })
        .collect();
    let kinds = if quick { &Kind::ALL[..1] } else { &Kind::ALL[..] };
    scenes.extend(kinds.iter().enumerate().filter_map(|(index, &kind)| random_scene(index, kind)));
    scenes
}

impl Scene {
    fn new(family: &'static str, name: String, mut structure: Structure) -> Result<Self, Missing> {
        let mut reference = reference(&structure)?;
        let scale = reference.value.log2().ceil().exp2();
        if reference.value > 0.0 && scale.is_finite() {
            strengthen(&mut structure, scale);
            reference = Reference { value: reference.value / scale, uncertainty: reference.uncertainty / scale };
        }
        let neighbour = before_a_connection(&structure);
        Ok(Self { family, name, structure, reference, neighbour })
    }
}

/// Multiplies all strengths and limits.
fn strengthen(structure: &mut Structure, factor: f64) {
    for connector in &mut structure.connectors {
        connector.strength *= factor;
        if let Model::Box { shear, tension, compression, bending, torsion } = &mut connector.model {
            let limits = shear.iter_mut().chain(bending).chain([tension, compression, torsion]);
            limits.for_each(|limit| *limit *= factor);
        }
    }
}

/// The first random structure of a kind that has a reference, neither zero nor
/// infinite, and in which a connection on a loop is critical: elsewhere the value follows from balance alone.
fn random_scene(index: usize, kind: Kind) -> Option<Scene> {
    (1..60).find_map(|count| {
        let seed = 100 * index as u64 + count;
        let structure = structure(&Recipe { kind, bodies: 20, seed });
        let scene = Scene::new(FAMILIES[5], format!("{kind:?}").to_lowercase(), structure).ok()?;
        (scene.reference.value > 0.5 - 1e-9 && loop_is_critical(&scene.structure)).then_some(scene)
    })
}

/// Whether some critical connection lies on a loop.
fn loop_is_critical(structure: &Structure) -> bool {
    let answer = assess(structure, Question::VALUE).expect("the scenes are sound");
    let critical = answer.connections.iter().enumerate().filter(|(_, state)| state.critical);
    critical.map(|(l, _)| l).any(|l| is_on_loop(structure, l))
}

/// The memory of the state without the middle one of the connections on loops.
fn before_a_connection(structure: &Structure) -> Option<Memory> {
    let on_loops: Vec<usize> = (0..structure.connections.len()).filter(|&l| is_on_loop(structure, l)).collect();
    let mut before = structure.clone();
    before.connections.remove(*on_loops.get(on_loops.len() / 2)?);
    let (_answer, memory) = assess_keeping(&before, DECIDE).expect("the scenes are sound");
    Some(memory)
}

/// Whether the two ends of a connection hang together without it.
fn is_on_loop(structure: &Structure, without: usize) -> bool {
    let world = structure.bodies.len();
    let vertex = |anchor: Anchor| match anchor {
        Anchor::Body(i) if !structure.bodies[i].fixed => i,
        Anchor::Body(_) | Anchor::World => world,
    };
    let mut joined = UnionFind::new(world + 1);
    for (l, connection) in structure.connections.iter().enumerate() {
        if l != without {
            joined.union(vertex(connection.parent), vertex(connection.child));
        }
    }
    for contact in &structure.contacts {
        joined.union(vertex(Anchor::Body(contact.body)), vertex(contact.against));
    }
    let connection = &structure.connections[without];
    joined.equiv(vertex(connection.parent), vertex(connection.child))
}

/// The suspended structure of 76 modules from the problem library.
fn suspension() -> Structure {
    let file = problems::root().join("structures/suspension_76.json");
    let text = std::fs::read(&file).expect("the problem library is there");
    read_structure(&SourceFile::new("suspension_76", text)).expect("a sound file").structure
}

/// A horizontal chain that winds about its axis and sags: every component of the wrench counts.
pub fn chain(count: usize) -> Structure {
    let mut structure = support::tree(1);
    for i in 1..count {
        let angle = i as f64;
        let step = Vec3::new(1.0, 0.6 * angle.cos(), 0.6 * angle.sin() - 0.3) * 0.08;
        let from = structure.bodies[i - 1].com;
        structure.bodies.push(Body { mass: 0.4, com: from + step, fixed: false });
        let ends = [Anchor::Body(i - 1), Anchor::Body(i)];
        structure.connections.push(connection(ends, 0, from + step * 0.5, step.normalize()));
    }
    structure
}

fn connection([parent, child]: [Anchor; 2], connector: usize, at: Vec3, z: Vec3) -> Connection {
    let half_turn = || Rotation::from_scaled_axis(Vec3::x() * std::f64::consts::PI);
    let rotation = Rotation::rotation_between(&Vec3::z(), &z).unwrap_or_else(half_turn);
    Connection { parent, child, connector, frame: Pose::from_parts(at.into(), rotation) }
}

/// A block of cubes with latches between all faces, clamped to the world at the
/// faces on its left, and pushed aside at the right: a linear program.
fn latched(size: [usize; 3]) -> Structure {
    let edge = 0.05;
    let model = Model::Box {
        shear: [60.0, 60.0],
        tension: 80.0,
        compression: f64::INFINITY,
        bending: [1.2, 1.2],
        torsion: 0.8,
    };
    let mut structure = Structure {
        gravity: Vec3::new(0.0, 0.0, -9.81),
        connectors: vec![Connector { name: "latch".to_owned(), strength: 80.0, model }],
        ..Structure::default()
    };
    let cells = (0..size[0]).flat_map(|x| (0..size[1]).flat_map(move |y| (0..size[2]).map(move |z| [x, y, z])));
    let cells: Vec<[usize; 3]> = cells.collect();
    let index = |c: [usize; 3]| (c[0] * size[1] + c[1]) * size[2] + c[2];
    for &cell in &cells {
        let com = Vec3::new(cell[0] as f64 + 0.5, cell[1] as f64, cell[2] as f64) * edge;
        let (here, mass) = (Anchor::Body(index(cell)), 0.15 + 0.01 * ((index(cell) * 7) % 5) as f64);
        structure.bodies.push(Body { mass, com, fixed: false });
        for axis in 0..3 {
            let mut before = cell;
            let from = if cell[axis] > 0 {
                before[axis] -= 1;
                Anchor::Body(index(before))
            } else if axis == 0 {
                Anchor::World
            } else {
                continue;
            };
            let z = Vec3::ith(axis, 1.0);
            structure.connections.push(connection([from, here], 0, com - z * (edge / 2.0), z));
        }
    }
    let last = structure.bodies.len() - 1;
    let force = Vec3::new(0.0, 4.0, -2.0);
    structure.loads.push(Load { body: last, force, torque: Vec3::zeros(), at: None });
    structure
}

/// A truss on uneven ground, with magnets, latches and faces mixed, pushed and
/// pulled at its nodes.
fn uneven(size: [usize; 3], seed: u64) -> Structure {
    let mut structure = support::truss(size);
    let mut random = Random::new(seed);
    let face = [[0.02, 0.02], [-0.02, 0.02], [-0.02, -0.02], [0.02, -0.02]];
    let latch = Model::Box {
        shear: [60.0, 60.0],
        tension: 90.0,
        compression: f64::INFINITY,
        bending: [3.0, 3.0],
        torsion: 2.0,
    };
    structure.connectors.push(Connector { name: "latch".to_owned(), strength: 90.0, model: latch });
    let face = Model::Patch { friction: 0.6, points: face.to_vec() };
    structure.connectors.push(Connector { name: "face".to_owned(), strength: 140.0, model: face });
    for connection in &mut structure.connections {
        connection.connector = random.below(3);
    }
    let contacts = std::mem::take(&mut structure.contacts);
    for contact in contacts {
        let normal = (Vec3::z() + random.vector() * 0.3).normalize();
        // Two points a foot, so that it can neither spin nor roll freely.
        let across = normal.cross(&Vec3::x()).normalize() * 0.02;
        for position in [contact.position + across, contact.position - across] {
            let friction = random.between(0.4, 0.9);
            structure.contacts.push(Contact { position, normal, friction, ..contact.clone() });
        }
    }
    let nodes = size.iter().product();
    for _ in 0..nodes / 3 {
        let force = random.vector().component_mul(&Vec3::new(3.0, 3.0, 8.0));
        let torque = random.vector() * 0.2;
        structure.loads.push(Load { body: random.below(nodes), force, torque, at: None });
    }
    structure
}
