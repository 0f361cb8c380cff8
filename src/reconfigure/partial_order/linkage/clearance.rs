//! Whether bodies that several moves under way carry stay clear of each other and of what rests, whatever the phases.
//!
//! Where only one of the moves changes how two bodies lie to each other, the sweep of that move has said so already.
//! For all others the product of the phases is divided into boxes. In a box no point of a body is farther from where
//! it is in the middle than its *reach*: the lengths of the arcs that are left, each about its own line. A box is
//! clear if the bodies in the middle are farther apart than they reach, or penetrate by no more than what touches
//! may ([`SKIN`]); else it is halved along the turn that reaches farthest. What is not proved clear after so many
//! boxes, e.g. faces that slide along each other while both move, counts as a collision: never optimistic.
//!
//! Knows solids and turns; knows neither what holds nor forces.

use std::collections::VecDeque;

use rayon::prelude::*;

use crate::geometry::{Motion, SKIN, Solid, Surroundings, overlap};
use crate::reconfigure::linkage::assembly::BodyOf;
use crate::robot::linkage::Linkage;
use crate::spatial::Vec3;

use super::nesting::Nesting;

/// Boxes after which two bodies count as colliding. Two that touch at the start and swing apart take some hundreds.
const MOST_BOXES: usize = 4000;

/// The phases of all turns in a box: its middle and half of its widths.
#[derive(Clone, Debug)]
pub(super) struct Phases {
    middle: Vec<f64>,
    half: Vec<f64>,
}

/// What is known of a box.
enum Look {
    /// It is clear throughout.
    Clear,
    /// In its middle something overlaps.
    Hit,
    /// Unsure: to be halved along this turn.
    Halve(usize),
}

/// A body and the turns that move it against another.
pub(super) struct Carried<'m> {
    /// Before any of them.
    pub(super) solid: Solid,
    /// Which of the turns under way these are, outermost first, and how they go by themselves.
    pub(super) turns: Vec<(usize, &'m Motion)>,
}

/// A body in the middle of a box.
struct Within {
    solid: Solid,
    /// Distance in m that no point of it is farther from there.
    reach: f64,
    /// The turn that most of that is by, and how much.
    most: (f64, usize),
}

/// Whether everything stays clear while the moves of a nesting are under way out of a state. Each of them by
/// itself must be free of collision.
pub fn is_clear(state: &Linkage, nesting: &Nesting, surroundings: [&Surroundings; 2]) -> bool {
    let poses: Vec<_> = (0..state.modules.len()).map(|module| state.body_poses(module)).collect();
    let carried = |body: BodyOf, turns: &[usize]| {
        let kind = &state.module_type(body.module).bodies[body.body];
        let pose = poses[body.module][body.body] * kind.shape_pose;
        let turns = turns.iter().map(|&turn| (turn, nesting.motion(turn))).collect();
        Carried { solid: Solid::new(kind.shape.clone(), pose), turns }
    };
    let all = Phases::all(nesting.turns());
    let bodies = nesting.bodies();
    let among_bodies = (0..bodies.len()).into_par_iter().all(|second| {
        (0..second).all(|first| {
            let [a, b] = nesting.between(bodies[first], bodies[second]);
            a.len() + b.len() < 2 || are_clear(&carried(bodies[first], a), &carried(bodies[second], b), &all)
        })
    });
    among_bodies
        && bodies.par_iter().all(|&body| {
            let turns = nesting.carriers(body);
            turns.len() < 2 || is_clear_of(&carried(body, turns), surroundings, &all)
        })
}

/// Whether two bodies stay clear of each other at all of some phases.
pub(super) fn are_clear(a: &Carried, b: &Carried, all: &Phases) -> bool {
    let skin = SKIN * a.solid.size().min(b.solid.size());
    let radii = radius(&a.solid) + radius(&b.solid);
    holds_throughout(all, |phases| {
        let (one, other) = (a.within(phases), b.within(phases));
        let reach = one.reach + other.reach;
        let far = (one.solid.centre() - other.solid.centre()).norm() > radii + reach;
        if far || !overlap(&one.solid, &other.solid, skin - reach) {
            Look::Clear
        } else if overlap(&one.solid, &other.solid, skin) {
            Look::Hit
        } else {
            Look::Halve(if one.most.0 >= other.most.0 { one.most.1 } else { other.most.1 })
        }
    })
}

/// Whether a body stays clear of what surrounds the robot at all of some phases.
pub(super) fn is_clear_of(body: &Carried, surroundings: [&Surroundings; 2], all: &Phases) -> bool {
    let skin = SKIN * body.solid.size();
    holds_throughout(all, |phases| {
        let now = body.within(phases);
        let is_free = |solid: &Solid| surroundings.iter().all(|part| part.overlaps(solid, skin).is_empty());
        if is_free(&now.solid.grown(now.reach)) {
            Look::Clear
        } else if !is_free(&now.solid) {
            Look::Hit
        } else {
            Look::Halve(now.most.1)
        }
    })
}

/// Whether all of some phases are clear, box by box, the largest first.
fn holds_throughout(all: &Phases, look: impl Fn(&Phases) -> Look) -> bool {
    let mut boxes = VecDeque::from([all.clone()]);
    let mut looked = 0;
    while let Some(phases) = boxes.pop_front() {
        looked += 1;
        match look(&phases) {
            Look::Clear => {}
            Look::Halve(turn) if looked < MOST_BOXES => boxes.extend(phases.halved(turn)),
            Look::Hit | Look::Halve(_) => return false,
        }
    }
    true
}

impl Phases {
    /// From 0 to 1 for each of so many turns.
    pub(super) fn all(turns: usize) -> Self {
        Self { middle: vec![0.5; turns], half: vec![0.5; turns] }
    }

    /// The two halves along a turn.
    fn halved(&self, turn: usize) -> [Self; 2] {
        [-0.5, 0.5].map(|side| {
            let mut half = self.clone();
            half.middle[turn] += side * self.half[turn];
            half.half[turn] /= 2.0;
            half
        })
    }
}

impl Carried<'_> {
    /// Where it is in a box of phases.
    fn within(&self, phases: &Phases) -> Within {
        let mut now = Within { solid: self.solid.clone(), reach: 0.0, most: (f64::NEG_INFINITY, 0) };
        for &(turn, motion) in self.turns.iter().rev() {
            // Points that inner turns have led astray go round on wider circles.
            let by = (widest_circle(&now.solid, motion) + now.reach) * angle(motion) * phases.half[turn];
            now.reach += by;
            if by > now.most.0 {
                now.most = (by, turn);
            }
            now.solid.pose = motion.pose(&now.solid.pose, phases.middle[turn]);
        }
        now
    }
}

/// Angle of a turn in rad; infinite for what is none.
fn angle(motion: &Motion) -> f64 {
    match motion {
        Motion::Rotation { angle, .. } => angle.abs(),
        Motion::Translation { .. } => f64::INFINITY,
    }
}

/// Radius in m of the widest circle on which a point of a solid goes, or more.
fn widest_circle(solid: &Solid, motion: &Motion) -> f64 {
    let Motion::Rotation { centre, axis, .. } = motion else { return f64::INFINITY };
    let from_axis = |point: &Vec3| axis.cross(&(point - centre)).norm();
    match solid.shape.ball_radius() {
        Some(radius) => from_axis(&solid.centre()) + radius,
        None => solid.vertices().iter().map(from_axis).fold(0.0, f64::max),
    }
}

/// Distance in m of the farthest point of a solid from its centre, or more.
fn radius(solid: &Solid) -> f64 {
    let centre = solid.centre();
    let corners = || solid.vertices().iter().map(|corner| (corner - centre).norm()).fold(0.0, f64::max);
    solid.shape.ball_radius().unwrap_or_else(corners)
}
