//! `partial-order/1`: which actions of a plan may run at the same time.

use schemars::JsonSchema;
use serde::Serialize;

use super::action::Action;
use super::number::{NonNegative, Real};
use super::plan::Bracket;

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub(crate) enum PartialOrderFormat {
    /// The first version.
    #[serde(rename = "partial-order/1")]
    V1,
}

/// The partial order of a plan: every order and every overlap of its actions that the order allows is legal, free of
/// collision and stable throughout. Times are in the unit of the durations that were given.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PartialOrder {
    /// Name and version of the format.
    pub(crate) format: PartialOrderFormat,
    /// Margin that every state had to have.
    pub(crate) required_margin: Real,
    /// Smallest margin over all states that were asked about.
    pub(crate) margin: Bracket,
    /// How many moves may be under way at once.
    pub(crate) most_at_once: u64,
    /// Whether every action was looked at within the time allowed.
    pub(crate) complete: bool,
    /// The plan's actions, in its own order.
    pub(crate) actions: Vec<OrderedAction>,
    /// When the last action ends if each begins as early as it may.
    pub(crate) makespan: NonNegative,
    /// How long the actions take one after the other.
    pub(crate) one_by_one: NonNegative,
    /// What was gone through.
    pub(crate) checked: CheckedMoments,
}

/// An action with what it waits for.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct OrderedAction {
    /// What is done.
    pub(crate) action: Action,
    /// The actions that must have ended before it begins, without those that others wait for in turn.
    pub(crate) waits_for: Vec<Wait>,
    /// When it begins at the earliest.
    pub(crate) begins: NonNegative,
    /// When it ends then.
    pub(crate) ends: NonNegative,
}

/// Another action that one waits for.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Wait {
    /// Index of the other action, from 0.
    pub(crate) action: u64,
    /// Why.
    pub(crate) because: String,
}

/// What was gone through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CheckedMoments {
    /// Sets of done actions that the order allows, runs of attaching or of detaching taken as one.
    pub(crate) states: u64,
    /// Sets of moves under way at once, in each such state.
    pub(crate) overlaps: u64,
    /// States and sets that monotony left no need to ask about.
    pub(crate) by_monotony: u64,
    /// Structures that the oracle assessed.
    pub(crate) oracle_solves: u64,
}
