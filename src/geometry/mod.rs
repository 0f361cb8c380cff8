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
#[cfg(test)]
mod tests;
mod tolerances;

pub use broad_phase::BroadPhase;
pub use contact::{ContactPatch, contact, ground_contact};
pub use environment::environment_problems;
pub use motion::Motion;
pub use separation::{overlap, penetration};
pub use solid::Solid;
pub use sweep::{Surroundings, first_collision};
pub use tolerances::{SKIN, TOUCH};
