//! A range of a force with what was asked.

use crate::statics::{LoadRange, UnitForce};

/// What a `load-range/1` report says.
#[derive(Clone, Copy, Debug)]
pub struct LoadRangeReport<'a> {
    /// The force that was asked for.
    pub force: &'a UnitForce,
    /// The answer.
    pub range: &'a LoadRange,
    /// Margin that is to be left at the ends.
    pub margin: f64,
    /// Wall-clock time in s that it took.
    pub seconds: f64,
}
