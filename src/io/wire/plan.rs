//! `plan/1`: what a search found and proved.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::configuration::Configuration;
use super::number::{Bound, NonNegative, Real};

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
    /// What it optimised.
    pub(crate) objective: Objective,
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

/// What a search optimised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Objective {
    /// The best worst-case margin, then the fewest moves.
    Margin,
    /// The fewest moves with at least the required margin.
    Moves,
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
}

/// One action of a plan. Ports are named by the module's own faces, as in `a:+z`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Action {
    /// Two coinciding faces engage.
    Attach {
        /// The two ports.
        ports: [String; 2],
        /// Smallest margin of its transient states; null when unknown.
        #[serde(default)]
        margin: Option<Bracket>,
    },
    /// An engaged connection opens.
    Detach {
        /// The two ports.
        ports: [String; 2],
        /// Smallest margin of its transient states; null when unknown.
        #[serde(default)]
        margin: Option<Bracket>,
    },
    /// A module slides over the faces of two coplanar neighbours.
    Slide {
        /// Which module.
        module: String,
        /// Where it ends.
        to: CellTarget,
        /// Smallest margin of its transient states; null when unknown.
        #[serde(default)]
        margin: Option<Bracket>,
    },
    /// A module turns about an edge that it shares with a neighbour.
    Pivot {
        /// Which module.
        module: String,
        /// The neighbour that carries the hinge.
        support: String,
        /// World direction that the turn is right-handed about.
        axis: Axis,
        /// 90 or 180.
        angle_deg: u32,
        /// Where it ends.
        to: CellTarget,
        /// Smallest margin of its transient states; null when unknown.
        #[serde(default)]
        margin: Option<Bracket>,
    },
}

/// Where a lattice module ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CellTarget {
    /// The cell.
    #[schemars(inner(range(min = -1_000_000, max = 1_000_000)))]
    pub(crate) cell: [i32; 3],
}

/// What a search did.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Statistics {
    /// States expanded.
    pub(crate) expanded: u64,
    /// Exact oracle calls.
    pub(crate) oracle_solves: u64,
    /// States that bounds decided without a solve.
    pub(crate) decided_by_bounds: u64,
    /// Wall-clock time in s.
    pub(crate) seconds: NonNegative,
}

/// A signed world axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum Axis {
    /// Along -x.
    #[serde(rename = "-x")]
    NegX,
    /// Along +x.
    #[serde(rename = "+x")]
    PosX,
    /// Along -y.
    #[serde(rename = "-y")]
    NegY,
    /// Along +y.
    #[serde(rename = "+y")]
    PosY,
    /// Along -z.
    #[serde(rename = "-z")]
    NegZ,
    /// Along +z.
    #[serde(rename = "+z")]
    PosZ,
}
