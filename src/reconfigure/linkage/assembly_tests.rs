//! Structures of linkages against closed forms and against those of lattices.

use std::sync::Arc;

use crate::robot::linkage::{Connection, Linkage, Module, Port};
use crate::robot::{self};
use crate::robot::{
    BodyType, Catalogue, Configuration, Environment, Face, Ground, JointType, ModuleType, Placement, PortPlace,
    PortType, Requirement, Shape,
};
use crate::spatial::{Pose, Rotation, Vec3};
use crate::statics::{Connector, Model, Question, assess};

use super::super::assembly as lattice;
use super::assembly::{Held, assemble};

pub(super) const GRAVITY: f64 = 9.81;

/// An arm of one module, held at its base, with a joint half-way along it.
pub(super) fn arm(torque: f64) -> Linkage {
    let body = |name: &str, x: f64| BodyType {
        name: name.into(),
        mass: 2.0,
        com: Vec3::new(x, 0.0, 0.0),
        shape: Shape::Cuboid { half_extents: Vec3::new(0.1, 0.05, 0.05) },
        shape_pose: Pose::translation(x, 0.0, 0.0),
    };
    let module_type = ModuleType {
        name: "arm".into(),
        bodies: vec![body("upper", 0.1), body("fore", 0.3)],
        joints: vec![JointType {
            name: "elbow".into(),
            parent: 0,
            child: 1,
            axis: Vec3::y_axis(),
            origin: Vec3::new(0.2, 0.0, 0.0),
            range: Some([-9, 9]),
            step_degrees: 10.0,
            torque,
        }],
        ports: Vec::new(),
        rotates: true,
        roll_step_degrees: None,
        lattice: None,
    };
    Linkage {
        catalogue: Arc::new(Catalogue {
            name: "test".into(),
            connectors: Vec::new(),
            motions: Vec::new(),
            module_types: vec![module_type],
        }),
        gravity: Vec3::new(0.0, 0.0, -GRAVITY),
        environment: Environment::default(),
        modules: vec![Module { id: "a".into(), module_type: 0, pose: Pose::identity(), joints: vec![0], fixed: true }],
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    }
}

#[test]
fn a_joint_holds_what_is_beyond_it_by_its_torque() {
    for position in [-9, -4, 0, 3, 9] {
        let mut linkage = arm(5.0);
        linkage.modules[0].joints[0] = position;
        let assembly = assemble(&linkage);
        assert_eq!(assembly.connections, [Held::Joint { module: 0, joint: 0 }]);
        let answer = assess(&assembly.structure, Question::VALUE).expect("sound");
        let lever = 0.1 * (f64::from(position) * 10.0).to_radians().cos();
        let expected = 2.0 * GRAVITY * lever / 5.0;
        assert!((answer.utilisation.lower - expected).abs() < 1e-12, "{position}: {answer:?}");
        assert!((answer.utilisation.upper - expected).abs() < 1e-12, "{position}: {answer:?}");
    }
}

/// The same cubes as modules of a lattice and as free modules with six ports.
fn cubes(cells: &[[i32; 3]], kind: usize) -> (Configuration, Linkage) {
    let catalogue = Arc::new(Catalogue::cube());
    let environment = Environment {
        ground: Some(Ground { height: 0.0, friction: 0.5 }),
        obstacles: Vec::new(),
        module_friction: 0.4,
    };
    let gravity = Vec3::new(0.3, 0.0, -GRAVITY);
    let mut configuration = Configuration {
        catalogue: Arc::clone(&catalogue),
        gravity,
        environment: environment.clone(),
        modules: cells
            .iter()
            .enumerate()
            .map(|(i, &cell)| robot::Module {
                id: format!("m{i}"),
                module_type: kind,
                placement: Placement::new(cell),
                fixed: false,
            })
            .collect(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    };
    configuration.connections = configuration.touching_connections();
    let module = |(i, module): (usize, &robot::Module)| Module {
        id: module.id.clone(),
        module_type: kind,
        pose: configuration.pose(i),
        joints: Vec::new(),
        fixed: false,
    };
    let mut linkage = Linkage {
        catalogue,
        gravity,
        environment,
        modules: configuration.modules.iter().enumerate().map(module).collect(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    };
    linkage.connections = linkage.touching();
    (configuration, linkage)
}

#[test]
fn cubes_are_the_same_in_a_lattice_and_outside() {
    let shapes: [&[[i32; 3]]; 3] = [
        &[[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1], [2, 0, 0]],
        &[[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [0, 0, 2], [1, 0, 2], [2, 0, 2]],
        &[[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1]],
    ];
    for cells in shapes {
        for kind in [0, 1] {
            let (configuration, mut linkage) = cubes(cells, kind);
            assert_eq!(linkage.problems(), []);
            let port = |port: robot::Port| Port {
                module: port.module,
                port: Face::ALL.iter().position(|&face| face == port.face).expect("a face"),
            };
            let expected: Vec<Connection> =
                configuration.connections.iter().map(|c| Connection::new(port(c.ports[0]), port(c.ports[1]))).collect();
            assert_eq!(linkage.connections, expected);
            // One left out, so that two faces touch unconnected.
            for left_out in [None, Some(1)] {
                let mut configuration = configuration.clone();
                if let Some(index) = left_out {
                    configuration.connections.remove(index);
                    linkage.connections.remove(index);
                }
                let [a, b] = [lattice::assemble(&configuration).structure, assemble(&linkage).structure]
                    .map(|structure| assess(&structure, Question::VALUE).expect("sound"));
                assert_eq!(a.verdict, b.verdict);
                let close = |x: f64, y: f64| x == y || (x - y).abs() < 2e-6 * y.abs().max(1.0);
                assert!(close(a.utilisation.upper, b.utilisation.upper), "{a:?} {b:?}");
            }
        }
    }
}

/// Two docks on either end of a rod.
fn rod() -> Catalogue {
    let latch = Connector {
        name: "latch".into(),
        strength: 1.0,
        model: Model::Box {
            shear: [f64::INFINITY; 2],
            tension: f64::INFINITY,
            compression: f64::INFINITY,
            bending: [0.5, 0.25],
            torsion: f64::INFINITY,
        },
    };
    let end = |name: &str, x: f64, turn: f64| PortType {
        name: name.into(),
        body: 0,
        place: PortPlace::Point {
            frame: Pose::from_parts(
                Vec3::new(x, 0.0, 0.0).into(),
                Rotation::from_axis_angle(&Vec3::y_axis(), turn.to_radians()),
            ),
            orientations: 4,
        },
        connector: Some(0),
    };
    let body = BodyType {
        name: "rod".into(),
        mass: 0.1,
        com: Vec3::new(0.1, 0.0, 0.0),
        // Shorter than the distance of the docks, so that no contact shares the moment.
        shape: Shape::Cuboid { half_extents: Vec3::new(0.09, 0.01, 0.01) },
        shape_pose: Pose::translation(0.1, 0.0, 0.0),
    };
    let module_type = ModuleType {
        name: "rod".into(),
        bodies: vec![body],
        joints: Vec::new(),
        ports: vec![end("near", 0.0, -90.0), end("far", 0.2, 90.0)],
        rotates: false,
        roll_step_degrees: None,
        lattice: None,
    };
    Catalogue { name: "rods".into(), connectors: vec![latch], motions: Vec::new(), module_types: vec![module_type] }
}

#[test]
fn a_dock_bends_about_its_own_axes() {
    // The frame's x is the first port's: with the rod along x and z outwards at its far end, x points down (-z)
    // and y along y, so the weight of the rod beyond bends about y, whose limit is 0.25.
    let rods = |id: &str, x: f64, fixed: bool| Module {
        id: id.into(),
        module_type: 0,
        pose: Pose::translation(x, 0.0, 0.0),
        joints: Vec::new(),
        fixed,
    };
    let mut linkage = Linkage {
        catalogue: Arc::new(rod()),
        gravity: Vec3::new(0.0, 0.0, -GRAVITY),
        environment: Environment::default(),
        modules: vec![rods("held", 0.0, true), rods("free", 0.2, false)],
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    };
    linkage.connections = linkage.touching();
    assert_eq!(linkage.problems(), []);
    assert_eq!(linkage.connections.len(), 1);
    let expected = 0.1 * GRAVITY * 0.1 / 0.25;
    let answer = assess(&assemble(&linkage).structure, Question::VALUE).expect("sound");
    assert!((answer.utilisation.upper - expected).abs() < 1e-12, "{answer:?}");
}
