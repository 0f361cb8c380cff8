//! Bodies that hang: what crosses a level is the weight below it.

use steadfast::spatial::Vec3;
use steadfast::statics::{Anchor, Connector, Model, Structure};

use super::{G, body, connection, empty, magnet, magnet_with};
use crate::random::Random;

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

/// A body of `mass` under a pair of magnets of each of `strengths`, each pair
/// evenly about it. Each carries its share in tension, and all of them give way
/// as the body drops: `m g / (2 sum S)`.
pub fn row(mass: f64, strengths: &[f64]) -> (Structure, f64) {
    let mut structure = empty();
    structure.bodies.push(body(mass, Vec3::z() * -0.1));
    for (i, &strength) in strengths.iter().enumerate() {
        structure.connectors.push(magnet(strength));
        for x in [-0.03, 0.03] {
            let at = Vec3::x() * (x * (i + 1) as f64);
            structure.connections.push(connection(Anchor::World, Anchor::Body(0), i, at, -Vec3::z()));
        }
    }
    (structure, mass * G / (2.0 * strengths.iter().sum::<f64>()))
}

/// A body at `offset` from the middle between two magnets `2 d` apart of the
/// given radius: the far one may pull as well as twist, so the nearer one is
/// relieved by a lever of `d + rho` about where the far one's torque would be
/// the force alone, `t = W / (2 S) (1 + e / (d + rho))`. It fails by turning
/// about the point `rho` beyond the far magnet, in which that one opens by `rho`
/// and rubs by `rho`: `W (e + d + rho) / (S (2 d + 2 rho))`.
pub fn off_centre(offset: f64, radius: f64) -> (Structure, f64) {
    let (mass, strength, half) = (1.0, 8.0, 0.1);
    let mut structure = empty();
    structure.connectors.push(magnet_with(strength, 0.8, radius));
    structure.bodies.push(body(mass, Vec3::new(offset, 0.0, -0.1)));
    for x in [-half, half] {
        structure.connections.push(connection(Anchor::World, Anchor::Body(0), 0, Vec3::x() * x, -Vec3::z()));
    }
    (structure, mass * G / (2.0 * strength) * (1.0 + offset / (half + radius)))
}

/// A plate on three pins, which carry force alone: two `2 d` apart and one
/// `depth` beside their line; the weight acts at `share` of that depth, so the
/// third carries `share` of it and the others half the rest each.
pub fn pins(depth: f64, share: f64) -> (Structure, f64) {
    let (mass, force) = (1.0, 10.0);
    let model = Model::Box { shear: [force; 2], tension: force, compression: force, bending: [0.0; 2], torsion: 0.0 };
    let mut structure = empty();
    structure.connectors.push(Connector { name: "pin".to_owned(), strength: force, model });
    structure.bodies.push(body(mass, Vec3::new(0.0, share * depth, -0.05)));
    for [x, y] in [[-0.1, 0.0], [0.1, 0.0], [0.0, depth]] {
        let at = Vec3::new(x, y, 0.0);
        structure.connections.push(connection(Anchor::World, Anchor::Body(0), 0, at, -Vec3::z()));
    }
    (structure, mass * G / force * share.abs().max((1.0 - share).abs() / 2.0))
}

/// A light body hanging from a heavy one that hangs from the world.
pub fn series(masses: [f64; 2], strengths: [f64; 2]) -> (Structure, f64) {
    chain(&masses, &strengths)
}

/// Bodies hanging one from the other, from the top: the weight below over the
/// strength, at the worst connection.
pub fn chain(masses: &[f64], strengths: &[f64]) -> (Structure, f64) {
    let mut structure = empty();
    for (i, (&mass, &strength)) in masses.iter().zip(strengths).enumerate() {
        let top = Vec3::z() * (-0.1 * i as f64);
        structure.connectors.push(magnet(strength));
        structure.bodies.push(body(mass, top - Vec3::z() * 0.05));
        let above = i.checked_sub(1).map_or(Anchor::World, Anchor::Body);
        structure.connections.push(connection(above, Anchor::Body(i), i, top, -Vec3::z()));
    }
    (structure, worst_level(masses, strengths))
}

/// Largest of the sum of the masses from here on, times G, over the strength.
fn worst_level(masses: &[f64], strengths: &[f64]) -> f64 {
    let (mut below, mut worst) = (0.0, 0.0_f64);
    for (mass, strength) in masses.iter().zip(strengths).rev() {
        below += mass;
        worst = worst.max(below * G / strength);
    }
    worst
}

/// `count` numbers whose logarithm is normal with deviation `sigma` about `median`.
pub fn lognormal(count: usize, median: f64, sigma: f64, seed: u64) -> Vec<f64> {
    let mut random = Random::new(seed);
    (0..count).map(|_| random.lognormal(median, sigma)).collect()
}

/// Two equal hanging chains of `count` bodies, of `masses` in turn, that share a
/// base. By symmetry each carries itself and half the base; all below the top
/// connections dropping shows that neither can carry less.
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

/// Two equal hanging chains with a rung between them at every level. By symmetry
/// each chain carries its own half, and a level gives way when all below it
/// drops: the weight below over the strength, at the worst level of one chain.
pub fn ladder_frame(masses: &[f64], strengths: &[f64]) -> (Structure, f64) {
    let mut structure = empty();
    for (i, (&mass, &strength)) in masses.iter().zip(strengths).enumerate() {
        structure.connectors.push(magnet(strength));
        let top = -0.1 * i as f64;
        for (side, x) in [-0.05, 0.05].into_iter().enumerate() {
            let above = i.checked_sub(1).map_or(Anchor::World, |i| Anchor::Body(2 * i + side));
            let here = Anchor::Body(2 * i + side);
            structure.bodies.push(body(mass, Vec3::new(x, 0.0, top - 0.05)));
            structure.connections.push(connection(above, here, i, Vec3::new(x, 0.0, top), -Vec3::z()));
        }
        let (left, right) = (Anchor::Body(2 * i), Anchor::Body(2 * i + 1));
        structure.connections.push(connection(left, right, i, Vec3::z() * (top - 0.05), Vec3::x()));
    }
    (structure, worst_level(masses, strengths))
}

/// `side` by `side` cubes under a ceiling, each by its own magnet, and every
/// pair of neighbours joined `links` times. Each can hang by itself, and all
/// dropping at once opens the ceiling's magnets alone: `m g / S`.
pub fn slab(side: usize, links: usize) -> (Structure, f64) {
    let (mass, strength) = (0.5, 7.0);
    let mut structure = empty();
    structure.connectors.push(magnet(strength));
    for i in 0..side * side {
        let at = Vec3::new((i % side) as f64, (i / side) as f64, 0.0) * 0.1;
        structure.bodies.push(body(mass, at - Vec3::z() * 0.05));
        structure.connections.push(connection(Anchor::World, Anchor::Body(i), 0, at, -Vec3::z()));
        for (axis, there, neighbour) in [(Vec3::x(), i % side > 0, 1), (Vec3::y(), i >= side, side)] {
            for k in (0..links).filter(|_| there) {
                let height = 0.1 * (k as f64 + 0.5) / links as f64;
                let face = at - axis * 0.05 - Vec3::z() * height;
                structure.connections.push(connection(Anchor::Body(i - neighbour), Anchor::Body(i), 0, face, axis));
            }
        }
    }
    (structure, mass * G / strength)
}
