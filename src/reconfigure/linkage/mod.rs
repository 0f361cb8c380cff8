//! Reconfiguration of robots outside lattices: chains, freeform robots, and mixtures.
//!
//! States are placements of modules up to interchange, to the symmetries of their types and, in an empty world, to
//! displacement (`places`, `arrangement`); moves turn one side of a joint or of a connection on a ball, with every
//! way to split the robot for it (`moves`, `sides`); `clearance` and `oracle` judge them, `saturated` is the
//! search space, `compose` leads back to explicit actions, and `replay` checks those from the definitions.
//! `motion_range` maps where one connection or joint may stand.

mod action;
mod arrangement;
pub mod assembly;
#[cfg(test)]
mod assembly_tests;
mod clearance;
mod compose;
mod contacts;
mod domain;
mod goal;
pub(super) mod joined;
mod motion_range;
mod moves;
mod oracle;
mod places;
mod problem;
mod refusal;
pub mod replay;
mod saturated;
mod sides;
mod solve;
mod state;
#[cfg(test)]
pub(super) mod tests;
mod wander;

pub use super::partial_order::linkage::partial_order;
pub use action::{Action, Half};
pub use motion_range::{MotionRange, NotABridge, Stand, Turning, motion_range};
pub use solve::solve;
pub use wander::wander;
