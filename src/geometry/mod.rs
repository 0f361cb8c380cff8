//! Contact points, overlap and swept collision of convex shapes.
//!
//! Knows shapes and poses; knows no forces and no plans. The only module that
//! names `parry3d`, whose bounding volume hierarchy finds the candidate pairs;
//! contacts and sweeps are our own (see [`contact`] and [`first_collision`]).

mod broad_phase;
mod contact;
mod environment;
mod motion;
mod polygon;
mod separation;
mod solid;
mod sweep;

pub use broad_phase::touching_candidates;
pub use contact::{ContactPatch, contact, ground_contact};
pub use environment::environment_problems;
pub use motion::Motion;
pub use separation::{overlap, penetration};
pub use solid::Solid;
pub use sweep::{Surroundings, first_collision};

/// Gap or penetration, relative to the size of the solids, up to which they
/// count as touching. A million times the rounding of poses that are derived from
/// integers, and far below any real play.
pub const TOUCH: f64 = 1e-6;

/// Penetration, relative to the size of the solids, up to which they count as
/// free of collision: touching solids that slide along each other penetrate by
/// rounding. Far above [`TOUCH`], so that what touches never collides.
pub const SKIN: f64 = 1e-4;
