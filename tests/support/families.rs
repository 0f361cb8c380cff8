//! Structures whose utilisation follows from a page of statics by hand.
//! Every function also returns it, infinite where no strength helps.

use nalgebra::UnitVector3;
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Anchor, Body, Connection, Connector, Contact, Model, Structure};

/// Gravity in m/s^2.
pub const G: f64 = 9.81;

fn empty() -> Structure {
    Structure { gravity: Vec3::new(0.0, 0.0, -G), ..Structure::default() }
}

fn body(mass: f64, com: Vec3) -> Body {
    Body { mass, com, fixed: false }
}

fn magnet(strength: f64) -> Connector {
    let model = Model::Cone { friction: [0.8, 0.8], radius: [0.02; 3] };
    Connector { name: "magnet".to_owned(), strength, model }
}

fn connection(parent: Anchor, child: Anchor, connector: usize, at: Vec3, z: Vec3) -> Connection {
    let half_turn = || Rotation::from_axis_angle(&UnitVector3::new_unchecked(Vec3::x()), std::f64::consts::PI);
    let rotation = Rotation::rotation_between(&Vec3::z(), &z).unwrap_or_else(half_turn);
    Connection { parent, child, connector, frame: Pose::from_parts(at.into(), rotation) }
}

/// A horizontal beam of `count` cubes of 0.5 kg and 0.1 m, each latched to the
/// one before, the first to the world: `n^2 m g a / 2` of bending at the root.
pub fn cantilever(count: usize) -> (Structure, f64) {
    let (edge, mass, force, torque) = (0.1, 0.5, 50.0, 2.0);
    let model = Model::Box {
        shear: [force; 2],
        tension: force,
        compression: f64::INFINITY,
        bending: [torque; 2],
        torsion: torque,
    };
    let mut structure = empty();
    structure.connectors.push(Connector { name: "latch".to_owned(), strength: force, model });
    for i in 0..count {
        structure.bodies.push(body(mass, Vec3::x() * ((i as f64 + 0.5) * edge)));
        let parent = if i == 0 { Anchor::World } else { Anchor::Body(i - 1) };
        let at = Vec3::x() * (i as f64 * edge);
        structure.connections.push(connection(parent, Anchor::Body(i), 0, at, Vec3::x()));
    }
    let n = count as f64;
    let weight = n * mass * G;
    (structure, (weight * n * edge / 2.0 / torque).max(weight / force))
}

/// A body of `mass` under `count` magnets of strength S in a row: `m g / (n S)`.
pub fn hang(mass: f64, strength: f64, count: usize) -> (Structure, f64) {
    let mut structure = empty();
    structure.connectors.push(magnet(strength));
    structure.bodies.push(body(mass, Vec3::z() * -0.1));
    for i in 0..count {
        let at = Vec3::x() * (0.03 * (i as f64 - (count as f64 - 1.0) / 2.0));
        structure.connections.push(connection(Anchor::World, Anchor::Body(0), 0, at, -Vec3::z()));
    }
    (structure, mass * G / (count as f64 * strength))
}

/// A light body hanging from a heavy one that hangs from the world.
pub fn series(masses: [f64; 2], strengths: [f64; 2]) -> (Structure, f64) {
    let mut structure = empty();
    structure.connectors.extend(strengths.map(magnet));
    structure.bodies.extend([body(masses[0], Vec3::z() * -0.1), body(masses[1], Vec3::z() * -0.3)]);
    let down = -Vec3::z();
    structure.connections.push(connection(Anchor::World, Anchor::Body(0), 0, Vec3::zeros(), down));
    structure.connections.push(connection(Anchor::Body(0), Anchor::Body(1), 1, down * 0.2, down));
    let top = (masses[0] + masses[1]) * G / strengths[0];
    (structure, top.max(masses[1] * G / strengths[1]))
}

/// Two equal hanging chains of `count` bodies, of `masses` in turn, that share a base.
pub fn two_chains(count: usize, masses: [f64; 2], base: f64, strength: f64) -> (Structure, f64) {
    let mut structure = empty();
    structure.connectors.push(magnet(strength));
    let mut chain = 0.0;
    let bottom = 2 * count;
    for (side, x) in [-0.1, 0.1].into_iter().enumerate() {
        let mut above = Anchor::World;
        for i in 0..count {
            let depth = -0.1 * i as f64;
            structure.bodies.push(body(masses[i % 2], Vec3::new(x, 0.0, depth - 0.05)));
            let here = Anchor::Body(side * count + i);
            structure.connections.push(connection(above, here, 0, Vec3::new(x, 0.0, depth), -Vec3::z()));
            above = here;
            chain += masses[i % 2] / 2.0;
        }
        let at = Vec3::new(x, 0.0, -0.1 * count as f64);
        structure.connections.push(connection(above, Anchor::Body(bottom), 0, at, -Vec3::z()));
    }
    structure.bodies.push(body(base, Vec3::z() * (-0.1 * count as f64 - 0.05)));
    (structure, (chain + base / 2.0) * G / strength)
}

/// A flat box on an inclined plane: slides where `tan angle > mu`.
pub fn incline(friction: f64, degrees: f64) -> (Structure, f64) {
    let angle = degrees.to_radians();
    let mut structure = empty();
    structure.gravity = Vec3::new(angle.sin(), 0.0, -angle.cos()) * G;
    structure.bodies.push(body(2.0, Vec3::z() * 0.002));
    for [x, y] in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
        structure.contacts.push(contact(0, Anchor::World, Vec3::new(x, y, 0.0) * 0.1, Vec3::z(), friction));
    }
    (structure, if angle.tan() <= friction { 0.0 } else { f64::INFINITY })
}

fn contact(body: usize, against: Anchor, position: Vec3, normal: Vec3, friction: f64) -> Contact {
    Contact { body, against, position, normal, friction }
}

/// A uniform ladder on a rough floor at a smooth wall: slides where `tan angle < 1 / (2 mu)`.
pub fn ladder(friction: f64, degrees: f64) -> (Structure, f64) {
    let angle = degrees.to_radians();
    let (foot, top) = (angle.cos(), angle.sin());
    let mut structure = empty();
    structure.bodies.push(body(5.0, Vec3::new(foot / 2.0, 0.0, top / 2.0)));
    for y in [-0.05, 0.05] {
        structure.contacts.push(contact(0, Anchor::World, Vec3::new(0.0, y, top), Vec3::x(), 0.0));
        structure.contacts.push(contact(0, Anchor::World, Vec3::new(foot, y, 0.0), Vec3::z(), friction));
    }
    (structure, if angle.tan() >= 1.0 / (2.0 * friction) { 0.0 } else { f64::INFINITY })
}

/// The harmonic stack of `count` bricks of length 1 with every overhang times
/// `factor`: falls where `factor > 1`.
pub fn overhang(count: usize, factor: f64) -> (Structure, f64) {
    let mut structure = empty();
    let mut x = 0.0;
    for i in 0..count {
        if i > 0 {
            x += factor * 0.5 / (count - i) as f64;
        }
        let height = 0.1 * i as f64;
        structure.bodies.push(body(1.0, Vec3::new(x, 0.0, height + 0.05)));
        let below = structure.bodies[i.saturating_sub(1)].com.x;
        let against = if i == 0 { Anchor::World } else { Anchor::Body(i - 1) };
        for (px, py) in [(x - 0.5, -0.2), (below + 0.5, -0.2), (x - 0.5, 0.2), (below + 0.5, 0.2)] {
            structure.contacts.push(contact(i, against, Vec3::new(px, py, height), Vec3::z(), 0.6));
        }
    }
    (structure, if factor <= 1.0 { 0.0 } else { f64::INFINITY })
}
