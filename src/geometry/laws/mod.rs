//! Laws of contacts, overlap and sweeps of all shapes: against parry's distances, against
//! dense sampling, and of each way to say a shape against the others.

mod terrain;

use std::sync::Arc;

use nalgebra::{Unit, UnitQuaternion};
use parry3d_f64::query;
use parry3d_f64::shape::SharedShape;
use proptest::prelude::*;

use super::figure::Figure;
use super::separation::separations;
use super::*;
use crate::robot::{Hull, Shape};
use crate::spatial::{Point, Pose, Rotation, Vec3};

/// The shape in parry's words, whose cylinders stand along y.
fn parry(solid: &Solid) -> (SharedShape, parry3d_f64::math::Pose) {
    let upright = Rotation::from_axis_angle(&Vec3::x_axis(), std::f64::consts::FRAC_PI_2);
    let (shape, turn) = match &solid.shape {
        Shape::Cuboid { half_extents: h } => (SharedShape::cuboid(h.x, h.y, h.z), Rotation::identity()),
        Shape::Cylinder { radius, height } => (SharedShape::cylinder(height / 2.0, *radius), upright),
        Shape::Ball { radius } => (SharedShape::ball(*radius), Rotation::identity()),
        Shape::Convex(hull) => {
            let points: Vec<_> = hull.points().iter().map(|p| [p.x, p.y, p.z].into()).collect();
            (SharedShape::convex_hull(&points).expect("it has volume"), Rotation::identity())
        }
    };
    let pose = solid.pose * Pose::from_parts(Vec3::zeros().into(), turn);
    let p = pose.translation.vector;
    let turn = pose.rotation.scaled_axis();
    (shape, parry3d_f64::math::Pose::new([p.x, p.y, p.z].into(), [turn.x, turn.y, turn.z].into()))
}

/// Distance and the shortest way from the first to the second; nothing when they overlap.
fn way(a: &Solid, b: &Solid) -> Option<Vec3> {
    let ((sa, pa), (sb, pb)) = (parry(a), parry(b));
    match query::closest_points(&pa, &*sa, &pb, &*sb, 100.0).unwrap() {
        query::ClosestPoints::WithinMargin(on_a, on_b) => {
            Some(Vec3::new(on_b.x - on_a.x, on_b.y - on_a.y, on_b.z - on_a.z))
        }
        query::ClosestPoints::Intersecting => None,
        query::ClosestPoints::Disjoint => panic!("within the margin"),
    }
}

/// How far a point is outside a solid, along the worst of its faces; negative inside.
fn outside(solid: &Solid, p: &Vec3) -> f64 {
    let q = solid.pose.inverse_transform_point(&Point::from(*p)).coords;
    match &solid.shape {
        Shape::Cuboid { half_extents } => (q.abs() - half_extents).max(),
        Shape::Cylinder { radius, height } => (q.xy().norm() - radius).max(q.z.abs() - height / 2.0),
        Shape::Ball { radius } => q.norm() - radius,
        Shape::Convex(hull) => {
            hull.faces().iter().map(|f| f.normal.dot(&q) - f.offset).fold(f64::NEG_INFINITY, f64::max)
        }
    }
}

fn moved(solid: &Solid, by: &Pose) -> Solid {
    Solid::new(solid.shape.clone(), by * solid.pose)
}

fn shifted(solid: &Solid, by: Vec3) -> Solid {
    moved(solid, &Pose::translation(by.x, by.y, by.z))
}

/// The first solid moved away along `towards` and back until it touches the second.
fn brought_to_touch(a: &Solid, b: &Solid, towards: &Vec3) -> (Solid, Vec3) {
    let far = shifted(a, towards.normalize() * 8.0);
    let step = way(&far, b).expect("far away");
    (shifted(&far, step), step.normalize())
}

fn any_vector(range: f64) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-range..range).prop_map(Vec3::from)
}

fn any_direction() -> impl Strategy<Value = Vec3> {
    any_vector(1.0).prop_filter_map("too short", |v| v.try_normalize(0.1))
}

fn any_rotation() -> impl Strategy<Value = Rotation> {
    prop::array::uniform4(-1.0..1.0).prop_filter_map("too short", |q: [f64; 4]| {
        let q = nalgebra::Quaternion::from(q);
        (q.norm() > 0.1).then(|| UnitQuaternion::new_normalize(q))
    })
}

fn any_pose(range: f64) -> impl Strategy<Value = Pose> {
    (any_vector(range), any_rotation()).prop_map(|(at, rotation)| Pose::from_parts(at.into(), rotation))
}

fn any_shape() -> impl Strategy<Value = Shape> {
    let size = || 0.2..1.0;
    let hull = prop::collection::vec(any_vector(1.0), 4..12).prop_filter_map("too thin", |points| {
        let hull = Hull::new(points).ok()?;
        (hull.inner_radius() > 0.05).then(|| Shape::Convex(Arc::new(hull)))
    });
    prop_oneof![
        prop::array::uniform3(size()).prop_map(|half| Shape::Cuboid { half_extents: Vec3::from(half) }),
        (size(), 0.4..2.0).prop_map(|(radius, height)| Shape::Cylinder { radius, height }),
        size().prop_map(|radius| Shape::Ball { radius }),
        hull,
    ]
}

fn any_solid(range: f64) -> impl Strategy<Value = Solid> {
    (any_shape(), any_pose(range)).prop_map(|(shape, pose)| Solid::new(shape, pose))
}

fn any_motion() -> impl Strategy<Value = Motion> {
    let translation = any_vector(4.0).prop_map(|by| Motion::Translation { by });
    let rotation = (any_vector(2.0), any_direction(), -6.0..6.0).prop_map(|(centre, axis, angle)| Motion::Rotation {
        centre,
        axis: Unit::new_normalize(axis),
        angle,
    });
    prop_oneof![translation, rotation]
}

fn corners(half: &Vec3) -> Vec<Vec3> {
    let c = |i: usize, bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
    (0..8).map(|i| half.component_mul(&Vec3::new(c(i, 1), c(i, 2), c(i, 4)))).collect()
}

/// Whether two sets of points are the same within a distance.
fn same_points(a: &[Vec3], b: &[Vec3], within: f64) -> bool {
    let covered = |a: &[Vec3], b: &[Vec3]| a.iter().all(|p| b.iter().any(|q| (p - q).norm() <= within));
    covered(a, b) && covered(b, a)
}

/// Deepest penetration that a sweep may let pass, by the shape that moves.
fn let_pass(solid: &Solid) -> f64 {
    let skin = SKIN * solid.size();
    match &solid.shape {
        Shape::Cuboid { .. } => 3f64.sqrt() * skin,
        // A skin inwards, the rim's corner diagonally, and the sides of the prism.
        Shape::Cylinder { .. } => 2.5 * skin,
        Shape::Ball { .. } => 1.01 * skin,
        Shape::Convex(hull) => {
            let reach = hull.corners().iter().map(|p| (p - hull.centre()).norm()).fold(0.0, f64::max);
            1.01 * skin * reach / hull.inner_radius()
        }
    }
}

/// Whether a solid reaches a depth into another, by parry's distance of smaller copies.
fn is_deeper(a: &Solid, b: &Solid, depth: f64) -> bool {
    way(&a.shrunk(depth), b).is_none_or(|way| way.norm() < 1e-9)
}

/// Whether solids that touch along `normal` are as far apart along a direction close to it, so that no
/// one normal is sure. All that is round here is rounder than a radius of 0.2, whose gap falls by a tenth of the squared angle.
fn touch_along_more(a: &Solid, b: &Solid, normal: &Vec3) -> bool {
    let candidates = separations(a, b);
    let (a, b) = (Figure::new(a), Figure::new(b));
    let u = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    let v = normal.cross(&u);
    let gap = |d: Vec3| -a.reach(&-d) - b.reach(&d);
    // Where a corner meets an edge, the normals are an arc, and its ends are among the candidates. So it is, almost, where a
    // rim runs along an edge: a ridge too narrow for the tilts below.
    let is_other = |d: &Vec3| {
        let apart = (d - normal).norm();
        apart > 1e-4 && gap(*d) > -(3.0 * TOUCH).max(0.05 * apart * apart)
    };
    if candidates.iter().any(|s| is_other(&s.normal)) {
        return true;
    }
    let around = |i: usize| (std::f64::consts::TAU * i as f64 / 32.0).sin_cos();
    [0.05, 0.02, 0.005, 0.001].iter().any(|angle: &f64| {
        let tilted = |i: usize| (normal + (u * around(i).0 + v * around(i).1) * angle.tan()).normalize();
        (0..32).any(|i| gap(tilted(i)) > -0.05 * angle * angle)
    })
}

proptest! {
    #[test]
    fn contact_points_lie_on_both_solids_and_contacts_are_mutual(
        a in any_solid(0.5), b in any_solid(0.5), towards in any_direction(), by in any_pose(3.0),
    ) {
        let (near, direction) = brought_to_touch(&a, &b, &towards);
        let is_one = !touch_along_more(&near, &b, &-direction);
        let Some(patch) = contact(&near, &b, TOUCH) else {
            prop_assert!(!is_one, "one normal, but no contact");
            return Ok(());
        };
        prop_assert!((patch.normal.norm() - 1.0).abs() < 1e-12);
        let gap = -Figure::new(&near).reach(&-patch.normal) - Figure::new(&b).reach(&patch.normal);
        prop_assert!(gap.abs() <= 2.0 * TOUCH, "gap {gap}");
        for p in &patch.points {
            prop_assert!(outside(&near, p).abs() < 3.0 * TOUCH, "{} outside the first", outside(&near, p));
            prop_assert!(outside(&b, p).abs() < 3.0 * TOUCH, "{} outside the second", outside(&b, p));
        }
        if !is_one {
            return Ok(());
        }
        prop_assert!((patch.normal + direction).norm() < 1e-3, "{} against {direction}", patch.normal);
        let swapped = contact(&b, &near, TOUCH).unwrap();
        prop_assert!((swapped.normal + patch.normal).norm() < 1e-4);
        prop_assert!(same_points(&swapped.points, &patch.points, 1e-4));
        let elsewhere = contact(&moved(&near, &by), &moved(&b, &by), TOUCH).unwrap();
        prop_assert!((elsewhere.normal - by.rotation * patch.normal).norm() < 1e-4);
        let turned: Vec<_> = patch.points.iter().map(|p| (by * Point::from(*p)).coords).collect();
        prop_assert!(same_points(&elsewhere.points, &turned, 1e-4));
    }

    #[test]
    fn solids_apart_or_deep_in_each_other_do_not_touch(a in any_solid(0.5), b in any_solid(0.5), towards in any_direction()) {
        let (near, direction) = brought_to_touch(&a, &b, &towards);
        prop_assert!(contact(&shifted(&near, -direction * 1e-5), &b, TOUCH).is_none());
        prop_assert!(!overlap(&near, &b, SKIN * near.size()));
        let deeper = shifted(&near, direction * 1e-4);
        // Of cylinders it is an upper bound.
        let is_cylinder = |solid: &Solid| matches!(solid.shape, Shape::Cylinder { .. });
        prop_assert!(is_cylinder(&a) || is_cylinder(&b) || penetration(&deeper, &b) <= 1e-4 + 1e-8);
        // A corner on a corner may pass by.
        if contact(&near, &b, TOUCH).is_some() {
            prop_assert!(contact(&deeper, &b, TOUCH).is_none());
            prop_assert!(overlap(&deeper, &b, TOUCH));
        }
    }

    #[test]
    fn a_hull_of_eight_corners_is_a_cuboid(
        half in prop::array::uniform3(0.2..1.0), pose in any_pose(1.0), other in any_solid(1.0), motion in any_motion(),
        towards in any_direction(),
    ) {
        let half = Vec3::from(half);
        let cuboid = Solid::new(Shape::Cuboid { half_extents: half }, pose);
        let hull = Solid::new(Shape::Convex(Arc::new(Hull::new(corners(&half)).unwrap())), pose);
        prop_assert!((penetration(&cuboid, &other) - penetration(&hull, &other)).abs() < 1e-6);
        let (near, _) = brought_to_touch(&other, &cuboid, &towards);
        let (of_cuboid, of_hull) = (contact(&near, &cuboid, TOUCH), contact(&near, &hull, TOUCH));
        prop_assert_eq!(of_cuboid.is_some(), of_hull.is_some());
        if let (Some(a), Some(b)) = (of_cuboid, of_hull) {
            prop_assert!((a.normal - b.normal).norm() < 1e-6 && same_points(&a.points, &b.points, 1e-6));
        }
        let hits = [&cuboid, &hull].map(|solid| first_collision(&other, &motion, solid));
        prop_assert!((hits[0].unwrap_or(2.0) - hits[1].unwrap_or(2.0)).abs() < 1e-3, "{hits:?}");
    }

    #[test]
    fn sweeps_of_all_shapes_agree_with_dense_sampling(a in any_solid(2.0), b in any_solid(2.0), motion in any_motion()) {
        let hit = first_collision(&a, &motion, &b);
        let now = |phase: f64| Solid::new(a.shape.clone(), motion.pose(&a.pose, phase));
        let until = hit.unwrap_or(1.0);
        for i in (0..=200).take_while(|_| until > 0.0) {
            let phase = until * f64::from(i) / 200.0;
            prop_assert!(!is_deeper(&now(phase), &b, let_pass(&a) + 1e-9), "at {phase} of {hit:?}");
        }
        if let Some(phase) = hit {
            prop_assert!(is_deeper(&now(phase), &b, 0.9 * SKIN * a.size()), "hit nothing at {phase}");
        }
    }
}

#[test]
fn a_ball_that_a_cylinder_rolls_around_is_never_hit() {
    // A strut on a node of the freeform robot: its cap touches the ball in one point all the way.
    let node = Solid::new(Shape::Ball { radius: 0.06 }, Pose::identity());
    let strut = Solid::new(Shape::Cylinder { radius: 0.04, height: 0.087 }, Pose::translation(0.0, 0.0, 0.1035));
    for angle in [0.1, 1.5, -3.0, 6.0] {
        let roll =
            Motion::Rotation { centre: Vec3::zeros(), axis: Unit::new_normalize(Vec3::new(1.0, 0.3, 0.1)), angle };
        assert_eq!(first_collision(&strut, &roll, &node), None, "{angle}");
        assert_eq!(first_collision(&node, &roll, &strut), None, "{angle}");
    }
    let through = Motion::Translation { by: Vec3::new(0.0, 0.0, -0.05) };
    assert!(first_collision(&strut, &through, &node).is_some());
}
