//! Laws of spots, codes and derived poses.

use std::sync::Arc;

use nalgebra::Unit;
use proptest::prelude::*;

use super::*;
use crate::robot::module_type::{BodyType, JointType, PortPlace, PortType};
use crate::robot::{Catalogue, Shape};
use crate::spatial::Rotation;
use crate::statics::{Connector, Model};

fn rotation(seed: [f64; 4]) -> Rotation {
    Rotation::from_quaternion(nalgebra::Quaternion::new(seed[0] + 0.1, seed[1], seed[2], seed[3] - 0.1))
}

fn angle_between(a: &Rotation, b: &Rotation) -> f64 {
    a.angle_to(b)
}

proptest! {
    #[test]
    fn a_spot_is_the_rotation_it_was_made_of(seed in prop::array::uniform4(-1.0..1.0f64)) {
        let rotation = rotation(seed);
        // Three roundings of half a micro-degree each.
        prop_assert!(angle_between(&Spot::of(&rotation).rotation(), &rotation) < 3.0 * 0.5e-6_f64.to_radians());
    }

    #[test]
    fn a_rotation_has_one_spot(azimuth in -720..720i32, polar in -720..720i32, spin in -720..720i32) {
        let spot = Spot::new(azimuth * MICRO, polar * MICRO, spin * MICRO);
        let angles = [azimuth, polar, spin].map(|a| f64::from(a).to_radians());
        let turn = |axis: Vec3, angle| Rotation::from_axis_angle(&Unit::new_unchecked(axis), angle);
        let product = turn(Vec3::z(), angles[0]) * turn(Vec3::y(), angles[1]) * turn(Vec3::z(), angles[2]);
        prop_assert!(angle_between(&spot.rotation(), &product) < 1e-7);
        prop_assert_eq!(Spot::of(&product), spot);
    }
}

/// A module of two bodies with a joint about x between them and a dock at either end.
fn hinged() -> ModuleType {
    let body = |name: &str, z: f64| BodyType {
        name: name.into(),
        mass: 1.0,
        com: Vec3::new(0.0, 0.0, z),
        shape: Shape::Cuboid { half_extents: Vec3::repeat(0.05) },
        shape_pose: Pose::translation(0.0, 0.0, z),
    };
    let port = |name: &str, body: usize, z: f64, turn: Rotation| PortType {
        name: name.into(),
        body,
        place: PortPlace::Point { frame: Pose::from_parts(Vec3::new(0.0, 0.0, z).into(), turn), orientations: 4 },
        connector: Some(0),
    };
    let reversed = Rotation::from_axis_angle(&Vec3::y_axis(), std::f64::consts::PI);
    ModuleType {
        name: "hinged".into(),
        bodies: vec![body("a", 0.05), body("b", 0.15)],
        joints: vec![JointType {
            name: "bend".into(),
            parent: 0,
            child: 1,
            axis: Vec3::x_axis(),
            origin: Vec3::new(0.0, 0.0, 0.1),
            range: Some([-3, 3]),
            step_degrees: 30.0,
            torque: 1.0,
        }],
        ports: vec![port("low", 0, 0.0, reversed), port("high", 1, 0.2, Rotation::identity())],
        rotates: true,
        roll_step_degrees: None,
        lattice: None,
    }
}

/// A chain of hinged modules, each on top of the one before, with these joints and angles.
fn chain(bends: &[i32], rolls: &[i32]) -> Linkage {
    let latch = Connector {
        name: "latch".into(),
        strength: 1.0,
        model: Model::Box {
            shear: [1.0; 2],
            tension: 1.0,
            compression: f64::INFINITY,
            bending: [1.0; 2],
            torsion: 1.0,
        },
    };
    let catalogue =
        Catalogue { name: "test".into(), connectors: vec![latch], motions: Vec::new(), module_types: vec![hinged()] };
    let module = |(i, bend): (usize, &i32)| Module {
        id: format!("m{i}"),
        module_type: 0,
        pose: Pose::identity(),
        joints: vec![*bend],
        fixed: i == 0,
    };
    let up = |i: usize| Connection::new(Port { module: i - 1, port: 1 }, Port { module: i, port: 0 });
    let mut linkage = Linkage {
        catalogue: Arc::new(catalogue),
        gravity: Vec3::zeros(),
        environment: Environment::default(),
        modules: bends.iter().enumerate().map(module).collect(),
        connections: (1..bends.len()).map(up).collect(),
        loads: Vec::new(),
        require: Requirement::default(),
    };
    let codes: Vec<Code> = rolls.iter().map(|&roll| Code::Docked { roll }).collect();
    let poses = linkage.placed_by(&codes);
    for (module, pose) in linkage.modules.iter_mut().zip(poses) {
        module.pose = pose;
    }
    linkage
}

proptest! {
    #[test]
    fn derived_poses_have_the_codes_they_were_derived_from(
        bends in prop::collection::vec(-3..=3i32, 4),
        rolls in prop::collection::vec(0..4i32, 3),
    ) {
        let linkage = chain(&bends, &rolls);
        prop_assert_eq!(linkage.problems(), vec![]);
        let codes: Vec<Code> = linkage.connections.iter().map(|c| linkage.code(c)).collect();
        let expected: Vec<Code> = rolls.iter().map(|&roll| Code::Docked { roll }).collect();
        prop_assert_eq!(&codes, &expected);
        let again: Vec<Pose> = linkage.placed_by(&codes);
        let before: Vec<Pose> = linkage.modules.iter().map(|m| m.pose).collect();
        prop_assert_eq!(again, before);
        let touching = linkage.touching();
        prop_assert!(linkage.connections.iter().all(|c| touching.contains(c)));
    }
}

#[test]
fn a_straight_chain_is_as_long_as_its_modules() {
    let linkage = chain(&[0, 0, 0], &[0, 0]);
    let top = linkage.port_frame(Port { module: 2, port: 1 }).expect("a point");
    assert!((top.translation.vector - Vec3::new(0.0, 0.0, 0.6)).norm() < 1e-15);
}

#[test]
fn a_bent_joint_carries_what_is_beyond_it() {
    let linkage = chain(&[3, 0], &[0]);
    // Bent by 90 degrees about x at 0.1 m: up turns to -y.
    let top = linkage.port_frame(Port { module: 1, port: 1 }).expect("a point");
    assert!((top.translation.vector - Vec3::new(0.0, -0.3, 0.1)).norm() < 1e-15);
}
