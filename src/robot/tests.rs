//! Laws of placements and catalogues, and one test a fault.

use std::sync::Arc;

use super::*;
use crate::spatial::{Pose, Vec3};
use crate::statics::Model;

/// Cubes of the built-in catalogue in these cells, the first fixed, all touching
/// faces connected.
fn robot(cells: &[Cell]) -> Configuration {
    let module = |(i, cell): (usize, &Cell)| Module {
        id: format!("m{i}"),
        module_type: 0,
        placement: Placement::new(*cell),
        fixed: i == 0,
    };
    let mut configuration = Configuration {
        catalogue: Arc::new(Catalogue::cube()),
        gravity: Vec3::new(0.0, 0.0, -9.81),
        environment: Environment { module_friction: 0.4, ..Environment::default() },
        modules: cells.iter().enumerate().map(module).collect(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Requirement::default(),
    };
    configuration.connections = configuration.touching_connections();
    configuration
}

const SQUARE: [Cell; 4] = [[0, 0, 0], [1, 0, 0], [0, 0, 1], [1, 0, 1]];

/// All orientations that quarter turns reach.
fn orientations() -> Vec<Orientation> {
    let mut found = vec![Orientation::IDENTITY];
    let mut next = 0;
    while next < found.len() {
        for axis in Face::ALL {
            let turned = found[next].turned(Orientation::quarter_turn(axis));
            if !found.contains(&turned) {
                found.push(turned);
            }
        }
        next += 1;
    }
    found
}

#[test]
fn a_placement_and_its_pose_turn_faces_alike() {
    assert_eq!(orientations().len(), 24);
    for orientation in orientations() {
        let pose = Placement { cell: [1, -2, 3], orientation }.pose(0.5);
        assert_eq!(pose.translation.vector, Vec3::new(0.75, -0.75, 1.75));
        for face in Face::ALL {
            let world = orientation.to_world(face);
            assert!((pose.rotation * face.normal() - world.normal()).norm() < 1e-15);
            assert_eq!(orientation.to_module(world), face);
        }
    }
}

#[test]
fn a_quarter_turn_agrees_with_the_rotation_about_its_axis() {
    for axis in Face::ALL {
        let unit = nalgebra::Unit::new_normalize(axis.normal());
        let turn = crate::spatial::Rotation::from_axis_angle(&unit, std::f64::consts::FRAC_PI_2);
        assert!(Orientation::quarter_turn(axis).rotation().angle_to(&turn) < 1e-15);
    }
}

#[test]
fn touching_faces_are_found_in_any_orientation() {
    let mut configuration = robot(&SQUARE);
    for orientation in orientations() {
        configuration.modules[3].placement.orientation = orientation;
        configuration.connections = configuration.touching_connections();
        assert_eq!(configuration.connections.len(), 4);
        assert!(configuration.connections.is_sorted());
        assert_eq!(configuration.problems(), []);
    }
}

#[test]
fn components_are_named_by_their_first_module() {
    let mut configuration = robot(&[[0, 0, 0], [5, 0, 0], [1, 0, 0], [6, 0, 0]]);
    assert_eq!(configuration.components(), [0, 1, 0, 1]);
    assert!(!configuration.is_connected());
    configuration.modules.truncate(1);
    configuration.connections.clear();
    assert!(configuration.is_connected());
}

#[test]
fn the_built_in_catalogue_is_sound() {
    let catalogue = Catalogue::built_in("cube").unwrap();
    assert_eq!(catalogue.problems(), []);
    assert_eq!(Catalogue::built_in("cubes"), None);
    let (magnetic, latched) = (catalogue.find("cube").unwrap(), catalogue.find("cube-latched").unwrap());
    assert_eq!(catalogue.face_connector(magnetic, latched), None);
    assert!(catalogue.face_connector(latched, latched).is_some());
    assert!(catalogue.hinge(magnetic, latched).is_some());
}

#[test]
fn faces_are_held_by_the_weaker_of_their_connectors() {
    let mut catalogue = Catalogue::cube();
    let mut weak = catalogue.connectors[0].clone();
    weak.strength = 1.0;
    catalogue.connectors.push(weak);
    catalogue.module_types[1].lattice.as_mut().expect("a cube").face = 4;
    assert_eq!(catalogue.face_connector(0, 1), Some(4));
    assert_eq!(catalogue.face_connector(1, 0), Some(4));
}

/// The one problem of a sound configuration after a change.
fn problems_after(change: impl FnOnce(&mut Configuration)) -> Vec<Problem> {
    let mut configuration = robot(&SQUARE);
    configuration.environment.ground = Some(Ground { height: 0.0, friction: 0.5 });
    configuration.environment.obstacles = vec![Obstacle {
        shape: Shape::Cuboid { half_extents: Vec3::repeat(0.1) }.into(),
        pose: Pose::translation(1.0, 0.0, 0.1),
        friction: 0.5,
    }];
    let force = Vec3::new(0.0, 0.0, 1.0);
    configuration.loads = vec![ModuleLoad { module: 1, force, torque: Vec3::zeros(), at: Some(Vec3::zeros()) }];
    assert_eq!(configuration.problems(), []);
    change(&mut configuration);
    configuration.problems()
}

#[test]
fn every_fault_of_a_configuration_is_found_where_it_is() {
    let one = |part, field, fault| vec![Problem { part, field, fault }];
    type Case = (Box<dyn FnOnce(&mut Configuration)>, Vec<Problem>);
    let cases: [Case; 20] = [
        (Box::new(|c| c.gravity.x = f64::NAN), one(Part::Configuration, "gravity", Fault::NotFinite)),
        (
            Box::new(|c| c.environment.module_friction = -0.1),
            one(Part::Environment, "module_friction", Fault::Negative),
        ),
        (
            Box::new(|c| c.environment.ground.as_mut().unwrap().height = f64::INFINITY),
            one(Part::Ground, "height", Fault::NotFinite),
        ),
        (
            Box::new(|c| c.environment.ground.as_mut().unwrap().friction = -1.0),
            one(Part::Ground, "friction", Fault::Negative),
        ),
        (
            Box::new(|c| {
                c.environment.obstacles[0].shape = Shape::Cuboid { half_extents: Vec3::new(1.0, 0.0, 1.0) }.into()
            }),
            one(Part::Obstacle(0), "half_extents", Fault::NotPositive),
        ),
        (
            Box::new(|c| c.environment.obstacles[0].pose.translation.vector.y = f64::NAN),
            one(Part::Obstacle(0), "position", Fault::NotFinite),
        ),
        (
            Box::new(|c| c.environment.obstacles[0].friction = f64::NAN),
            one(Part::Obstacle(0), "friction", Fault::NotFinite),
        ),
        (Box::new(|c| c.modules[2].id = "m1".into()), one(Part::Module(2), "id", Fault::DuplicateName { first: 1 })),
        (
            Box::new(|c| c.modules[2].module_type = 7),
            one(Part::Module(2), "module_type", Fault::OutOfRange { index: 7, count: 2 }),
        ),
        (
            Box::new(|c| {
                let lattice = LatticeType { pitch: 0.1, ..c.catalogue.module_types[0].cell().clone() };
                Arc::make_mut(&mut c.catalogue).module_types[1].lattice = Some(lattice);
                c.modules[3].module_type = 1;
            }),
            one(Part::Module(3), "module_type", Fault::DifferentPitch { first: 0 }),
        ),
        (
            Box::new(|c| {
                c.modules.push(Module { id: "twin".into(), ..c.modules[1].clone() });
                c.require.connected = false;
            }),
            one(Part::Module(4), "placement", Fault::SameCell { other: 1 }),
        ),
        (
            Box::new(|c| c.connections.retain(|c| !c.modules().contains(&3))),
            one(Part::Module(3), "", Fault::Disconnected),
        ),
        (
            Box::new(|c| c.connections[1].ports[1].module = 9),
            one(Part::Connection(1), "ports", Fault::OutOfRange { index: 9, count: 4 }),
        ),
        (
            Box::new(|c| c.connections[1].ports[1].module = c.connections[1].ports[0].module),
            one(Part::Connection(1), "", Fault::SelfConnection),
        ),
        (Box::new(|c| c.connections[2].ports[0].face = Face::PosY), one(Part::Connection(2), "", Fault::FacesApart)),
        (
            Box::new(|c| {
                let [a, b] = c.connections[0].ports;
                c.connections.push(FaceConnection { ports: [b, a] });
            }),
            one(Part::Connection(4), "", Fault::DuplicateConnection { first: 0 }),
        ),
        (Box::new(|c| c.loads[0].module = 4), one(Part::Load(0), "module", Fault::OutOfRange { index: 4, count: 4 })),
        (Box::new(|c| c.loads[0].torque.y = f64::NAN), one(Part::Load(0), "torque", Fault::NotFinite)),
        (Box::new(|c| c.loads[0].at = Some(Vec3::repeat(f64::NAN))), one(Part::Load(0), "at", Fault::NotFinite)),
        (Box::new(|c| c.require.margin = f64::NAN), one(Part::Requirement, "margin", Fault::NotFinite)),
    ];
    for (change, expected) in cases {
        assert_eq!(problems_after(change), expected);
    }
}

#[test]
fn all_problems_are_found_at_once() {
    let found = problems_after(|c| {
        c.gravity.z = f64::INFINITY;
        c.modules[1].id = "m0".into();
        c.modules[3].module_type = 1;
        c.loads[0].force.x = f64::NAN;
    });
    let faults: Vec<_> = found.iter().map(|p| (p.part, p.fault)).collect();
    let fit = Fault::ConnectorsDoNotFit;
    let expected = [
        (Part::Configuration, Fault::NotFinite),
        (Part::Module(1), Fault::DuplicateName { first: 0 }),
        (Part::Connection(2), fit),
        (Part::Connection(3), fit),
        (Part::Load(0), Fault::NotFinite),
    ];
    assert_eq!(faults, expected);
    assert_eq!(found[1].to_string(), "modules[1].id: entry 0 has the same name");
}

#[test]
fn an_empty_robot_is_a_problem() {
    let expected = Problem { part: Part::Configuration, field: "modules", fault: Fault::NoModules };
    assert_eq!(robot(&[]).problems(), [expected]);
}

#[test]
fn every_fault_of_a_catalogue_is_found_where_it_is() {
    let cone = |friction, radius| Model::Cone { friction, radius };
    let patch = |points: &[[f64; 2]]| Model::Patch { friction: 0.4, points: points.to_vec() };
    let latch = |catalogue: &mut Catalogue, change: fn(&mut f64)| match &mut catalogue.connectors[2].model {
        Model::Box { tension, .. } => change(tension),
        _ => panic!("the latch is a box"),
    };
    type Case = (Box<dyn FnOnce(&mut Catalogue)>, Part, &'static str, Fault);
    let cases: Vec<Case> = vec![
        (Box::new(|c| c.connectors[0].strength = 0.0), Part::Connector(0), "strength", Fault::NotPositive),
        (Box::new(|c| c.connectors[0].strength = f64::INFINITY), Part::Connector(0), "strength", Fault::NotFinite),
        (
            Box::new(|c| c.connectors[2].name = "magnet".into()),
            Part::Connector(2),
            "name",
            Fault::DuplicateName { first: 0 },
        ),
        (
            Box::new(move |c| c.connectors[0].model = cone([0.5, 0.5], [0.1, 0.1, 0.0])),
            Part::Connector(0),
            "radius",
            Fault::NotPositive,
        ),
        (
            Box::new(move |c| c.connectors[0].model = cone([0.5, 0.4], [0.1; 3])),
            Part::ModuleType(0),
            "face",
            Fault::NotSymmetric,
        ),
        (Box::new(move |c| latch(c, |t| *t = f64::NAN)), Part::Connector(2), "tension", Fault::NotFinite),
        (Box::new(move |c| latch(c, |t| *t = -1.0)), Part::Connector(2), "tension", Fault::Negative),
        (
            Box::new(move |c| c.connectors[1].model = patch(&[[1.0, 0.0], [0.9, 1.0], [0.9, -1.0]])),
            Part::Connector(1),
            "points",
            Fault::OriginOutsidePatch,
        ),
        (
            Box::new(|c| c.module_types[1].name = "cube".into()),
            Part::ModuleType(1),
            "name",
            Fault::DuplicateName { first: 0 },
        ),
        (Box::new(|c| c.module_types[0].bodies[0].mass = -1.0), Part::BodyType(0, 0), "mass", Fault::Negative),
        (Box::new(|c| c.module_types[0].bodies[0].com.x = 0.01), Part::ModuleType(0), "com", Fault::NotSymmetric),
        (
            Box::new(|c| c.module_types[0].lattice.as_mut().expect("a cube").pitch = 0.06),
            Part::ModuleType(0),
            "half_extents",
            Fault::NotACell,
        ),
        (
            Box::new(|c| c.module_types[0].lattice.as_mut().expect("a cube").pitch = -0.05),
            Part::ModuleType(0),
            "pitch",
            Fault::NotPositive,
        ),
        (
            Box::new(|c| c.module_types[0].lattice.as_mut().expect("a cube").face = 9),
            Part::ModuleType(0),
            "face",
            Fault::OutOfRange { index: 9, count: 4 },
        ),
        (
            Box::new(|c| c.module_types[0].lattice.as_mut().expect("a cube").hinge = Some(0)),
            Part::ModuleType(0),
            "hinge",
            Fault::HingeNotBox,
        ),
    ];
    for (change, part, field, fault) in cases {
        let mut catalogue = Catalogue::cube();
        change(&mut catalogue);
        let expected = Problem { part, field, fault };
        assert!(catalogue.problems().contains(&expected), "{expected}: {:?}", catalogue.problems());
    }
}

#[test]
fn patches_hold_their_origin_up_to_their_rim() {
    let problems = |points: &[[f64; 2]]| {
        let mut catalogue = Catalogue::cube();
        catalogue.connectors[1].model = Model::Patch { friction: 0.4, points: points.to_vec() };
        catalogue.problems().iter().filter(|p| p.fault == Fault::OriginOutsidePatch).count()
    };
    assert_eq!(problems(&[[1.0, 1.0], [-1.0, 1.0], [0.0, -1.0]]), 0);
    assert_eq!(problems(&[[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]]), 0);
    assert_eq!(problems(&[[0.0, 0.0]]), 0);
    assert_eq!(problems(&[[0.1, 0.0]]), 1);
    assert_eq!(problems(&[[1.0, 0.1], [-1.0, 0.1], [0.0, 1.0]]), 1);
}
