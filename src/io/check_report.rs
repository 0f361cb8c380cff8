//! An assessment with all else that was asked.

use crate::statics::{Assessment, Explanation, FailureOrder, SelfStress};

/// What a `check/1` report says.
#[derive(Clone, Copy, Debug)]
pub struct CheckReport<'a> {
    /// The oracle's answer.
    pub assessment: &'a Assessment,
    /// What was left out of it, where that is explained.
    pub explanation: Option<&'a Explanation>,
    /// Whether it relies on squeeze between contacts, where that was asked.
    pub self_stress: Option<SelfStress>,
    /// The order in which connections would give way, where that was asked.
    pub order: Option<&'a FailureOrder>,
    /// Wall-clock time in s that the assessment took.
    pub seconds: f64,
}
