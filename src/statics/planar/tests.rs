//! What is planar and what is not, and whether a field of the plane is one of space.

use std::f64::consts::FRAC_PI_2;

use super::super::blocks::cut;
use super::super::conic::Iterate;
use super::super::connector::{Connector, Model};
use super::super::groups::Cone;
use super::super::interior_point::InteriorPoint;
use super::super::loads::{lump, own_loads};
use super::super::parts::parts;
use super::super::structure::{Anchor, Body, Connection, Contact, Load, Structure};
use super::*;
use crate::spatial::{Pose, Rotation};

const NONE: f64 = f64::INFINITY;
const HALF: f64 = 0.05;

/// A wall in the plane y = 0, three cubes wide and two high, its neighbours joined and its left
/// side to the world, pulled away from there; the lower cubes may stand on their four corners.
fn wall(model: &Model, friction: f64) -> Structure {
    let mut wall = Structure { gravity: Vec3::new(8.0, 0.0, -9.81), ..Structure::default() };
    wall.connectors.push(Connector { name: "c".to_owned(), strength: 30.0, model: model.clone() });
    let sideways = Rotation::from_axis_angle(&Vec3::y_axis(), FRAC_PI_2);
    for (body, (x, z)) in [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)].into_iter().enumerate() {
        let com = Vec3::new(f64::from(x), 0.0, f64::from(z)) * (2.0 * HALF);
        wall.bodies.push(Body { mass: 0.3 + 0.1 * f64::from(x), com, fixed: false });
        let mut join = |parent: Anchor, towards: Vec3, turn| {
            let frame = Pose::from_parts((com - towards * HALF).into(), turn);
            wall.connections.push(Connection { parent, child: Anchor::Body(body), connector: 0, frame });
        };
        join(if x > 0 { Anchor::Body(body - 1) } else { Anchor::World }, Vec3::x(), sideways);
        if z > 0 {
            join(Anchor::Body(body - 3), Vec3::z(), Rotation::identity());
            continue;
        }
        for (along, across) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let position = com + Vec3::new(along, across, -1.0) * HALF;
            wall.contacts.push(Contact { body, against: Anchor::World, position, normal: Vec3::z(), friction });
        }
    }
    let (force, torque) = (Vec3::new(-0.5, 0.0, 0.2), Vec3::y() * 0.05);
    wall.loads.push(Load { body: 5, force, torque, at: None });
    wall
}

fn models() -> [Model; 5] {
    let points = vec![[HALF, HALF], [-HALF, HALF], [-HALF, -HALF], [HALF, -HALF], [HALF, 0.0], [0.0, 0.0]];
    let latch =
        |shear, compression, torsion| Model::Box { shear, tension: 20.0, compression, bending: [1.0, 2.0], torsion };
    [
        Model::Cone { friction: [0.5, 0.4], radius: [0.03, 0.02, 0.04] },
        Model::Patch { friction: 0.4, points },
        latch([20.0, 10.0], NONE, 1.0),
        latch([20.0, 10.0], 30.0, 1.0),
        latch([NONE, 0.0], 30.0, NONE),
    ]
}

/// Everything turned and moved away.
fn turned(structure: &Structure) -> Structure {
    let motion = Pose::new(Vec3::new(3.0, -2.0, 1.0), Vec3::new(0.7, -1.1, 0.4));
    let mut result = structure.clone();
    result.gravity = motion * result.gravity;
    result.bodies.iter_mut().for_each(|body| body.com = (motion * nalgebra::Point3::from(body.com)).coords);
    result.connections.iter_mut().for_each(|connection| connection.frame = motion * connection.frame);
    for contact in &mut result.contacts {
        contact.position = (motion * nalgebra::Point3::from(contact.position)).coords;
        contact.normal = motion * contact.normal;
    }
    for load in &mut result.loads {
        (load.force, load.torque) = (motion * load.force, motion * load.torque);
    }
    result
}

/// The program of the only block.
fn program(structure: &Structure, purpose: Purpose) -> Program {
    let pieces = cut(structure);
    let loads = lump(structure, &pieces.blocks, own_loads(structure));
    assert_eq!(pieces.blocks.len(), 1);
    Program::new(structure, &pieces.blocks[0], &loads, purpose)
}

fn why_not(structure: &Structure) -> Option<NotPlanar> {
    let program = program(structure, Purpose::Utilisation);
    Planar::new(&program, &parts(&program), Reductions::ALL).err()
}

/// With every kind of connector, on smooth and on rough ground.
fn walls() -> Vec<Structure> {
    let grounds = [0.0, 0.6];
    models().iter().flat_map(|model| grounds.map(|friction| wall(model, friction))).collect()
}

#[test]
fn walls_are_planar_wherever_they_stand() {
    for wall in walls() {
        let (model, friction) = (&wall.connectors[0].model, wall.contacts[0].friction);
        assert_eq!(why_not(&wall), None, "{model:?} {friction}");
        assert_eq!(why_not(&turned(&wall)), None, "turned: {model:?} {friction}");
    }
}

/// A wall of the first kind of connector and rough ground, changed.
fn changed(change: impl Fn(&mut Structure)) -> Structure {
    let mut structure = wall(&models()[0], 0.6);
    change(&mut structure);
    structure
}

fn load(force: Vec3, torque: Vec3) -> Load {
    Load { body: 1, force, torque, at: None }
}

#[test]
fn what_stands_out_of_the_plane_is_not_planar() {
    let expect = |structure: &Structure, reason: NotPlanar| {
        assert_eq!(why_not(structure), Some(reason));
        assert_eq!(why_not(&turned(structure)), Some(reason));
    };
    let across = |y: f64| changed(|wall| wall.loads.push(load(Vec3::y() * y, Vec3::zeros())));
    expect(&across(0.1), NotPlanar::Loads);
    expect(&across(1e-7), NotPlanar::Loads);
    assert_eq!(why_not(&across(1e-12)), None, "less than data are meant to");
    expect(&changed(|wall| wall.loads.push(load(Vec3::zeros(), Vec3::x() * 0.01))), NotPlanar::Loads);
    expect(&changed(|wall| wall.gravity.y = 0.1), NotPlanar::Loads);
    expect(&changed(|wall| wall.bodies[4].com.y = 0.01), NotPlanar::Bodies);
}

#[test]
fn what_has_no_image_is_named() {
    // Links are numbered connections first: here nine.
    let expect = |structure: &Structure, links: &[usize]| match why_not(structure) {
        Some(NotPlanar::Link(link)) => assert!(links.contains(&link), "{link}"),
        other => panic!("{other:?}"),
    };
    let turn = |wall: &mut Structure, angle: f64| {
        wall.connections[3].frame.rotation *= Rotation::from_axis_angle(&Vec3::z_axis(), angle);
    };
    expect(&changed(|wall| turn(wall, 0.3)), &[3]);
    assert_eq!(why_not(&changed(|wall| turn(wall, FRAC_PI_2))), None, "its axes have changed places");
    expect(&changed(|wall| wall.connections[2].frame.translation.y = 0.01), &[2]);
    expect(&changed(|wall| _ = wall.contacts.remove(0)), &[9, 10, 11]);
    expect(&changed(|wall| wall.contacts[4].friction = 0.3), &[13, 14]);
    expect(&changed(|wall| wall.contacts[4].position.y *= 1.1), &[13, 14]);
    // Around the axis all directions are the same.
    let round = Model::Cone { friction: [0.5; 2], radius: [0.03, 0.03, 0.04] };
    let mut even = wall(&round, 0.6);
    turn(&mut even, 0.3);
    assert_eq!(why_not(&even), None);
}

/// Between two slopes that lean against each other what a pair of points holds by friction across
/// the plane also lifts: a wedge is not enough.
#[test]
fn rough_grooves_are_left_in_space() {
    let groove = |friction: f64| {
        let mut structure = wall(&models()[0], friction);
        for contact in &mut structure.contacts {
            contact.normal = Vec3::new(0.0, -contact.position.y.signum() * 0.5, 1.0).normalize();
        }
        structure
    };
    assert!(matches!(why_not(&groove(0.6)), Some(NotPlanar::Link(_))));
    assert_eq!(why_not(&groove(0.0)), None);
}

#[test]
fn only_utilisation_is_asked_for_in_the_plane_and_only_where_allowed() {
    let structure = wall(&models()[1], 0.6);
    let support = program(&structure, Purpose::Support);
    assert_eq!(Planar::new(&support, &parts(&support), Reductions::ALL).err(), Some(NotPlanar::NotAskedFor));
    let program = program(&structure, Purpose::Utilisation);
    assert_eq!(Planar::new(&program, &parts(&program), Reductions::NONE).err(), Some(NotPlanar::NotAskedFor));
}

/// The finest iterate; `None` when the method gets stuck long before the end.
fn solve(program: &Program, reductions: Reductions) -> Option<Iterate> {
    let mut method = InteriorPoint::new(program, 1e-8, 1.0, reductions);
    let (mut least, mut finest) = (1e-6, None);
    for _ in 0..50 {
        let error = method.estimate().error;
        if error <= least {
            (least, finest) = (error, Some(method.iterate()));
        }
        if error <= 1e-9 || !method.step() {
            break;
        }
    }
    finest
}

/// Largest of what the balances and the ties in space lack.
fn imbalance(program: &Program, iterate: &Iterate) -> f64 {
    let mut rows: Vec<f64> =
        program.load.iter().zip(&program.preload).map(|(load, preload)| load + preload * iterate.t).collect();
    for group in &program.groups {
        for k in 0..group.len {
            for (row, entry) in program.entries(group, k) {
                rows[row] += entry * iterate.z[group.first + k];
            }
        }
    }
    rows.iter().fold(0.0, |largest, row| row.abs().max(largest))
}

/// By how much `x` lies outside its cone.
fn outside(cone: Cone, x: &[f64]) -> f64 {
    match cone {
        Cone::Free => 0.0,
        Cone::NonNegative => -x[0],
        Cone::Lorentz => x[1..].iter().map(|x| x * x).sum::<f64>().sqrt() - x[0],
    }
}

/// Both fields satisfy the program in space, with the same objective.
#[test]
fn what_comes_back_solves_the_program_in_space() {
    let mut compared = 0;
    for wall in walls() {
        for structure in [turned(&wall), wall] {
            let program = program(&structure, Purpose::Utilisation);
            let model = &structure.connectors[0].model;
            let both = solve(&program, Reductions::ALL).zip(solve(&program, Reductions::NONE));
            let Some((in_plane, in_space)) = both else { continue };
            compared += 1;
            assert!(in_space.t > 0.01, "{model:?} has nothing to hold");
            assert!(
                (in_plane.t - in_space.t).abs() <= 1e-5 * in_space.t.max(1.0),
                "{model:?}: {} {}",
                in_plane.t,
                in_space.t
            );
            assert!(imbalance(&program, &in_plane) <= 1e-5, "{model:?}: {}", imbalance(&program, &in_plane));
            let power: f64 = program.load.iter().zip(&in_plane.v).map(|(load, v)| load * v).sum();
            assert!((power - in_plane.t).abs() <= 1e-5 * in_plane.t.max(1.0), "{model:?}: {power} {}", in_plane.t);
            for group in &program.groups {
                assert!(outside(group.cone, group.part(&in_plane.z)) <= 1e-6, "{model:?}: force {group:?}");
                // The slacks of a tied component can always be opened far enough.
                if group.tie_row.is_none() && group.cone != Cone::Free {
                    let opening =
                        |k| program.entries(group, k).iter().map(|(row, entry)| entry * in_plane.v[*row]).sum();
                    let opening: Vec<f64> = (0..group.len).map(opening).collect();
                    assert!(outside(group.cone, &opening) <= 1e-5, "{model:?}: opening {group:?}");
                }
            }
        }
    }
    assert!(compared >= 15, "{compared} of 20");
}
