//! The built-in RoFI module against the platform's own transforms, written here as plain
//! 4 x 4 matrices, in units of one cell.

use std::sync::Arc;

use steadfast::robot::linkage::{Connection, Linkage, Module, Port, child_pose, mated};
use steadfast::robot::{Catalogue, Environment, PortPlace, Requirement, rofi};
use steadfast::spatial::{Pose, Vec3};

type Matrix = [[f64; 4]; 4];

const IDENTITY: Matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]];

fn product(factors: &[Matrix]) -> Matrix {
    factors.iter().fold(IDENTITY, |a, b| {
        let mut out = [[0.0; 4]; 4];
        for i in 0..4 {
            for j in 0..4 {
                out[i][j] = (0..4).map(|k| a[i][k] * b[k][j]).sum();
            }
        }
        out
    })
}

fn translation(x: f64, y: f64, z: f64) -> Matrix {
    let mut out = IDENTITY;
    (out[0][3], out[1][3], out[2][3]) = (x, y, z);
    out
}

/// Turn about one of the axes x, y, z by whole degrees.
fn turn(axis: usize, degrees: i32) -> Matrix {
    let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut out = IDENTITY;
    (out[u][u], out[u][v], out[v][u], out[v][v]) = (cos, -sin, sin, cos);
    out
}

/// The shoes and bodies: shoe A, body A, body B, shoe B.
fn components(alpha: i32, beta: i32, gamma: i32) -> [Matrix; 4] {
    let body_a = turn(0, -alpha);
    let body_b = product(&[body_a, turn(2, gamma), translation(0.0, 0.0, 1.0), turn(1, 180)]);
    [IDENTITY, body_a, body_b, product(&[body_b, turn(0, beta)])]
}

/// The docks -X, +X, -Z of a shoe.
fn docks(shoe: Matrix) -> [Matrix; 3] {
    [IDENTITY, turn(1, 180), product(&[turn(2, 180), turn(1, -90)])].map(|dock| product(&[shoe, dock]))
}

/// Where the partner of a dock is, at an angle of orientation.
fn joined(dock: Matrix, degrees: i32) -> Matrix {
    // About (-1, 0, 0) by an angle is about (1, 0, 0) by its negative.
    product(&[dock, translation(-1.0, 0.0, 0.0), turn(2, 180), turn(0, 180), turn(0, -degrees)])
}

/// Orientations North, East, South, West: their angle, and ours between the ports.
const ORIENTATIONS: [(i32, f64); 4] = [(180, 0.0), (-90, 270.0), (0, 180.0), (90, 90.0)];

fn matrix(pose: &Pose) -> Matrix {
    let m = pose.to_homogeneous();
    let mut out = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..4 {
            out[i][j] = m[(i, j)] / if i < 3 && j == 3 { rofi::CELL } else { 1.0 };
        }
    }
    out
}

fn assert_same(found: &Matrix, expected: &Matrix) {
    for i in 0..4 {
        for j in 0..4 {
            assert!((found[i][j] - expected[i][j]).abs() < 1e-12, "{found:?}\n{expected:?}");
        }
    }
}

/// All positions in steps of the step, with the angles in degrees.
fn positions() -> Vec<[i32; 3]> {
    let mut all = Vec::new();
    for alpha in -1..=1 {
        for beta in -1..=1 {
            for gamma in -3..=3 {
                all.push([alpha, beta, gamma]);
            }
        }
    }
    all
}

/// RoFI's frame of a port.
fn dock_of_port(port: &Pose) -> Matrix {
    matrix(&(port * rofi::port_in_dock().inverse()))
}

#[test]
fn bodies_are_where_the_platform_has_them() {
    let catalogue = Catalogue::rofi_with(45, &[]);
    for (catalogue, step) in [(Catalogue::rofi(), 90), (catalogue, 45)] {
        let universal = &catalogue.module_types[0];
        for joints in positions() {
            let poses = universal.body_poses(&joints);
            let [alpha, beta, gamma] = joints.map(|steps| steps * step);
            let expected = components(alpha, beta, gamma);
            for (body, pose) in poses.iter().enumerate() {
                let half = if body < 2 { Pose::identity() } else { rofi::other_half() };
                assert_same(&matrix(&(pose * half)), &expected[body]);
            }
        }
    }
}

#[test]
fn docks_are_where_the_platform_has_them_and_look_outwards() {
    let catalogue = Catalogue::rofi();
    let universal = &catalogue.module_types[0];
    assert_eq!(
        universal.ports.iter().map(|p| p.name.as_str()).collect::<Vec<_>>(),
        ["A-X", "A+X", "A-Z", "B-X", "B+X", "B-Z"]
    );
    for joints in positions() {
        let poses = universal.body_poses(&joints);
        let [alpha, beta, gamma] = joints.map(|steps| steps * 90);
        let [shoe_a, _, _, shoe_b] = components(alpha, beta, gamma);
        let expected = [docks(shoe_a), docks(shoe_b)].concat();
        for (port, expected) in universal.ports.iter().zip(&expected) {
            let PortPlace::Point { frame, orientations: 4 } = &port.place else { panic!("a dock is a point") };
            let port = poses[port.body] * frame;
            assert_same(&dock_of_port(&port), expected);
            // Half a cell along the dock's -x, looking along it.
            let face = product(&[*expected, translation(-0.5, 0.0, 0.0)]);
            let outwards = port.rotation * Vec3::z();
            for i in 0..3 {
                assert!((port.translation.vector[i] / rofi::CELL - face[i][3]).abs() < 1e-12);
                assert!((outwards[i] + expected[i][0]).abs() < 1e-12);
            }
        }
    }
}

#[test]
fn joined_docks_meet_as_the_platform_joins_them() {
    let catalogue = Arc::new(Catalogue::rofi());
    let universal = &catalogue.module_types[0];
    for first in 0..6 {
        for second in 0..6 {
            for (degrees, roll) in ORIENTATIONS {
                let (near, far) = ([0, 1, 1], [-1, 0, 2]);
                let port = universal.body_poses(&near)[universal.ports[first].body];
                let PortPlace::Point { frame, .. } = &universal.ports[first].place else { panic!("a dock is a point") };
                let port = port * frame;
                let met = mated(&port, f64::to_radians(roll));
                assert_same(&dock_of_port(&met), &joined(dock_of_port(&port), degrees));
                let pose = child_pose(universal, second, &far, &met).unwrap();
                let module = |id: &str, pose, joints: [i32; 3]| Module {
                    id: id.into(),
                    module_type: 0,
                    pose,
                    joints: joints.into(),
                    fixed: false,
                };
                let ports = [(0, first), (1, second)].map(|(module, port)| Port { module, port });
                let linkage = Linkage {
                    catalogue: Arc::clone(&catalogue),
                    gravity: Vec3::zeros(),
                    environment: Environment::default(),
                    modules: vec![module("a", Pose::identity(), near), module("b", pose, far)],
                    connections: vec![Connection { ports }],
                    loads: Vec::new(),
                    require: Requirement::default(),
                };
                assert_eq!(linkage.problems(), []);
                assert!(linkage.touching().contains(&linkage.connections[0]));
            }
        }
    }
}

#[test]
fn a_pads_docks_are_numbered_along_its_height_first() {
    let catalogue = Catalogue::rofi_with(90, &[[2, 3]]);
    let pad = &catalogue.module_types[catalogue.find(&rofi::pad_name([2, 3])).unwrap()];
    assert_eq!(pad.ports.len(), 6);
    for (index, port) in pad.ports.iter().enumerate() {
        let PortPlace::Point { frame, .. } = &port.place else { panic!("a dock is a point") };
        let expected = translation(0.0, (index / 3) as f64, (index % 3) as f64);
        assert_same(&dock_of_port(frame), &expected);
    }
    assert_eq!(catalogue.problems(), []);
}

#[test]
fn catalogues_grow_only_where_they_must() {
    assert_eq!(Catalogue::rofi_with(90, &[[3, 3]]), Catalogue::rofi());
    assert_eq!(Catalogue::rofi_with(90, &[[5, 1], [5, 1]]).name, "rofi with pad-5x1");
}
