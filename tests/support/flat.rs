//! Random structures that are their own mirror image in a plane: polyominoes with
//! every kind of connector and contact, pulled and pushed within the plane.

use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Anchor, Body, Connection, Connector, Contact, Load, Model, Structure};

use crate::random::{Random, moved};

const PITCH: f64 = 0.1;
const NONE: f64 = f64::INFINITY;

/// One of `bodies` cells for every seed, in the plane y = 0, every other one turned and moved away.
pub fn flat(bodies: usize, seed: u64) -> Structure {
    let mut random = Random::new(seed);
    let cells = grow(&mut random, bodies);
    let gravity = Vec3::new(random.between(-3.0, 3.0), 0.0, -9.81);
    let mut structure = Structure { gravity, ..Structure::default() };
    for cell in &cells {
        let com = at(*cell) + Vec3::new(random.between(-0.2, 0.2), 0.0, random.between(-0.2, 0.2)) * PITCH;
        structure.bodies.push(Body { mass: random.decade(0.1, 1.0), com, fixed: false });
    }
    let strength = 10.0 * bodies as f64;
    for index in 0..3 {
        let model = model(&mut random, strength);
        structure.connectors.push(Connector { name: format!("c{index}"), strength, model });
    }
    for (body, &[x, z]) in cells.iter().enumerate() {
        for (other, towards) in [([x - 1, z], Vec3::x()), ([x, z - 1], Vec3::z())] {
            let beyond = cells.iter().position(|cell| *cell == other);
            match beyond {
                Some(other) if random.chance(0.15) => {
                    touch(&mut structure, &mut random, body, Anchor::Body(other), towards)
                }
                Some(other) => join(&mut structure, &mut random, body, Anchor::Body(other), towards),
                None if z == 0 && towards.z > 0.0 && random.chance(0.7) => {
                    touch(&mut structure, &mut random, body, Anchor::World, towards);
                }
                None if random.chance(0.2) => join(&mut structure, &mut random, body, Anchor::World, towards),
                None => {}
            }
        }
        if random.chance(0.2) {
            let force = Vec3::new(random.between(-2.0, 2.0), 0.0, random.between(-2.0, 2.0));
            let torque = Vec3::y() * random.between(-0.1, 0.1);
            structure.loads.push(Load { body, force, torque, at: None });
        }
    }
    let away = Pose::from_parts((random.vector() * 0.5).into(), random.rotation());
    if seed % 2 == 1 { moved(&structure, &away) } else { structure }
}

fn at([x, z]: [i32; 2]) -> Vec3 {
    Vec3::new(f64::from(x), 0.0, f64::from(z)) * PITCH
}

fn grow(random: &mut Random, bodies: usize) -> Vec<[i32; 2]> {
    let mut cells = vec![[0, 0]];
    while cells.len() < bodies {
        let [x, z] = cells[random.below(cells.len())];
        let cell = [[x + 1, z], [x - 1, z], [x, z + 1]][random.below(3)];
        if !cells.contains(&cell) {
            cells.push(cell);
        }
    }
    cells
}

fn model(random: &mut Random, strength: f64) -> Model {
    match random.below(3) {
        0 => Model::Cone {
            friction: [random.between(0.2, 1.0), random.between(0.2, 1.0)],
            radius: [(); 3].map(|()| random.between(0.1, 0.5) * PITCH),
        },
        1 => {
            let (a, b) = (random.between(0.2, 0.5) * PITCH, random.between(0.2, 0.5) * PITCH);
            let mut points = vec![[a, b], [-a, b], [-a, -b], [a, -b]];
            // A face need not end at its corners: some points lie in the plane itself.
            if random.chance(0.5) {
                points.extend([[a, 0.0], [-a, 0.0], [0.0, b], [0.0, -b]]);
            }
            Model::Patch { friction: random.between(0.2, 1.0), points }
        }
        _ => {
            let mut limit = |size: f64| match random.below(5) {
                0 => NONE,
                _ => size * random.between(0.3, 3.0),
            };
            let torque = strength * PITCH;
            Model::Box {
                shear: [limit(strength), limit(strength)],
                tension: limit(strength),
                compression: limit(strength),
                bending: [limit(torque), limit(torque)],
                torsion: limit(torque),
            }
        }
    }
}

/// A connection in the plane: about its axis it may be turned by quarters.
fn join(structure: &mut Structure, random: &mut Random, body: usize, other: Anchor, towards: Vec3) {
    let quarter = std::f64::consts::FRAC_PI_2 * random.below(4) as f64;
    let about = Rotation::from_axis_angle(&Vec3::z_axis(), quarter);
    let towards_child = Rotation::rotation_between(&Vec3::z(), &towards).expect("never opposite");
    let place = face(structure, body, other, towards);
    structure.connections.push(Connection {
        parent: other,
        child: Anchor::Body(body),
        connector: random.below(structure.connectors.len()),
        frame: Pose::from_parts(place.into(), towards_child * about),
    });
}

/// Points in mirrored pairs, or in the plane.
fn touch(structure: &mut Structure, random: &mut Random, body: usize, against: Anchor, normal: Vec3) {
    let place = face(structure, body, against, normal);
    let along = Vec3::y().cross(&normal);
    let friction = if random.chance(0.3) { 0.0 } else { random.between(0.2, 1.0) };
    for side in [-0.4, 0.4] {
        let beside: &[f64] = if random.chance(0.3) { &[0.0] } else { &[0.3, -0.3] };
        for across in beside {
            let position = place + (along * side + Vec3::y() * *across) * PITCH;
            structure.contacts.push(Contact { body, against, position, normal, friction });
        }
    }
}

/// About where the body meets what is there.
fn face(structure: &Structure, body: usize, other: Anchor, towards: Vec3) -> Vec3 {
    let com = structure.bodies[body].com;
    match other {
        Anchor::Body(other) => (com + structure.bodies[other].com) * 0.5,
        Anchor::World => com - towards * (0.5 * PITCH),
    }
}
