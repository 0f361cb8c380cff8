//! `plan/1`: what a search found and proved.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::action::{Action, JointOf};
use super::configuration::Configuration;
use super::in_the_way::InTheWay;
use super::number::{Bound, NonNegative, Positive, Real};
use super::outcome::{Impossible, Outcome, StoppedBy};

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum PlanFormat {
    /// The first version.
    #[serde(rename = "plan/1")]
    V1,
}

/// What a search found and proved, with its problem, so that it stands on its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Plan {
    /// Name and version of the format.
    pub(crate) format: PlanFormat,
    /// How the search ended.
    pub(crate) outcome: Outcome,
    /// Why there is no plan, in a sentence for people; null unless impossible.
    #[serde(default)]
    pub(crate) impossible_because: Option<String>,
    /// Why there is no plan, for programs; null unless impossible.
    #[serde(default)]
    pub(crate) impossible: Option<Impossible>,
    /// What ended the search without an answer; null unless out of budget.
    #[serde(default)]
    pub(crate) stopped_by: Option<StoppedBy>,
    /// What ended the search for further plans before there were as many as asked for; else null.
    #[serde(default)]
    pub(crate) alternatives_cut_by: Option<StoppedBy>,
    /// What it optimised.
    pub(crate) objective: Objective,
    /// Margin that every transient state must have; null for plans made by geometry alone.
    #[serde(default)]
    pub(crate) required_margin: Option<Real>,
    /// Smallest margin of the best plan's transient states; null without a plan or when unknown.
    #[serde(default)]
    pub(crate) margin: Option<Bracket>,
    /// Number of moves of the best plan; null without a plan.
    #[serde(default)]
    pub(crate) moves: Option<u32>,
    /// What was proved.
    pub(crate) proof: Proof,
    /// Where the best plan's margin is smallest; null without a plan or when unknown.
    #[serde(default)]
    pub(crate) bottleneck: Option<Bottleneck>,
    /// The best plan; null without one.
    #[serde(default)]
    pub(crate) actions: Option<Vec<Action>>,
    /// Margins of the best plan over time; empty when not recorded.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) profile: Vec<Moment>,
    /// What the best plan would be worth if the connection at its bottleneck were stronger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) if_stronger: Option<IfStronger>,
    /// What is in the way of a plan, where none was found and that was looked into.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) in_the_way: Option<InTheWay>,
    /// The further ranked plans.
    #[serde(default)]
    pub(crate) alternatives: Vec<Alternative>,
    /// Where the robot was.
    pub(crate) start: Configuration,
    /// Where it was to be.
    pub(crate) goal: Configuration,
    /// What the search did.
    pub(crate) statistics: Statistics,
}

/// What a search optimised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Objective {
    /// The best worst-case margin, then the fewest moves.
    Margin,
    /// The fewest moves with at least the required margin.
    Moves,
    /// Every trade between the two that no other plan beats; first the one of the largest margin.
    Pareto,
}

/// An interval that is proved to hold a value; null where nothing was proved.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bracket {
    /// Proved lower bound.
    pub(crate) lower: Bound,
    /// Proved upper bound.
    pub(crate) upper: Bound,
}

/// What a search proved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Proof {
    /// Whether the first plan is proved best.
    pub(crate) optimal: bool,
    /// No plan has a larger margin; null when nothing was proved.
    #[serde(default)]
    pub(crate) margin_at_most: Option<Real>,
    /// No plan has fewer moves; null when nothing was proved.
    #[serde(default)]
    pub(crate) moves_at_least: Option<u32>,
}

/// Where a plan's margin is smallest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Bottleneck {
    /// Index of the action, from 0; null when it is the start itself.
    #[serde(default)]
    pub(crate) action: Option<u32>,
    /// How far the action is done, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub(crate) phase: Real,
    /// The connection that the margin hangs on; null when none does.
    #[serde(default)]
    pub(crate) connection: Option<[String; 2]>,
    /// The joint that the margin hangs on, where it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) joint: Option<JointOf>,
}

/// A plan other than the best.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Alternative {
    /// Smallest margin of its transient states; null when unknown.
    #[serde(default)]
    pub(crate) margin: Option<Bracket>,
    /// Number of moves.
    pub(crate) moves: u32,
    /// Where its margin is smallest; null when unknown.
    #[serde(default)]
    pub(crate) bottleneck: Option<Bottleneck>,
    /// Its actions.
    pub(crate) actions: Vec<Action>,
    /// Its margins over time; empty when not recorded.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) profile: Vec<Moment>,
    /// What it would be worth if the connection at its bottleneck were stronger.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) if_stronger: Option<IfStronger>,
}

/// A state that a plan passes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Moment {
    /// Index of the action, from 0; null for the start itself.
    #[serde(default)]
    pub(crate) action: Option<u32>,
    /// How far the action is done, 0 to 1.
    #[schemars(range(min = 0, max = 1))]
    pub(crate) phase: Real,
    /// The margin then.
    pub(crate) margin: Bracket,
}

/// What a plan would be worth with a stronger bottleneck.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct IfStronger {
    /// How many times as strong the connection at the bottleneck would be, wherever the same ports hold each other.
    pub(crate) factor: Positive,
    /// Smallest margin of the same plan's states then.
    pub(crate) margin: Bracket,
}

/// How many of the oracle's answers took how much, from the cheapest kind to the dearest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Answers {
    /// Balance alone: nothing was optimised.
    pub(crate) closed_form: u64,
    /// What a neighbouring state left.
    pub(crate) carried_over: u64,
    /// The iteration, stopped as soon as its bounds answered.
    pub(crate) stopped_early: u64,
    /// The iteration to its end.
    pub(crate) solved: u64,
    /// The general solver, after the iteration had not been enough.
    pub(crate) solved_generally: u64,
}

/// What a search did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Statistics {
    /// States expanded.
    pub(crate) expanded: u64,
    /// Distinct states met; null when not counted.
    #[serde(default)]
    pub(crate) states: Option<u64>,
    /// Transitions generated; null when not counted.
    #[serde(default)]
    pub(crate) generated: Option<u64>,
    /// Transitions whose margin was asked for; null when not counted.
    #[serde(default)]
    pub(crate) certified: Option<u64>,
    /// Exact oracle calls.
    pub(crate) oracle_solves: u64,
    /// Transitions that no margin was asked for.
    pub(crate) decided_by_bounds: u64,
    /// How many of the oracle's answers took how much; null when not counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) answers: Option<Answers>,
    /// Peak memory of the search, approximately; null when not counted.
    #[serde(default)]
    pub(crate) memory_bytes: Option<u64>,
    /// Wall-clock time in s.
    pub(crate) seconds: NonNegative,
}
