//! `result/1`: what a job of a suite found, one line of a file each.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::{Bound, NonNegative, Real};
use super::outcome::StoppedBy;
use super::plan::{Bracket, Objective, Statistics};
use super::suite::{GoalOrigin, PlannerName, RobotFamily, TerrainKind};

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum ResultFormat {
    /// The first version.
    #[serde(rename = "result/1")]
    V1,
}

/// What a job of a suite found. A file of results has one on each line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct JobResult {
    /// Name and version of the format.
    pub(crate) format: ResultFormat,
    /// Name of the job: everything that the result depends on, but for machine and program.
    pub(crate) job: String,
    /// What was asked, for programs; the name says the same.
    pub(crate) asked: Asked,
    /// How it ended.
    pub(crate) ending: JobEnding,
    /// Which limit stopped it, where one did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) stopped_by: Option<StoppedBy>,
    /// How it crashed, or why it was refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) because: Option<String>,
    /// Time that planning took.
    pub(crate) seconds: NonNegative,
    /// The plan; null when none was found.
    pub(crate) plan: Option<FoundPlan>,
    /// What a replay of the plan found; null when there is none.
    pub(crate) replay: Option<ReplayOf>,
    /// No plan has a larger margin; null when nothing is known.
    pub(crate) margin_at_most: Bound,
    /// No plan that is as good has fewer moves; null when there is no plan at all.
    pub(crate) moves_at_least: Option<u32>,
    /// What became known when.
    pub(crate) trace: Vec<TracePoint>,
    /// What the search did.
    pub(crate) statistics: Statistics,
    /// Peak memory of the job's process; null where the system does not tell.
    pub(crate) peak_memory_bytes: Option<u64>,
}

/// What was asked of a job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Asked {
    /// What kind of robot.
    pub(crate) family: RobotFamily,
    /// How many modules.
    pub(crate) modules: u32,
    /// The seed.
    pub(crate) seed: u64,
    /// What surrounds the robot.
    pub(crate) terrain: TerrainKind,
    /// Whether the first module is held.
    pub(crate) held: bool,
    /// Where the goal comes from.
    pub(crate) goal: GoalOrigin,
    /// How far it was to be; null for the family's usual.
    pub(crate) difficulty: Option<u32>,
    /// Margin of start and goal.
    pub(crate) margin: Real,
    /// Margin that every transient state must have.
    pub(crate) min_margin: Real,
    /// What makes a plan better.
    pub(crate) objective: Objective,
    /// How it was planned.
    pub(crate) planner: PlannerName,
}

/// How a job ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum JobEnding {
    /// With a plan that is proved to be the best.
    Solved,
    /// With a proof that there is none.
    Impossible,
    /// At a limit.
    Stopped,
    /// Ended from outside, since it did not stop at its time limit.
    Overran,
    /// Without an answer.
    Crashed,
    /// The problem could not be drawn, or the planner refused it.
    Refused,
}

/// A plan in short.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FoundPlan {
    /// How many moves it has.
    pub(crate) moves: u32,
    /// How many actions.
    pub(crate) actions: u64,
    /// The margin that it claims; null when it was made by geometry alone.
    pub(crate) margin: Option<Bracket>,
    /// Whether it is claimed to be the best.
    pub(crate) optimal: bool,
}

/// What a replay found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ReplayOf {
    /// The first thing that is wrong; null for a plan that is confirmed.
    pub(crate) flaw: Option<PlanFlaw>,
    /// Smallest margin of the states that were reached.
    pub(crate) margin: Bracket,
    /// Whether the robot tips, slides or falls in one of them: no margin is meant then.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) falls: bool,
    /// States that the oracle was asked about.
    pub(crate) states: u64,
}

/// What is wrong with a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlanFlaw {
    /// Which action, from 0; null for the plan as a whole.
    pub(crate) action: Option<u64>,
    /// How far on its way the action was.
    pub(crate) phase: Option<Real>,
    /// Whether the robot breaks, tips, slides or falls.
    pub(crate) breaks: bool,
    /// In a sentence.
    pub(crate) what: String,
}

/// A moment at which something became known.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TracePoint {
    /// Time since planning began.
    pub(crate) seconds: NonNegative,
    /// Margin of the best plan so far.
    pub(crate) margin: Option<Real>,
    /// Its moves.
    pub(crate) moves: Option<u32>,
    /// No plan has a larger margin; null when nothing is known.
    pub(crate) margin_at_most: Bound,
    /// No plan that is as good has fewer moves.
    pub(crate) moves_at_least: Option<u32>,
}
