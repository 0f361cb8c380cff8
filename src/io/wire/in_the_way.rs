//! What is in the way of a plan, in `plan/1`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::action::JointOf;
use super::outcome::StoppedBy;
use super::plan::{Alternative, Bracket};

/// What would have to change for there to be a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct InTheWay {
    /// Holds the largest margin that could be required so that there is a plan; two nulls when nothing is known.
    pub(crate) margin: Bracket,
    /// Whether it is proved that no requirement on margins helps.
    #[serde(default)]
    pub(crate) no_requirement_helps: bool,
    /// Holds the smallest factor on the strength of everything that holds with which there is a plan with the required
    /// margin; null where there is none or nothing is known.
    pub(crate) strength_factor: Bracket,
    /// The plan of the largest margin that was found, which is too small; null without one.
    #[serde(default)]
    pub(crate) plan: Option<Alternative>,
    /// What would have to be stronger for it, the weakest first.
    #[serde(default)]
    pub(crate) too_weak: Vec<TooWeak>,
    /// Modules that cannot move with the required margin, whatever others do; null when not all states were seen.
    #[serde(default)]
    pub(crate) never_move: Option<Vec<String>>,
    /// How close a decomposition came to the goal with the required margin; left out by other searches.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) nearest: Option<Nearest>,
    /// What ended this search before it was done; else null.
    #[serde(default)]
    pub(crate) cut_by: Option<StoppedBy>,
}

/// The state at a dead end with the fewest modules missing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Nearest {
    /// Modules of the robot.
    pub(crate) modules: u32,
    /// Those that were where the goal wants one of their kind.
    pub(crate) in_place: u32,
    /// Of the others, those that could not leave their cells at all. The rest found no way to a cell that could be filled.
    pub(crate) stuck: u32,
}

/// A connection or joint that would have to be stronger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TooWeak {
    /// The connection.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) connection: Option<[String; 2]>,
    /// The joint, where it is one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) joint: Option<JointOf>,
    /// The smallest margin at which it was the weakest.
    pub(crate) margin: Bracket,
}
