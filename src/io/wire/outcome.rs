//! How the search of a `plan/1` ended, and why.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::action::JointOf;
use super::number::Real;
use super::plan::Bracket;

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Outcome {
    /// A plan was found.
    Solved,
    /// It is proved that there is none.
    Impossible,
    /// Nothing was found within the limits.
    OutOfBudget,
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "reason", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Impossible {
    /// Start and goal have another number of modules of one kind.
    ModulesDiffer {
        /// Name of their type.
        module_type: String,
        /// How many the start has, with the same loads and label.
        start: u64,
        /// How many the goal has.
        goal: u64,
    },
    /// A module is fixed where the goal does not want it, or the other way round.
    FixedModule {
        /// Its id.
        module: String,
    },
    /// The modules are not connected.
    Disconnected {
        /// Those of the start or of the goal.
        which: Which,
    },
    /// The margin is below the required one.
    Unstable {
        /// Of the start or of the goal.
        which: Which,
        /// The margin; null when it tips, slides or falls as a whole.
        #[serde(default)]
        margin: Option<Bracket>,
        /// The margin required.
        required_margin: Real,
        /// The connection that fails first; null when none does.
        #[serde(default)]
        connection: Option<[String; 2]>,
        /// The joint that fails first, where it is one.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        joint: Option<JointOf>,
    },
    /// One of the two has modules in cells near the ground where none comes unless one is there, and which the last one
    /// does not leave.
    Sealed {
        /// The cells: those whose third coordinate is this or less.
        level: i32,
        /// The start or the goal, whichever has none there.
        which: Which,
    },
    /// Every sequence of actions was tried, or proved too weak.
    Exhausted {
        /// The margin required; null when none was.
        #[serde(default)]
        required_margin: Option<Real>,
    },
}

/// The start or the goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Which {
    /// The start.
    Start,
    /// The goal.
    Goal,
}

/// What ends a search without an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum StoppedBy {
    /// The deadline has passed.
    Deadline,
    /// The number of expansions was used up.
    Expansions,
    /// The memory was used up.
    Memory,
    /// The caller cancelled.
    Cancelled,
    /// Everything was searched, but intervals on margins are too wide to decide.
    Precision,
    /// The method looks for some plans only, and found none that is better.
    Incomplete,
}
