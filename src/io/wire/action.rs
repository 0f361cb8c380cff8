//! The actions of `plan/1`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::Real;
use super::plan::Bracket;

/// One action of a plan. Ports are named as in `a:+z` (of a cube its own faces) or `s:top`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Action {
    /// Two coinciding faces, or two ports that meet, engage.
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
    /// A module makes another motion of the catalogue.
    Move {
        /// Which motion, by its name in the catalogue.
        motion: String,
        /// Which module.
        module: String,
        /// The neighbour that carries the hinge, where it turns about an edge.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        support: Option<String>,
        /// The turn, where it turns about an edge.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        turn: Option<TurnAbout>,
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
    /// A port rolls over the ball that it holds, by one step, with everything on one side of the connection.
    Roll {
        /// The port and the surface.
        ports: [String; 2],
        /// The module of the two whose side moves.
        carried: String,
        /// Where and how the port arrives.
        to: SpotTarget,
        /// Smallest margin of its transient states; null when unknown.
        #[serde(default)]
        margin: Option<Bracket>,
        /// How far the action is done where that is, 0 to 1; null when unknown.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1))]
        phase: Option<Real>,
    },
    /// A joint turns by one step, with everything on one side of it.
    Rotate {
        /// The module whose joint it is.
        module: String,
        /// Name of the joint.
        joint: String,
        /// The position that it arrives in.
        to_deg: Real,
        /// The side that moves.
        carried: Half,
        /// Smallest margin of its transient states; null when unknown.
        #[serde(default)]
        margin: Option<Bracket>,
        /// How far the action is done where that is, 0 to 1; null when unknown.
        #[serde(default)]
        #[schemars(range(min = 0, max = 1))]
        phase: Option<Real>,
    },
}

impl Action {
    /// What it is worth, and where that is decided.
    pub(crate) fn worth(&self) -> (Option<Bracket>, Option<Real>) {
        match self {
            Self::Attach { margin, phase, .. }
            | Self::Detach { margin, phase, .. }
            | Self::Slide { margin, phase, .. }
            | Self::Pivot { margin, phase, .. }
            | Self::Move { margin, phase, .. }
            | Self::Roll { margin, phase, .. }
            | Self::Rotate { margin, phase, .. } => (*margin, *phase),
        }
    }
}

/// Where and how a port sits on a ball: turned from the frame of the ball's body by `spin` about z, then by
/// `polar` about y, then by `azimuth` about z, all about the body's axes; z is then outwards, and x the port's x axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpotTarget {
    /// Angle about the ball's z axis from its x axis.
    pub(crate) azimuth_deg: Real,
    /// Angle from the ball's z axis.
    pub(crate) polar_deg: Real,
    /// Angle about the direction outwards.
    pub(crate) spin_deg: Real,
}

/// A turn about an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct TurnAbout {
    /// World direction that the turn is right-handed about.
    pub(crate) axis: Axis,
    /// 90 or 180.
    pub(crate) angle_deg: u32,
}

/// A side of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Half {
    /// That of the joint's parent body.
    Parent,
    /// That of the joint's child body.
    Child,
}

/// A joint of a module.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct JointOf {
    /// The module.
    pub(crate) module: String,
    /// Name of the joint.
    pub(crate) joint: String,
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
