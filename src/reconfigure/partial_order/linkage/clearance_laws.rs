//! What is called clear is: against dense sampling of the phases, for all shapes, turns beside and within each other.

use std::sync::Arc;

use nalgebra::Unit;
use proptest::prelude::*;

use crate::geometry::{Motion, SKIN, Solid, Surroundings, overlap};
use crate::robot::{Environment, Ground, Hull, Obstacle, Shape, Terrain};
use crate::spatial::{Pose, Rotation, Vec3};

use super::clearance::{Carried, Phases, are_clear, is_clear_of};

/// Phases that are looked at along each turn.
const GRID: u32 = 12;

fn any_vector(range: f64) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-range..range).prop_map(Vec3::from)
}

fn any_solid() -> impl Strategy<Value = Solid> {
    let size = || 0.1..0.6;
    let hull = prop::collection::vec(any_vector(0.6), 4..10).prop_filter_map("too thin", |points| {
        let hull = Hull::new(points).ok()?;
        (hull.inner_radius() > 0.03).then(|| Shape::Convex(Arc::new(hull)))
    });
    let shape = prop_oneof![
        prop::array::uniform3(size()).prop_map(|half| Shape::Cuboid { half_extents: Vec3::from(half) }),
        (size(), 0.2..1.2).prop_map(|(radius, height)| Shape::Cylinder { radius, height }),
        size().prop_map(|radius| Shape::Ball { radius }),
        hull,
    ];
    (shape, any_vector(2.0), any_vector(3.0))
        .prop_map(|(shape, at, turn)| Solid::new(shape, Pose::from_parts(at.into(), Rotation::from_scaled_axis(turn))))
}

fn any_turn() -> impl Strategy<Value = Motion> {
    let axis = any_vector(1.0).prop_filter_map("too short", |v| Unit::try_new(v, 0.1));
    (any_vector(1.5), axis, -2.0..2.0).prop_map(|(centre, axis, angle)| Motion::Rotation { centre, axis, angle })
}

/// A solid at the phases of the turns that carry it.
fn at(carried: &Carried, phases: &[f64]) -> Solid {
    let by = carried.turns.iter().fold(Pose::identity(), |by, (turn, motion)| by * motion.at(phases[*turn]));
    Solid::new(carried.solid.shape.clone(), by * carried.solid.pose)
}

fn grid() -> impl Iterator<Item = [f64; 2]> {
    let phase = |i: u32| f64::from(i) / f64::from(GRID);
    (0..=GRID).flat_map(move |i| (0..=GRID).map(move |j| [phase(i), phase(j)]))
}

/// What a body may penetrate and still be clear, with some room for rounding.
fn skin(a: &Solid) -> f64 {
    1.01 * SKIN * a.size()
}

/// Of some cases, how many were called clear, and how many of those that never come near each other were not.
#[derive(Default)]
struct Told {
    clear: usize,
    missed: usize,
    far: usize,
}

#[test]
fn what_is_clear_never_overlaps_and_what_is_far_is_clear() {
    let told = std::cell::RefCell::new(Told::default());
    let config = ProptestConfig { cases: 120, ..ProptestConfig::default() };
    let all = (any_solid(), any_solid(), any_turn(), any_turn(), 0..3_usize);
    let mut runner = proptest::test_runner::TestRunner::new(config);
    let outcome = runner.run(&all, |(a, b, one, other, split)| {
        let turns = [(0, &one), (1, &other)];
        let a = Carried { solid: a, turns: turns[..split].to_vec() };
        let b = Carried { solid: b, turns: turns[split..].to_vec() };
        let is_clear = are_clear(&a, &b, &Phases::all(2));
        let hit = |skin: f64| grid().any(|phases| overlap(&at(&a, &phases), &at(&b, &phases), skin));
        prop_assert!(!is_clear || !hit(skin(&a.solid).max(skin(&b.solid))));
        let mut told = told.borrow_mut();
        let is_far = !hit(-1.0);
        told.clear += usize::from(is_clear);
        told.far += usize::from(is_far);
        told.missed += usize::from(is_far && !is_clear);
        Ok(())
    });
    outcome.expect("the law holds");
    let told = told.into_inner();
    assert!(told.missed == 0 && told.far > 5 && told.clear > told.far, "{} {} {}", told.clear, told.far, told.missed);
}

#[test]
fn what_is_clear_of_its_surroundings_never_overlaps_them() {
    let clear = std::cell::Cell::new(0);
    let config = ProptestConfig { cases: 120, ..ProptestConfig::default() };
    let all = (any_solid(), any_solid(), any_turn(), any_turn());
    let mut runner = proptest::test_runner::TestRunner::new(config);
    let outcome = runner.run(&all, |(body, block, one, other)| {
        let environment = Environment {
            ground: Some(Ground { height: -1.5, friction: 0.5 }),
            obstacles: vec![Obstacle { shape: Terrain::Solid(block.shape.clone()), pose: block.pose, friction: 0.5 }],
            ..Environment::default()
        };
        let [around, nothing] = [&environment, &Environment::default()].map(Surroundings::new);
        let body = Carried { solid: body, turns: vec![(0, &one), (1, &other)] };
        let is_clear = is_clear_of(&body, [&around, &nothing], &Phases::all(2));
        clear.set(clear.get() + usize::from(is_clear));
        let skin = skin(&body.solid);
        prop_assert!(!is_clear || grid().all(|phases| around.overlaps(&at(&body, &phases), skin).is_empty()));
        Ok(())
    });
    outcome.expect("the law holds");
    assert!(clear.get() > 10, "{}", clear.get());
}

#[test]
fn what_touches_and_swings_apart_is_clear_and_what_slides_along_is_not_proved() {
    let block = |x: f64| Solid::new(Shape::Cuboid { half_extents: Vec3::repeat(0.1) }, Pose::translation(x, 0.0, 0.0));
    let about =
        |centre: Vec3, axis: Vec3, angle: f64| Motion::Rotation { centre, axis: Unit::new_normalize(axis), angle };
    // Two blocks side by side, each on a hinge beyond and above it, swing away from each other.
    let apart = [about(Vec3::new(-0.2, 0.0, 0.3), Vec3::y(), 1.0), about(Vec3::new(0.2, 0.0, 0.3), Vec3::y(), -1.0)];
    let clear = |turns: &[Motion; 2]| {
        let [a, b] =
            [0, 1].map(|i| Carried { solid: block(if i == 0 { -0.1 } else { 0.1 }), turns: vec![(i, &turns[i])] });
        are_clear(&a, &b, &Phases::all(2))
    };
    assert!(clear(&apart));
    // They turn about the normal of the face that they share.
    let along = [1.0, -1.0].map(|angle| about(Vec3::zeros(), Vec3::x(), angle));
    assert!(!clear(&along));
    // They swing into each other.
    let [a, b] = apart.map(|turn| match turn {
        Motion::Rotation { centre, axis, angle } => Motion::Rotation { centre, axis, angle: -angle },
        Motion::Translation { .. } => turn,
    });
    assert!(!clear(&[a, b]));
}
