//! Contact points, overlap and swept collision of convex shapes, half-spaces and surfaces of triangles.
//!
//! Knows shapes and poses; knows no forces and no plans. The only module that
//! names `parry3d`, whose bounding volume hierarchy finds the candidate pairs and whose
//! distance iteration proposes directions where something is round; contacts and sweeps are our
//! own (see [`contact`] and [`first_collision`]).
//!
//! [`Surroundings`] answers for a whole environment. Between convex shapes all rests on directions
//! along which they are separate (`separation`): the gap along a direction is exact, so a
//! bad direction costs time and never a collision.

mod broad_phase;
mod contact;
mod curve;
mod environment;
mod figure;
#[cfg(test)]
mod laws;
mod linkage;
mod motion;
mod polygon;
mod separation;
mod solid;
mod surface;
mod surface_contact;
mod surroundings;
mod sweep;
#[cfg(test)]
mod tests;
mod tolerances;

pub use broad_phase::BroadPhase;
pub use contact::{ContactPatch, contact};
pub use environment::environment_problems;
pub use linkage::linkage_problems;
pub use motion::Motion;
pub use separation::{overlap, penetration};
pub use solid::Solid;
pub use surroundings::{Surrounding, Surroundings};
pub use sweep::first_collision;
pub use tolerances::{SKIN, TOUCH};
