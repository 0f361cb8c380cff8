//! The actions of `plan/1`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::Real;
use super::plan::Bracket;

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
        /// How far the action is done where that is, 0 to 1; null when unknown.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1))]
        phase: Option<Real>,
    },
    /// An engaged connection opens.
    Detach {
        /// The two ports.
        ports: [String; 2],
        /// Smallest margin of its transient states; null when unknown.
        #[serde(default)]
        margin: Option<Bracket>,
        /// How far the action is done where that is, 0 to 1; null when unknown.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1))]
        phase: Option<Real>,
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
        /// How far the action is done where that is, 0 to 1; null when unknown.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1))]
        phase: Option<Real>,
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
        /// How far the action is done where that is, 0 to 1; null when unknown.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1))]
        phase: Option<Real>,
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
