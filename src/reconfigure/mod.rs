//! Actions, transient states, and the search space of a robot.
//!
//! From a start and a goal to plans whose every transient state is proved stable
//! ([`solve`]), and from a plan back to a verdict on it ([`replay`]). Knows robots,
//! statics, geometry and search engines; knows no files and never prints.

mod action;
pub mod assembly;
#[cfg(test)]
mod assembly_laws;
#[cfg(test)]
mod assembly_tests;
mod baseline;
mod carried;
mod compose;
mod course;
mod decides;
mod decision;
mod domain;
mod engines;
mod goal;
mod hanging;
mod held;
mod herald;
mod heuristic;
mod in_the_way;
mod large;
mod layout;
pub mod linkage;
mod local;
mod moves;
mod open_ground;
mod options;
mod oracle;
pub mod partial_order;
mod pieces;
mod plan;
mod primitive;
mod problem;
mod recollection;
mod refusal;
pub mod replay;
mod sampling;
mod saturated;
mod sealed;
mod shares;
mod solve;
mod step;
mod stronger;
mod surface;
mod symmetry;
mod trace;
mod wander;
mod ways;
mod worst;

pub use crate::robot::{Motion, Turn};
pub use action::Action;
pub use baseline::Baseline;
pub use engines::MARGIN_TOLERANCE;
pub use in_the_way::{InTheWay, Nearest};
pub use layout::{Bond, Layout, Placed};
pub use moves::Move;
pub use options::{Event, Known, Method, News, Options, Pass, Reduction};
pub use plan::{
    Bottleneck, IfStronger, Limit, Moment, Objective, Outcome, Plan, PlannedAction, Proof, Report, Statistics,
};
pub use refusal::{Impossible, Refusal, Which};
pub use solve::solve;
pub use step::Step;
pub use wander::{Walk, wander};
pub use ways::{Ability, Way, fitting};

#[cfg(test)]
mod tests;
