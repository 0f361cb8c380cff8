//! `suite/1`: random problems to be planned for, in TOML.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::{Positive, Real};
use super::plan::Objective;

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum SuiteFormat {
    /// The first version.
    #[serde(rename = "suite/1")]
    V1,
}

/// Random problems, each to be planned for in several ways. Written in TOML.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Suite {
    /// Name and version of the format.
    pub(crate) format: SuiteFormat,
    /// What reports call it.
    pub(crate) name: String,
    /// What may be spent.
    pub(crate) limits: SuiteLimits,
    /// Problems, one family each.
    #[schemars(length(min = 1))]
    pub(crate) case: Vec<SuiteCase>,
}

/// What may be spent.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SuiteLimits {
    /// Time of one job, planning alone.
    pub(crate) job_time_s: Positive,
    /// Memory of one job, 64 or more.
    #[schemars(range(min = 64, max = 1_000_000))]
    pub(crate) job_memory_mb: u32,
    /// Time of all jobs together, by default without limit. What was not run then is run when the suite is run again.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) total_time_s: Option<Positive>,
    /// Memory of all jobs that run at a time, by default without limit.
    #[schemars(range(min = 64, max = 100_000_000))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) total_memory_mb: Option<u32>,
}

/// Problems of one family: one for each size, terrain and seed; and a job for each of them, objective and planner.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SuiteCase {
    /// What kind of robot.
    pub(crate) family: RobotFamily,
    /// Numbers of modules.
    #[schemars(length(min = 1), inner(range(min = 1, max = 2000)))]
    pub(crate) modules: Vec<u32>,
    /// The seeds, or how many of them: 3 stands for 1, 2 and 3.
    pub(crate) seeds: Seeds,
    /// What surrounds the robot, by default the family's usual: `flat`, for RoFI modules `space`.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) terrain: Option<Vec<TerrainKind>>,
    /// Whether the first module is held, by default so for struts and nodes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) held: Option<bool>,
    /// Where goals come from, by default `grown` for cubes and `walk` for others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) goal: Option<GoalOrigin>,
    /// How far goals are: of a grown one how many modules change places, of a walk how many moves it takes.
    #[schemars(range(min = 1, max = 10_000))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) difficulty: Option<u32>,
    /// Margin of start and goal, by default 0.1.
    #[schemars(range(min = 0, max = 0.999))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) margin: Option<Real>,
    /// Margin that every transient state must have, by default 0.
    #[schemars(range(min = 0, max = 0.999))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) min_margin: Option<Real>,
    /// What makes a plan better, by default `margin`. Planners that ignore stability look for the fewest moves.
    #[schemars(length(min = 1))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) objectives: Option<Vec<Objective>>,
    /// How to plan.
    #[schemars(length(min = 1))]
    pub(crate) planners: Vec<PlannerName>,
    /// Time of one job, where it is not the suite's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) job_time_s: Option<Positive>,
    /// Memory of one job, where it is not the suite's.
    #[schemars(range(min = 64, max = 1_000_000))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) job_memory_mb: Option<u32>,
}

/// The seeds, or how many of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum Seeds {
    /// From 1 to this.
    Count(#[schemars(range(min = 1, max = 100_000))] u32),
    /// These.
    List(#[schemars(length(min = 1))] Vec<u32>),
}

/// What kind of robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum RobotFamily {
    /// Magnetic cubes in a lattice.
    Cubes,
    /// Struts and nodes.
    Freesn,
    /// Universal modules of the RoFI platform.
    Rofi,
}

/// What surrounds the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum TerrainKind {
    /// Nothing, not even gravity.
    Space,
    /// Gravity and no ground; the first module is held.
    Mounted,
    /// A floor.
    Flat,
    /// An inclined floor.
    Slope,
    /// A floor with blocks.
    Steps,
    /// A floor with pits.
    Rough,
}

/// Where a goal comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum GoalOrigin {
    /// Grown like the start.
    Grown,
    /// The end of a random walk from the start.
    Walk,
}

/// How to plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum PlannerName {
    /// The default search.
    Exact,
    /// One module after another, for many cubes.
    Decompose,
    /// The search over single actions, for cubes.
    Primitive,
    /// By geometry alone.
    IgnoreStability,
}
