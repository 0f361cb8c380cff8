//! Motions of lattice modules in `catalogue/1`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::action::Axis;

/// One way to make a motion, for a module in cell `[0, 0, 0]`; the 24 rotations of a cube make all others of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Stencil {
    /// The cell that the module arrives in.
    #[schemars(inner(range(min = -8, max = 8)))]
    pub(crate) to: [i32; 3],
    /// Cells that must hold modules: what it moves along or turns about, and what it lands on.
    #[schemars(length(min = 1, max = 64), inner(inner(range(min = -8, max = 8))))]
    pub(crate) occupied: Vec<[i32; 3]>,
    /// Cells that must be empty, beside those that the module sweeps: these are found.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 64), inner(inner(range(min = -8, max = 8))))]
    pub(crate) free: Vec<[i32; 3]>,
    /// The edge that it turns about; none where it moves straight on.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) about: Option<Edge>,
    /// Whether its mirror images are ways of the motion as well; by default not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) mirrored: bool,
}

/// An edge of a module that it turns about.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Edge {
    /// The neighbouring cell whose module shares the edge and carries the hinge.
    #[schemars(inner(range(min = -1, max = 1)))]
    pub(crate) support: [i32; 3],
    /// The edge is that between the module's face on the support and its face in this direction, and
    /// it turns over to this side.
    pub(crate) towards: Axis,
    /// 90 or 180.
    pub(crate) angle_deg: u32,
}
