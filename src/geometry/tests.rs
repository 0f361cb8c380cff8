//! Laws of contacts and sweeps, against parry and against dense sampling.

use nalgebra::{Unit, UnitQuaternion};
use parry3d_f64::query;
use parry3d_f64::shape::Cuboid;
use proptest::prelude::*;

use super::contact::half_space_contact;
use super::separation::separations;
use super::*;
use crate::robot::{Environment, Ground, Shape};
use crate::spatial::{Point, Pose, Rotation, Vec3};

fn cuboid(half: Vec3, pose: Pose) -> Solid {
    Solid::new(Shape::Cuboid { half_extents: half }, pose)
}

/// Cube of edge 1 centred at a point.
fn cube(x: f64, y: f64, z: f64) -> Solid {
    cuboid(Vec3::repeat(0.5), Pose::translation(x, y, z))
}

fn turned(solid: Solid, axis: Vec3, angle: f64) -> Solid {
    let rotation = Rotation::from_axis_angle(&Unit::new_normalize(axis), angle);
    Solid::new(solid.shape, Pose::from_parts(solid.pose.translation, rotation))
}

fn parry(solid: &Solid) -> (Cuboid, parry3d_f64::math::Pose) {
    let h = solid.vertices();
    let extent = |i: usize, j: usize| (h[i] - h[j]).norm() / 2.0;
    let half = [extent(1, 0), extent(2, 0), extent(4, 0)];
    let p = solid.pose.translation.vector;
    let (axis, angle) = solid.pose.rotation.axis_angle().map_or((Vec3::x(), 0.0), |(a, t)| (a.into_inner(), t));
    let turn = [axis.x * angle, axis.y * angle, axis.z * angle];
    (Cuboid::new(half.into()), parry3d_f64::math::Pose::new([p.x, p.y, p.z].into(), turn.into()))
}

fn parry_distance(a: &Solid, b: &Solid) -> f64 {
    let ((sa, pa), (sb, pb)) = (parry(a), parry(b));
    query::distance(&pa, &sa, &pb, &sb).unwrap().distance
}

/// How far a point is outside a cuboid, along the worst of its axes.
fn outside(solid: &Solid, p: &Vec3) -> f64 {
    let local = solid.pose.inverse_transform_point(&Point::from(*p)).coords;
    let (shape, _) = parry(solid);
    let half = Vec3::new(shape.half_extents.x, shape.half_extents.y, shape.half_extents.z);
    (local.abs() - half).max()
}

/// Contact with the ground below a height.
fn ground_contact(solid: &Solid, height: f64, tolerance: f64) -> Option<ContactPatch> {
    half_space_contact(solid, &Vec3::z(), height, tolerance)
}

/// Nothing but ground.
fn ground(height: f64) -> Surroundings {
    Surroundings::new(&Environment { ground: Some(Ground { height, friction: 0.5 }), ..Environment::default() })
}

fn sorted(patch: &ContactPatch) -> Vec<[f64; 3]> {
    let round = |x: f64| (x * 1e9).round() / 1e9 + 0.0;
    let mut points: Vec<_> = patch.points.iter().map(|p| [round(p.x), round(p.y), round(p.z)]).collect();
    points.sort_by(|a, b| a.partial_cmp(b).unwrap());
    points
}

fn any_vector(range: f64) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-range..range).prop_map(Vec3::from)
}

fn any_rotation() -> impl Strategy<Value = Rotation> {
    prop::array::uniform4(-1.0..1.0).prop_filter_map("too short", |q: [f64; 4]| {
        let q = nalgebra::Quaternion::from(q);
        (q.norm() > 0.1).then(|| UnitQuaternion::new_normalize(q))
    })
}

fn any_cuboid(range: f64) -> impl Strategy<Value = Solid> {
    (prop::array::uniform3(0.2..1.0), any_vector(range), any_rotation())
        .prop_map(|(half, at, rotation)| cuboid(Vec3::from(half), Pose::from_parts(at.into(), rotation)))
}

fn any_motion() -> impl Strategy<Value = Motion> {
    let translation = any_vector(4.0).prop_map(|by| Motion::Translation { by });
    let rotation = (any_vector(2.0), any_rotation(), -6.0..6.0).prop_map(|(centre, turn, angle)| Motion::Rotation {
        centre,
        axis: Unit::new_normalize(turn * Vec3::x()),
        angle,
    });
    prop_oneof![translation, rotation]
}

#[test]
fn a_cube_shifted_by_half_rests_on_half_a_face() {
    let patch = contact(&cube(0.5, 0.0, 1.0), &cube(0.0, 0.0, 0.0), TOUCH).unwrap();
    assert_eq!(patch.normal, Vec3::z());
    let expected = [[0.0, -0.5, 0.5], [0.0, 0.5, 0.5], [0.5, -0.5, 0.5], [0.5, 0.5, 0.5]];
    assert_eq!(sorted(&patch), expected);
}

#[test]
fn a_cube_turned_by_an_eighth_rests_on_an_octagon() {
    let upper = turned(cube(0.0, 0.0, 1.0), Vec3::z(), std::f64::consts::FRAC_PI_4);
    let patch = contact(&upper, &cube(0.0, 0.0, 0.0), TOUCH).unwrap();
    assert_eq!(patch.points.len(), 8);
    // Every corner cuts the edge at (sqrt 2 - 1) / 2 from its middle.
    let cut = (2f64.sqrt() - 1.0) / 2.0;
    for p in &patch.points {
        assert!((p.x.abs().max(p.y.abs()) - 0.5).abs() < 1e-12 && (p.x.abs().min(p.y.abs()) - cut).abs() < 1e-12);
        assert!((p.z - 0.5).abs() < 1e-12);
    }
}

#[test]
fn features_give_their_points() {
    let base = cube(0.0, 0.0, 0.0);
    let (eighth, half_diagonal) = (std::f64::consts::FRAC_PI_4, 0.5f64.sqrt());
    let on_edge = turned(cube(0.1, 0.2, 0.5 + half_diagonal), Vec3::x(), eighth);
    let patch = contact(&on_edge, &base, TOUCH).unwrap();
    assert_eq!(sorted(&patch), [[-0.4, 0.2, 0.5], [0.5, 0.2, 0.5]]);

    let tilt = Rotation::rotation_between(&Vec3::repeat(1.0), &Vec3::z()).unwrap();
    let on_vertex = Pose::from_parts(Vec3::new(0.1, 0.2, 0.5 + 0.75f64.sqrt()).into(), tilt);
    let patch = contact(&cuboid(Vec3::repeat(0.5), on_vertex), &base, TOUCH).unwrap();
    assert_eq!(sorted(&patch), [[0.1, 0.2, 0.5]]);

    let along_x = turned(cube(0.0, 0.0, 0.0), Vec3::x(), eighth);
    let along_y = turned(cube(0.0, 0.0, 2.0 * half_diagonal), Vec3::y(), eighth);
    let patch = contact(&along_y, &along_x, TOUCH).unwrap();
    assert!((patch.normal - Vec3::z()).norm() < 1e-9);
    assert_eq!(sorted(&patch), [[0.0, 0.0, (half_diagonal * 1e9).round() / 1e9]]);
}

#[test]
fn a_shared_edge_or_corner_or_a_gap_is_no_contact() {
    let base = cube(0.0, 0.0, 0.0);
    for (x, y, z) in [(1.0, 0.0, 1.0), (1.0, 1.0, 1.0), (1.0, 0.5, 1.0), (0.0, 0.0, 1.00001), (0.0, 0.0, 0.9)] {
        assert_eq!(contact(&cube(x, y, z), &base, TOUCH), None, "{x} {y} {z}");
    }
    // Pivoting about the shared edge.
    for degrees in [1.5f64, 15.0, 45.0, 89.0, 120.0] {
        let turn =
            Motion::Rotation { centre: Vec3::new(0.5, 0.0, 0.5), axis: Vec3::y_axis(), angle: degrees.to_radians() };
        let pivoting = cuboid(Vec3::repeat(0.5), turn.pose(&Pose::translation(0.0, 0.0, 1.0), 1.0));
        assert_eq!(contact(&pivoting, &base, TOUCH), None, "{degrees}");
    }
}

#[test]
fn the_ground_carries_what_reaches_it() {
    let flat = ground_contact(&cube(0.0, 0.0, 0.75), 0.25, TOUCH).unwrap();
    assert_eq!(sorted(&flat), [[-0.5, -0.5, 0.25], [-0.5, 0.5, 0.25], [0.5, -0.5, 0.25], [0.5, 0.5, 0.25]]);
    let on_edge = turned(cube(0.0, 0.0, 0.5f64.sqrt()), Vec3::x(), std::f64::consts::FRAC_PI_4);
    assert_eq!(sorted(&ground_contact(&on_edge, 0.0, TOUCH).unwrap()), [[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]]);
    assert_eq!(ground_contact(&cube(0.0, 0.0, 0.501), 0.0, TOUCH), None);
    assert_eq!(ground_contact(&cube(0.0, 0.0, 0.499), 0.0, TOUCH), None);
}

#[test]
fn the_broad_phase_finds_what_touches_in_a_block() {
    let cells = |i: usize| cube((i % 4) as f64, (i / 4 % 4) as f64, (i / 16) as f64);
    let solids: Vec<_> = (0..64).map(cells).collect();
    let broad_phase = BroadPhase::new(solids.clone());
    for solid in &solids {
        let found: Vec<_> = broad_phase.near(solid, TOUCH).into_iter().map(|(i, _)| i).collect();
        let near = |i: &usize| (solids[*i].centre() - solid.centre()).amax() <= 1.0;
        assert_eq!(found, (0..64).filter(near).collect::<Vec<_>>());
    }
    assert_eq!(BroadPhase::new(Vec::new()).near(&solids[0], TOUCH), []);
}

#[test]
fn modules_in_their_environment_are_found() {
    let mut configuration = crate::robot::Configuration {
        catalogue: std::sync::Arc::new(crate::robot::Catalogue::cube()),
        gravity: Vec3::zeros(),
        environment: Default::default(),
        modules: Vec::new(),
        connections: Vec::new(),
        loads: Vec::new(),
        require: Default::default(),
    };
    for (i, cell) in [[0, 0, 0], [1, 0, 0], [0, 0, -1]].into_iter().enumerate() {
        let placement = crate::robot::Placement::new(cell);
        configuration.modules.push(crate::robot::Module { id: i.to_string(), module_type: 0, placement, fixed: false });
    }
    configuration.environment.ground = Some(crate::robot::Ground { height: 0.0, friction: 0.5 });
    // A block beyond module 1 that touches it, and one that reaches into it.
    for x in [0.11, 0.105] {
        let shape = Shape::Cuboid { half_extents: Vec3::repeat(0.01) };
        let pose = Pose::translation(x, 0.025, 0.025);
        configuration.environment.obstacles.push(crate::robot::Obstacle { shape: shape.into(), pose, friction: 0.5 });
    }
    let found: Vec<_> = environment_problems(&configuration).into_iter().map(|p| (p.part, p.fault)).collect();
    use crate::robot::{Fault, Part};
    assert_eq!(
        found,
        [(Part::Module(1), Fault::InsideObstacle { obstacle: 1 }), (Part::Module(2), Fault::BelowGround)]
    );
}

/// Cells, in the plane of the motion, that a cube needs free to pivot: the cube is at
/// (0, 1) on a supporter at (0, 0) and turns about the edge between (0, 0), (0, 1), (1, 0), (1, 1).
/// Its far corner runs on a circle of radius sqrt 2 about that edge.
const QUARTER: &[[i32; 2]] = &[[0, 2], [1, 2], [1, 1]];
const HALF: &[[i32; 2]] = &[[0, 2], [1, 2], [1, 1], [2, 1], [2, 0], [1, 0]];

#[test]
fn a_pivot_needs_the_cells_of_the_textbook_stencil_and_no_others() {
    let axes = [Vec3::x(), Vec3::y(), Vec3::z(), -Vec3::x(), -Vec3::y(), -Vec3::z()];
    for (stencil, angle) in [(QUARTER, 90f64), (HALF, 180.0)] {
        for up in axes {
            for along in axes.into_iter().filter(|along| along.dot(&up) == 0.0) {
                let side = up.cross(&along);
                let motion = Motion::Rotation {
                    centre: (up + along) * 0.5,
                    axis: Unit::new_normalize(side),
                    angle: angle.to_radians(),
                };
                let at = |d: i32, s: i32, u: i32| along * f64::from(d) + side * f64::from(s) + up * f64::from(u);
                let solid = |c: Vec3| cube(c.x, c.y, c.z);
                for (d, s, u) in (-2..=3).flat_map(|d| (-1..=1).flat_map(move |s| (-1..=3).map(move |u| (d, s, u)))) {
                    if (d, s, u) == (0, 0, 1) {
                        continue;
                    }
                    let hit = first_collision(&solid(up), &motion, &solid(at(d, s, u)));
                    let needed = s == 0 && stencil.contains(&[d, u]);
                    assert_eq!(hit.is_some(), needed, "up {up:?} along {along:?} cell {d} {s} {u} hit {hit:?}");
                }
            }
        }
    }
}

#[test]
fn the_ground_stops_a_pivot_at_the_angle_of_its_lowest_corner() {
    let pivot =
        Motion::Rotation { centre: Vec3::new(0.5, 0.0, 0.0), axis: Vec3::y_axis(), angle: std::f64::consts::PI };
    // From on top of a cube to beside it: nothing passes lower than at the end.
    assert_eq!(ground(-1.0).first_collision(&cube(0.0, 0.0, 0.5), &pivot), None);
    // The corner straight above the edge is first at -0.5, after 120 degrees.
    let (phase, what) = ground(-0.5).first_collision(&cube(0.0, 0.0, 0.5), &pivot).unwrap();
    assert_eq!(what, Surrounding::Ground);
    assert!((phase - 120.0 / 180.0).abs() < 1e-3, "{phase}");
}

#[test]
fn faces_that_slide_along_each_other_do_not_collide() {
    let mut tunnel: Vec<_> = (0..5)
        .flat_map(|x| [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)].map(|(y, z)| cube(f64::from(x), y, z)))
        .collect();
    let slide = Motion::Translation { by: Vec3::new(4.0, 0.0, 0.0) };
    let around = |solids: &[Solid]| {
        let obstacle = |solid: &Solid| crate::robot::Obstacle {
            shape: solid.shape.clone().into(),
            pose: solid.pose,
            friction: 0.5,
        };
        let ground = Some(Ground { height: -0.5, friction: 0.5 });
        Surroundings::new(&Environment {
            ground,
            obstacles: solids.iter().map(obstacle).collect(),
            ..Environment::default()
        })
    };
    assert_eq!(around(&tunnel).first_collision(&cube(0.0, 0.0, 0.0), &slide), None);
    tunnel.push(cube(3.0, 0.0, 0.0));
    let (phase, what) = around(&tunnel).first_collision(&cube(0.0, 0.0, 0.0), &slide).unwrap();
    assert_eq!(what, Surrounding::Obstacle(20));
    assert!((phase - 0.5).abs() < 1e-3, "{phase}");
}

proptest! {
    #[test]
    fn overlap_agrees_with_parry(a in any_cuboid(1.5), b in any_cuboid(1.5)) {
        let distance = parry_distance(&a, &b);
        if distance > 1e-6 {
            prop_assert!(!overlap(&a, &b, 0.0));
        } else {
            prop_assert!(overlap(&a, &b, -1e-6));
        }
    }

    #[test]
    fn no_direction_parts_solids_sooner_than_their_penetration(
        a in any_cuboid(0.8), b in any_cuboid(0.8), directions in prop::collection::vec(any_vector(1.0), 100),
    ) {
        let depth = penetration(&a, &b);
        let apart = a.centre() - b.centre();
        let overlap_along = |n: &Vec3| {
            let projection = |solid: &Solid| solid.vertices().iter().map(|p| p.dot(n)).fold(f64::NEG_INFINITY, f64::max);
            let lowest_a = a.vertices().iter().map(|p| p.dot(n)).fold(f64::INFINITY, f64::min);
            projection(&b) - lowest_a
        };
        let ((sa, pa), (sb, pb)) = (parry(&a), parry(&b));
        let found = query::contact(&pa, &sa, &pb, &sb, 0.0).unwrap().map(|c| -Vec3::new(c.normal1.x, c.normal1.y, c.normal1.z));
        for n in directions.into_iter().filter(|n| n.norm() > 0.1).chain(found).chain([apart]) {
            prop_assert!(depth <= overlap_along(&n.normalize()).max(0.0) + 1e-12, "{depth} along {n}");
        }
    }

    #[test]
    fn contact_points_lie_on_both_solids(a in any_cuboid(0.5), b in any_cuboid(0.5), towards in any_vector(1.0)) {
        prop_assume!(towards.norm() > 0.1);
        // Far away, then along the shortest way until they touch.
        let away = Pose::from(nalgebra::Translation3::from(towards.normalize() * 6.0));
        let far = Solid::new(a.shape, away * a.pose);
        let ((sa, pa), (sb, pb)) = (parry(&far), parry(&b));
        let query::ClosestPoints::WithinMargin(on_a, on_b) =
            query::closest_points(&pa, &sa, &pb, &sb, 100.0).unwrap() else { panic!("within the margin") };
        let step = Vec3::new(on_b.x - on_a.x, on_b.y - on_a.y, on_b.z - on_a.z);
        let near = Solid::new(far.shape, Pose::from(nalgebra::Translation3::from(step)) * far.pose);

        // A corner on a corner or on an edge touches along no one direction.
        let close = || separations(&near, &b).into_iter().filter(|s| s.gap > -10.0 * TOUCH).map(|s| s.normal);
        let direction = -step.normalize();
        let unique = close().count() > 0 && close().all(|n| (n - direction).norm() < 1e-6);
        let Some(patch) = contact(&near, &b, TOUCH) else {
            prop_assert!(!unique, "solids that touch along one direction have a contact");
            return Ok(());
        };
        prop_assert!((patch.normal.norm() - 1.0).abs() < 1e-12);
        prop_assert!((patch.normal + step.normalize()).norm() < 1e-5);
        for p in &patch.points {
            prop_assert!(outside(&near, p).abs() < 2.0 * TOUCH && outside(&b, p).abs() < 2.0 * TOUCH);
        }
        let swapped = contact(&b, &near, TOUCH).expect("touching is mutual");
        prop_assert!((swapped.normal + patch.normal).norm() < 1e-12);
        prop_assert_eq!(swapped.points.len(), patch.points.len());
    }

    #[test]
    fn sweeps_agree_with_dense_sampling(a in any_cuboid(2.0), b in any_cuboid(2.0), motion in any_motion()) {
        let skin = SKIN * a.size();
        let hit = first_collision(&a, &motion, &b);
        let depth = |phase: f64| penetration(&Solid::new(a.shape.clone(), motion.pose(&a.pose, phase)), &b);
        // A start that overlaps is a hit at 0, however deep.
        let until = hit.unwrap_or(1.0);
        for i in (0..=400).take_while(|_| until > 0.0) {
            let phase = until * f64::from(i) / 400.0;
            prop_assert!(depth(phase) <= 3f64.sqrt() * skin + 1e-12, "depth {} at {phase}, hit {hit:?}", depth(phase));
        }
        if let Some(phase) = hit {
            prop_assert!(depth(phase) >= 0.99 * skin, "depth {} at {phase}", depth(phase));
            prop_assert!(parry_distance(&Solid::new(a.shape.clone(), motion.pose(&a.pose, phase)), &b) == 0.0);
        }
    }

    #[test]
    fn sweeps_of_touching_cubes_agree_with_dense_sampling(
        cell in prop::array::uniform3(-1i32..=1), other in prop::array::uniform3(-1i32..=1), motion in any_motion(),
    ) {
        prop_assume!(cell != other);
        let [a, b] = [cell, other].map(|c| cube(f64::from(c[0]), f64::from(c[1]), f64::from(c[2])));
        let hit = first_collision(&a, &motion, &b);
        let depth = |phase: f64| penetration(&Solid::new(a.shape.clone(), motion.pose(&a.pose, phase)), &b);
        // A start that overlaps is a hit at 0, however deep.
        let until = hit.unwrap_or(1.0);
        for i in (0..=400).take_while(|_| until > 0.0) {
            prop_assert!(depth(until * f64::from(i) / 400.0) <= 3f64.sqrt() * SKIN * a.size() + 1e-12);
        }
        prop_assert!(hit.is_none_or(|phase| depth(phase) >= 0.99 * SKIN * a.size()));
    }

    #[test]
    fn ground_hits_agree_with_dense_sampling(a in any_cuboid(1.0), motion in any_motion(), height in -3.0..0.0) {
        let hit = ground(height).first_collision(&a, &motion).map(|(phase, _)| phase);
        let depth = |phase: f64| {
            let now = Solid::new(a.shape.clone(), motion.pose(&a.pose, phase));
            height - now.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min)
        };
        // A start that overlaps is a hit at 0, however deep.
        let until = hit.unwrap_or(1.0);
        for i in (0..=400).take_while(|_| until > 0.0) {
            prop_assert!(depth(until * f64::from(i) / 400.0) <= 3f64.sqrt() * SKIN * a.size() + 1e-9);
        }
        prop_assert!(hit.is_none_or(|phase| depth(phase) >= 0.99 * SKIN * a.size() - 1e-9));
    }
}
