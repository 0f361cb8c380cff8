//! What a state becomes, and what attaching adds to it.

use std::sync::Arc;

use super::assembly::*;
use crate::robot::*;
use crate::spatial::{Pose, Vec3};
use crate::statics::{Anchor, Connector, Model};

const PITCH: f64 = 0.05;

/// A cone that is the same along x and y.
fn cone() -> Connector {
    let model = Model::Cone { friction: [0.6, 0.6], radius: [0.02, 0.02, 0.015] };
    Connector { name: "cone".into(), strength: 30.0, model }
}

/// The built-in catalogue with a third type, held by cones.
fn catalogue() -> Arc<Catalogue> {
    let mut catalogue = Catalogue::cube();
    catalogue.connectors.push(cone());
    let mut third = catalogue.module_types[0].clone();
    third.name = "cube-cone".into();
    third.lattice.as_mut().expect("a cube").face = catalogue.connectors.len() - 1;
    catalogue.module_types.push(third);
    Arc::new(catalogue)
}

pub(super) fn robot(module_type: usize, cells: &[Cell]) -> Configuration {
    let module = |(i, cell): (usize, &Cell)| Module {
        id: i.to_string(),
        module_type,
        placement: Placement::new(*cell),
        fixed: i == 0,
    };
    Configuration {
        catalogue: catalogue(),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        environment: Environment { module_friction: 0.3, ..Environment::default() },
        modules: cells.iter().enumerate().map(module).collect(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    }
}

pub(super) fn connected(module_type: usize, cells: &[Cell]) -> Configuration {
    let mut configuration = robot(module_type, cells);
    configuration.connections = configuration.touching_connections();
    assert_eq!(configuration.problems(), []);
    configuration
}

fn close(a: &Vec3, b: [f64; 3]) -> bool {
    (a - Vec3::from(b)).norm() < 1e-12
}

#[test]
fn faces_touch_where_they_do_not_hold() {
    let pair = [[0, 0, 0], [1, 0, 0]];
    for (module_type, friction, connected_contacts) in [(0, 0.4, 0), (1, 0.3, 4), (2, 0.3, 0)] {
        let apart = assemble(&robot(module_type, &pair));
        assert_eq!(apart.structure.connections.len(), 0);
        assert_eq!(apart.structure.contacts.len(), 4);
        assert_eq!(apart.contacts, vec![(0, Touched::Module(1)); 4]);
        for contact in &apart.structure.contacts {
            assert_eq!(contact.friction, friction);
            assert_eq!(contact.normal, -Vec3::x());
            assert!((contact.position.x - PITCH).abs() < 1e-15);
        }
        let held = assemble(&connected(module_type, &pair));
        assert_eq!(held.structure.connections.len(), 1);
        assert_eq!(held.structure.contacts.len(), connected_contacts);
    }
}

#[test]
fn a_connection_frame_looks_from_parent_to_child() {
    for towards in Face::ALL {
        let assembly = assemble(&connected(0, &[[0, 0, 0], towards.step()]));
        let connection = &assembly.structure.connections[0];
        assert_eq!((connection.parent, connection.child), (Anchor::Body(0), Anchor::Body(1)));
        assert!((connection.frame.rotation * Vec3::z() - towards.normal()).norm() < 1e-15);
        let middle = Vec3::repeat(PITCH / 2.0) + towards.normal() * (PITCH / 2.0);
        assert!((connection.frame.translation.vector - middle).norm() < 1e-15);
        let Model::Patch { points, .. } = &assembly.structure.connectors[connection.connector].model else { panic!() };
        assert_eq!(points.len(), 4);
        // The patch's points are where the faces would touch unconnected.
        let mut apart = connected(0, &[[0, 0, 0], towards.step()]);
        apart.connections.clear();
        for contact in assemble(&apart).structure.contacts {
            let local = connection.frame.inverse_transform_point(&contact.position.into());
            assert!(points.iter().any(|[x, y]| (Vec3::new(*x, *y, 0.0) - local.coords).norm() < 1e-15));
        }
    }
}

#[test]
fn ground_and_obstacles_carry_free_modules_only() {
    let mut configuration = connected(0, &[[0, 0, 0], [1, 0, 0]]);
    configuration.environment.ground = Some(Ground { height: 0.0, friction: 0.8 });
    configuration.environment.obstacles = vec![Obstacle {
        shape: Shape::Cuboid { half_extents: Vec3::new(0.025, 0.01, 0.1) }.into(),
        pose: Pose::translation(0.125, 0.025, 0.1),
        friction: 0.6,
    }];
    let assembly = assemble(&configuration);
    let ground = assembly.contacts.iter().filter(|c| **c == (1, Touched::Ground)).count();
    let wall = assembly.contacts.iter().filter(|c| **c == (1, Touched::Obstacle(0))).count();
    assert_eq!((ground, wall, assembly.contacts.len()), (4, 4, 8));
    for (contact, (_, touched)) in assembly.structure.contacts.iter().zip(&assembly.contacts) {
        let (friction, normal) =
            if *touched == Touched::Ground { (0.8, [0.0, 0.0, 1.0]) } else { (0.6, [-1.0, 0.0, 0.0]) };
        assert_eq!((contact.against, contact.friction), (Anchor::World, friction));
        assert!(close(&contact.normal, normal));
    }
}

#[test]
fn loads_move_and_turn_with_their_module() {
    let mut configuration = connected(0, &[[0, 0, 0], [1, 0, 0]]);
    configuration.modules[1].placement.orientation = Orientation::quarter_turn(Face::PosZ);
    configuration.loads = vec![ModuleLoad {
        module: 1,
        force: Vec3::new(1.0, 0.0, 0.0),
        torque: Vec3::zeros(),
        at: Some(Vec3::new(0.02, 0.0, 0.0)),
    }];
    let load = &assemble(&configuration).structure.loads[0];
    assert!(close(&load.at.unwrap(), [0.075, 0.045, 0.025]));
    assert_eq!(load.force, Vec3::new(1.0, 0.0, 0.0));
}

#[test]
fn a_sliding_module_hangs_on_the_overlaps() {
    // Module 2 slides along x over 0 and 1.
    for module_type in 0..3 {
        let configuration = robot(module_type, &[[0, 0, 0], [1, 0, 0], [0, 0, 1]]);
        let assembler = Assembler::new(&configuration);
        let placements: Vec<_> = configuration.modules.iter().map(|m| m.placement).collect();
        let engaged = [0, 1].map(|below| Engagement::Face { modules: [below, 2], towards: Face::PosZ });
        for eighth in 0..=8u8 {
            let phase = f64::from(eighth) / 8.0;
            let pose = Pose::translation(PITCH / 2.0 + phase * PITCH, PITCH / 2.0, 1.5 * PITCH);
            let moving = Some(Moving { module: 2, pose });
            let assembly = assembler.assemble(&Transient { placements: &placements, moving, engaged: &engaged });
            let structure = &assembly.structure;
            let strength = structure.connections.iter().map(|c| structure.connectors[c.connector].strength);
            let full = &configuration.catalogue.connectors[configuration.module_type(0).cell().face];
            assert!((strength.sum::<f64>() - full.strength).abs() < 1e-9);
            let expected: Vec<_> = (0..2).filter(|side| eighth != if *side == 0 { 8 } else { 0 }).collect();
            assert_eq!(assembly.connections, expected);
            for (connection, side) in structure.connections.iter().zip(&assembly.connections) {
                let middle = if *side == 0 { (1.0 + phase) / 2.0 } else { 1.0 + phase / 2.0 };
                assert!(close(&connection.frame.translation.vector, [middle * PITCH, PITCH / 2.0, PITCH]));
                if let Model::Patch { points, .. } = &structure.connectors[connection.connector].model {
                    let share = if *side == 0 { 1.0 - phase } else { phase };
                    assert!(points.iter().all(|[x, y]| {
                        let (across, along) = (y.abs() - PITCH / 2.0 * 1.0, x.abs() - share * PITCH / 2.0);
                        across.abs() < 1e-12 && along.abs() < 1e-12
                    }));
                }
            }
            // Beside the latches, contacts at the corners of each overlap.
            let below = if eighth % 8 == 0 { 4 } else { 8 };
            let between_the_supports = if module_type == 1 { below } else { 0 };
            let contacts = assembly.contacts.iter().filter(|(body, _)| *body == 2).count();
            assert_eq!(contacts, between_the_supports, "type {module_type} phase {phase}");
        }
    }
}

#[test]
fn a_pivoting_module_hangs_on_its_hinge() {
    let configuration = robot(0, &[[0, 0, 0], [0, 0, 1]]);
    let assembler = Assembler::new(&configuration);
    let placements: Vec<_> = configuration.modules.iter().map(|m| m.placement).collect();
    let edge = Vec3::new(PITCH, PITCH / 2.0, PITCH);
    let axis = crate::spatial::Rotation::rotation_between(&Vec3::z(), &Vec3::y()).unwrap();
    let engaged = [Engagement::Hinge { parent: 0, child: 1, frame: Pose::from_parts(edge.into(), axis) }];
    let motion = crate::geometry::Motion::Rotation { centre: edge, axis: Vec3::y_axis(), angle: std::f64::consts::PI };
    for (phase, contacts) in [(0.0, 4), (0.01, 0), (0.5, 0), (0.99, 0), (1.0, 4)] {
        let moving = Some(Moving { module: 1, pose: motion.pose(&placements[1].pose(PITCH), phase) });
        let assembly = assembler.assemble(&Transient { placements: &placements, moving, engaged: &engaged });
        assert_eq!(assembly.connections, [0]);
        assert_eq!(assembly.contacts, vec![(1, Touched::Module(0)); contacts], "phase {phase}");
        let hinge = &assembly.structure.connections[0];
        assert_eq!((hinge.parent, hinge.child), (Anchor::Body(0), Anchor::Body(1)));
        assert_eq!(assembly.structure.connectors[hinge.connector].name, "hinge");
        for contact in &assembly.structure.contacts {
            let into = if phase == 0.0 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
            assert!(close(&contact.normal, into));
        }
    }
}

#[test]
fn a_cone_carries_what_its_faces_carry_by_touching() {
    let configuration = robot(2, &[[0, 0, 0], [0, 0, 1]]);
    let Model::Cone { friction, radius } = cone().model else { panic!() };
    let middle = Vec3::new(PITCH / 2.0, PITCH / 2.0, PITCH);
    for contact in assemble(&configuration).structure.contacts {
        // Every extreme force of the contact, on the upper module.
        for degrees in 0..360 {
            let angle = f64::from(degrees).to_radians();
            let force = Vec3::new(contact.friction * angle.cos(), contact.friction * angle.sin(), 1.0);
            let torque = (contact.position - middle).cross(&force);
            let demand = (force.x / friction[0]).powi(2)
                + (force.y / friction[1]).powi(2)
                + (0..3).map(|i| (torque[i] / radius[i]).powi(2)).sum::<f64>();
            assert!(demand <= 1.0, "{demand}");
        }
    }
}
