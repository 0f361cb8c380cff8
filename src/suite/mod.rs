//! Suites of random problems: what is to be run, what a run found, and what can be said about many of them.
//!
//! A [`Suite`] expands into [`Job`]s; [`run()`] does one of them and [`judge()`] replays the plan that it found. Every job
//! ends in a [`Record`]. Runs that were cut off are censored, not averaged: see [`survival`]. Knows no files,
//! no processes and never prints; who runs jobs, and where, is the caller's.

mod job;
mod judge;
mod plan;
mod record;
mod run;
pub mod summary;
pub mod survival;
#[cfg(test)]
mod tests;

pub use job::{Case, Job, Limits, Planner, Suite};
pub use judge::{Check, Flaw, judge};
pub use plan::AnyPlan;
pub use record::{Ending, Found, Point, Record};
pub use run::{Run, Watch, run};
