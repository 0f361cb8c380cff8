//! Bodies that stand: what contacts can and cannot hold.

use steadfast::spatial::Vec3;
use steadfast::statics::{Anchor, Load, Structure};

use super::{G, body, connection, contact, empty, magnet, magnet_with};

/// A flat box on an inclined plane: slides where `tan angle > mu`.
pub fn incline(friction: f64, degrees: f64) -> (Structure, f64) {
    let angle = degrees.to_radians();
    let mut structure = empty();
    structure.gravity = Vec3::new(angle.sin(), 0.0, -angle.cos()) * G;
    // Low enough not to tip before it slides.
    structure.bodies.push(body(2.0, Vec3::z() * (0.002_f64).min(0.02 / friction)));
    for [x, y] in [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]] {
        structure.contacts.push(contact(0, Anchor::World, Vec3::new(x, y, 0.0) * 0.1, Vec3::z(), friction));
    }
    (structure, if angle.tan() <= friction { 0.0 } else { f64::INFINITY })
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

/// A body on three contacts, two of them 0.2 m apart and one `depth` beside their
/// line; its centre of mass stands over `share` of that depth. It tips where
/// that is outside.
pub fn tripod(depth: f64, share: f64) -> (Structure, f64) {
    let mut structure = empty();
    structure.bodies.push(body(1.0, Vec3::new(0.0, share * depth, 0.1)));
    for [x, y] in [[-0.1, 0.0], [0.1, 0.0], [0.0, depth]] {
        structure.contacts.push(contact(0, Anchor::World, Vec3::new(x, y, 0.0), Vec3::z(), 0.5));
    }
    (structure, if (0.0..=1.0).contains(&share) { 0.0 } else { f64::INFINITY })
}

/// A beam over two edges `2 edge` apart, its centre of mass `arm` beyond one of
/// them, held down at the other end by a magnet on the ground, at a lever of
/// `length` from the edge it tips over: `W arm / (length S)`. Friction does
/// nothing, nor does the magnet's torque, whose lever is shorter.
pub fn seesaw(mass: f64, edge: f64, arm: f64, friction: f64) -> (Structure, f64) {
    let (strength, length) = (10.0, 0.5);
    let mut structure = empty();
    structure.connectors.push(magnet(strength));
    structure.bodies.push(body(mass, Vec3::new(edge + arm, 0.0, 0.1)));
    for x in [-edge, edge] {
        for y in [-0.1, 0.1] {
            structure.contacts.push(contact(0, Anchor::World, Vec3::new(x, y, 0.0), Vec3::z(), friction));
        }
    }
    let at = Vec3::x() * (edge - length);
    structure.connections.push(connection(Anchor::World, Anchor::Body(0), 0, at, Vec3::z()));
    (structure, mass * G * arm / (length * strength))
}

/// A body on a floor of friction `mu`, pulled away from a wall with `pull` times
/// its weight and held by a magnet there, all in the plane of the floor: the
/// magnet needs what the floor does not take, `(pull - mu) W`. The magnet could
/// also press the body down, which takes `1 / 0.5` of its strength and spares
/// `mu` of it: no use below `mu = 2`, and above nothing is left to hold.
pub fn towed(friction: f64, pull: f64) -> (Structure, f64) {
    assert!(friction < 2.0 || friction > pull, "pressing down would help");
    let (mass, strength) = (1.0, 10.0);
    let mut structure = empty();
    structure.connectors.push(magnet_with(strength, 0.5, 0.02));
    structure.bodies.push(body(mass, Vec3::zeros()));
    for [x, y] in [[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]] {
        structure.contacts.push(contact(0, Anchor::World, Vec3::new(x, y, 0.0), Vec3::z(), friction));
    }
    let wall = Vec3::x() * -0.1;
    structure.connections.push(connection(Anchor::World, Anchor::Body(0), 0, wall, Vec3::x()));
    let force = Vec3::x() * (pull * mass * G);
    structure.loads.push(Load { body: 0, force, torque: Vec3::zeros(), at: None });
    (structure, (pull - friction).max(0.0) * mass * G / strength)
}
