//! What the bodies of a moving side hit on their way.
//!
//! Knows solids; knows neither what holds nor forces.

use crate::geometry::{Motion, Solid, Surroundings, first_collision};
use crate::robot::Shape;
use crate::spatial::Vec3;

use super::action::Action;
use super::moves::{Step, View};
use super::problem::Problem;

/// Collisions of the robots of one problem.
#[derive(Debug)]
pub struct Clearance {
    around: Surroundings,
    off_limits: Surroundings,
}

/// A body in W.
struct Body {
    module: usize,
    body: usize,
    solid: Solid,
    /// Distance of its farthest point from its solid's centre, in m.
    radius: f64,
}

impl Clearance {
    /// Of robots in the environment of a problem's start.
    pub fn new(problem: &Problem) -> Self {
        Self {
            around: Surroundings::new(&problem.start.environment),
            off_limits: Surroundings::new(&problem.start.require.off_limits()),
        }
    }

    /// Whether nothing is hit and no forbidden region passed during a move. Bodies that a joint or the rolling connection holds together do not hit
    /// each other.
    pub fn is_free(&self, view: &View, step: &Step) -> bool {
        let (moving, resting): (Vec<Body>, Vec<Body>) =
            bodies(view).partition(|body| view.moves(step, body.module, body.body));
        moving.iter().all(|mover| {
            let may_hit = |other: &&Body| may_meet(mover, other, &step.motion) && !held(view, step, mover, other);
            let mut near = resting.iter().filter(may_hit);
            near.all(|other| first_collision(&mover.solid, &step.motion, &other.solid).is_none())
                && [&self.around, &self.off_limits]
                    .iter()
                    .all(|part| part.first_collision(&mover.solid, &step.motion).is_none())
        })
    }
}

fn bodies<'a>(view: &'a View) -> impl Iterator<Item = Body> + 'a {
    view.modules.iter().enumerate().flat_map(move |(module, place)| {
        let kinds = &view.kind(module).bodies;
        kinds.iter().zip(place.bodies.iter()).enumerate().map(move |(body, (kind, pose))| {
            let solid = Solid::new(kind.shape.clone(), pose * kind.shape_pose);
            let radius = radius(&solid);
            Body { module, body, solid, radius }
        })
    })
}

/// Distance of the farthest point of a solid from its centre, in m.
fn radius(solid: &Solid) -> f64 {
    match &solid.shape {
        Shape::Ball { radius } => *radius,
        Shape::Cuboid { .. } | Shape::Cylinder { .. } | Shape::Convex(_) => {
            solid.vertices().iter().map(|p| (p - solid.centre()).norm()).fold(0.0, f64::max)
        }
    }
}

/// Whether the balls around two solids meet while the first one turns: its centre goes round a circle.
fn may_meet(mover: &Body, other: &Body, motion: &Motion) -> bool {
    let Motion::Rotation { centre, axis, .. } = motion else { return true };
    let polar = |point: Vec3| {
        let arm = point - centre;
        let along = axis.dot(&arm);
        (along, (arm - axis.into_inner() * along).norm())
    };
    let (a, b) = (polar(mover.solid.centre()), polar(other.solid.centre()));
    let reach = mover.radius + other.radius;
    (a.0 - b.0).powi(2) + (a.1 - b.1).powi(2) <= reach * reach
}

/// Whether a joint or the rolling connection holds two bodies together.
fn held(view: &View, step: &Step, a: &Body, b: &Body) -> bool {
    let mut ends = [(a.module, a.body), (b.module, b.body)];
    ends.sort_unstable();
    match step.action {
        Action::Roll { connection, .. } => {
            let mut rolling = connection.ports.map(|port| (port.module, view.body_of(port)));
            rolling.sort_unstable();
            rolling == ends
        }
        _ => {
            a.module == b.module
                && view.kind(a.module).joints.iter().any(|joint| {
                    let joined = [joint.parent, joint.child];
                    joined == [a.body, b.body] || joined == [b.body, a.body]
                })
        }
    }
}
