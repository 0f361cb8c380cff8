//! Scenes of the size and kind that planners ask about.

use nalgebra::UnitVector3;
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Anchor, Body, Connection, Connector, Contact, Model, Structure};

use crate::random::Random;

fn connection(parent: Anchor, child: Anchor, at: Vec3, z: Vec3) -> Connection {
    let half_turn = || Rotation::from_axis_angle(&UnitVector3::new_unchecked(Vec3::x()), std::f64::consts::PI);
    let rotation = Rotation::rotation_between(&Vec3::z(), &z).unwrap_or_else(half_turn);
    Connection { parent, child, connector: 0, frame: Pose::from_parts(at.into(), rotation) }
}

/// The magnetic connector, strut and node of FreeSN (Tu and Lam 2023).
fn magnet() -> Connector {
    let model = Model::Cone { friction: [0.8, 0.5], radius: [0.025, 0.025, 0.02] };
    Connector { name: "magnet".to_owned(), strength: 109.2, model }
}

const NODE: f64 = 0.06;
const STRUT: f64 = 0.087;

fn empty(connector: Connector) -> Structure {
    Structure { gravity: Vec3::new(0.0, 0.0, -9.81), connectors: vec![connector], ..Structure::default() }
}

/// A lattice of `size` nodes with a strut along every edge, standing on
/// frictional ground with its lowest nodes.
pub fn truss(size: [usize; 3]) -> Structure {
    let mut structure = empty(magnet());
    let pitch = 2.0 * NODE + STRUT;
    let index = |c: [usize; 3]| (c[2] * size[1] + c[1]) * size[0] + c[0];
    let position = |c: [usize; 3]| Vec3::new(c[0] as f64, c[1] as f64, c[2] as f64) * pitch;
    let cells = (0..size[2]).flat_map(|z| (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y, z])));
    let cells: Vec<[usize; 3]> = cells.collect();
    for &cell in &cells {
        structure.bodies.push(Body { mass: 0.361, com: position(cell), fixed: false });
        if cell[2] == 0 {
            structure.contacts.push(Contact {
                body: index(cell),
                against: Anchor::World,
                position: position(cell) - Vec3::z() * NODE,
                normal: Vec3::z(),
                friction: 0.8,
            });
        }
    }
    for &cell in &cells {
        for axis in (0..3).filter(|&axis| cell[axis] + 1 < size[axis]) {
            let mut other = cell;
            other[axis] += 1;
            let (along, strut) = (Vec3::ith(axis, 1.0), structure.bodies.len());
            let com = position(cell) + along * (pitch / 2.0);
            structure.bodies.push(Body { mass: 0.492, com, fixed: false });
            for (node, side) in [(cell, 1.0), (other, -1.0)] {
                let at = position(node) + along * (NODE * side);
                let pair = (Anchor::Body(index(node)), Anchor::Body(strut));
                structure.connections.push(connection(pair.0, pair.1, at, along * side));
            }
        }
    }
    structure
}

/// A wall of cubes held at its left edge, every face pair by a patch.
pub fn wall(columns: usize, rows: usize) -> Structure {
    let half = 0.05;
    let points = vec![[half, half], [-half, half], [-half, -half], [half, -half]];
    let model = Model::Patch { friction: 0.4, points };
    let mut structure = empty(Connector { name: "face".to_owned(), strength: 120.0, model });
    let position = |x: usize, z: usize| Vec3::new(x as f64 + 0.5, 0.0, z as f64) * 0.1;
    for z in 0..rows {
        for x in 0..columns {
            let (here, com) = (z * columns + x, position(x, z));
            structure.bodies.push(Body { mass: 0.6, com, fixed: false });
            let left = if x == 0 { Anchor::World } else { Anchor::Body(here - 1) };
            structure.connections.push(connection(left, Anchor::Body(here), com - Vec3::x() * half, Vec3::x()));
            if z > 0 {
                let below = Anchor::Body(here - columns);
                structure.connections.push(connection(below, Anchor::Body(here), com - Vec3::z() * half, Vec3::z()));
            }
        }
    }
    structure
}

/// A random tree of bodies hanging from the world; few branches reach far.
pub fn tree(count: usize) -> Structure {
    let mut random = Random::new(7);
    let mut structure = empty(magnet());
    for i in 0..count {
        let (parent, above) = if i == 0 {
            (Anchor::World, Vec3::zeros())
        } else {
            let parent = random.below(i);
            (Anchor::Body(parent), structure.bodies[parent].com)
        };
        let step = (random.vector() - Vec3::z()).normalize() * 0.1;
        structure.bodies.push(Body { mass: 0.4, com: above + step, fixed: false });
        structure.connections.push(connection(parent, Anchor::Body(i), above + step * 0.5, step.normalize()));
    }
    structure
}
