//! Beams held at one end or at both.

use steadfast::spatial::Vec3;
use steadfast::statics::{Anchor, Structure};

use super::{G, body, connection, empty, latch, magnet_with};

/// A horizontal beam of `count` cubes of 0.5 kg and 0.1 m, each latched to the
/// one before, the first to the world: `n^2 m g a / 2` of bending at the root.
pub fn cantilever(count: usize) -> (Structure, f64) {
    let (edge, mass, force, torque) = (0.1, 0.5, 50.0, 2.0);
    let mut structure = empty();
    structure.connectors.push(latch(force, torque));
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

/// Two such beams side by side, joined at their tips by a last cube between
/// them: a closed loop. The plane between them is one of symmetry, over which
/// nothing can pass that bends them up or down, so each root bends as that of a
/// beam with half a cube at its tip; the whole turning about both roots shows
/// that it cannot bend less.
pub fn cantilever_loop(count: usize) -> (Structure, f64) {
    let (edge, mass, force, torque) = (0.1, 0.5, 50.0, 2.0);
    let mut structure = empty();
    structure.connectors.push(latch(force, torque));
    let tip = 2 * count;
    for (side, y) in [-0.1, 0.1].into_iter().enumerate() {
        for i in 0..count {
            let parent = if i == 0 { Anchor::World } else { Anchor::Body(side * count + i - 1) };
            structure.bodies.push(body(mass, Vec3::new((i as f64 + 0.5) * edge, y, 0.0)));
            let at = Vec3::new(i as f64 * edge, y, 0.0);
            structure.connections.push(connection(parent, Anchor::Body(side * count + i), 0, at, Vec3::x()));
        }
        let last = Anchor::Body(side * count + count - 1);
        let at = Vec3::new((count as f64 - 0.5) * edge, y / 2.0, 0.0);
        structure.connections.push(connection(last, Anchor::Body(tip), 0, at, Vec3::y() * -y.signum()));
    }
    structure.bodies.push(body(mass, Vec3::x() * ((count as f64 - 0.5) * edge)));
    let n = count as f64;
    let bending = (n * n / 2.0 + (n - 0.5) / 2.0) * mass * G * edge;
    (structure, (bending / torque).max((n + 0.5) * mass * G / force))
}

/// A beam of `count` cubes between two walls that face each other, held by
/// friction: pressed hard enough between them it needs no strength at all.
pub fn clamped(count: usize) -> (Structure, f64) {
    let mut structure = empty();
    structure.connectors.push(magnet_with(10.0, 0.8, 0.04));
    for i in 0..count {
        structure.bodies.push(body(0.5, Vec3::x() * (0.1 * (i as f64 + 0.5))));
    }
    let body_or_wall = |i: usize| if (1..=count).contains(&i) { Anchor::Body(i - 1) } else { Anchor::World };
    for i in 0..=count {
        let at = Vec3::x() * (0.1 * i as f64);
        structure.connections.push(connection(body_or_wall(i), body_or_wall(i + 1), 0, at, Vec3::x()));
    }
    (structure, 0.0)
}

/// A body on a wall by two magnets of friction mu, its centre of mass between
/// them: all shear, `W / (2 mu S)`, and it fails by sliding down while it lifts
/// off by mu times as much.
pub fn sheared(friction: f64) -> (Structure, f64) {
    let (mass, strength) = (1.0, 8.0);
    let mut structure = empty();
    structure.connectors.push(magnet_with(strength, friction, 0.02));
    structure.bodies.push(body(mass, Vec3::zeros()));
    for y in [-0.1, 0.1] {
        structure.connections.push(connection(Anchor::World, Anchor::Body(0), 0, Vec3::y() * y, Vec3::x()));
    }
    (structure, mass * G / (2.0 * friction * strength))
}
