//! The JSON formats of the RoFI platform: worlds and voxels. Not of this project: they have no `format`
//! key, and lengths are in cells.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::Real;

/// A JSON world of the RoFI platform. Lengths are in cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub(crate) struct RofiWorld {
    /// The modules.
    #[schemars(length(min = 1))]
    pub(crate) modules: Vec<RofiModule>,
    /// Which docks are joined.
    #[serde(default)]
    pub(crate) module_joints: Vec<ModuleJoint>,
    /// Where modules are; by default the first one's shoe A is the origin.
    #[serde(default)]
    pub(crate) space_joints: Vec<SpaceJoint>,
}

/// A module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum RofiModule {
    /// A universal module.
    Universal {
        /// Unique number.
        id: i64,
        /// Position of the joint alpha in degrees, from -90 to 90.
        alpha: Real,
        /// Position of the joint beta in degrees, from -90 to 90.
        beta: Real,
        /// Position of the joint gamma in degrees.
        gamma: Real,
        /// What other programs add; not read.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        attributes: Option<serde_json::Value>,
    },
    /// A board of docks.
    Pad {
        /// Unique number.
        id: i64,
        /// Number of docks along y.
        #[schemars(range(min = 1, max = 1000))]
        width: u32,
        /// Number of docks along z.
        #[schemars(range(min = 1, max = 1000))]
        height: u32,
        /// What other programs add; not read.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        attributes: Option<serde_json::Value>,
    },
}

/// Two joined docks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ModuleJoint {
    /// The first dock.
    pub(crate) from: DockOf,
    /// The second dock.
    pub(crate) to: DockOf,
    /// How the second dock is turned: `North`, `East`, `South`, `West`, or 0 to 3.
    pub(crate) orientation: NameOrNumber,
    /// What other programs add; not read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) attributes: Option<serde_json::Value>,
}

/// A dock of a module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct DockOf {
    /// The module.
    pub(crate) id: i64,
    /// The dock, by name (`A-X`, `A+X`, `A-Z`, `B-X`, `B+X`, `B-Z`) or number.
    pub(crate) connector: NameOrNumber,
}

/// A word or a number from 0.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum NameOrNumber {
    /// By name.
    Name(String),
    /// By number.
    Number(u32),
}

/// Where a component of a module is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct SpaceJoint {
    /// A point, in cells.
    pub(crate) point: [Real; 3],
    /// How the component is placed at the point.
    pub(crate) joint: PlacingJoint,
    /// The component.
    pub(crate) to: ComponentOf,
    /// What other programs add; not read.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) attributes: Option<serde_json::Value>,
}

/// How a component is placed at a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PlacingJoint {
    /// Kind of joint.
    #[serde(rename = "type")]
    pub(crate) kind: PlacingKind,
    /// Pose of the component's frame at the point: `identity`, or the rows of a 4 x 4 matrix.
    #[serde(rename = "sourceToDestination")]
    pub(crate) source_to_destination: Transform,
    /// Positions of the joint, of which a rigid one has none.
    #[serde(default)]
    pub(crate) positions: Vec<Real>,
}

/// Kind of a joint with the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum PlacingKind {
    /// One that does not move.
    Rigid,
}

/// A rigid transform.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum Transform {
    /// None.
    Identity(IdentityTransform),
    /// The rows of a 4 x 4 matrix.
    Matrix([[Real; 4]; 4]),
}

/// The transform that does nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum IdentityTransform {
    /// No transform.
    Identity,
}

/// A component of a module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ComponentOf {
    /// The module.
    pub(crate) id: i64,
    /// The component: a dock by name or number; of a universal module also 6, 7, 8, 9 for shoe A,
    /// body A, body B, shoe B.
    pub(crate) component: NameOrNumber,
}

/// A voxel world of the RoFI platform: one entry for every shoe.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct VoxelWorld {
    /// The shoes with their bodies.
    #[schemars(length(min = 1))]
    pub(crate) bodies: Vec<Voxel>,
}

/// A shoe with its body. Two spellings of its keys are in use.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Voxel {
    /// Its cell.
    #[schemars(inner(range(min = -1_000_000, max = 1_000_000)))]
    pub(crate) pos: [i32; 3],
    /// Direction to the module's other body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) body_dir: Option<Direction>,
    /// The same, in the other spelling.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) other_body_dir: Option<Direction>,
    /// Whether the X docks lie along the axis before that of `body_dir`, rather than after it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) shoe_rotated: Option<bool>,
    /// The same, in the other spelling.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) is_shoe_rotated: Option<bool>,
    /// Position of the shoe's joint: -90, 0 or 90 degrees, also written -1, 0, 1.
    pub(crate) joint_pos: i32,
}

/// A direction along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Direction {
    /// The axis.
    pub(crate) axis: CoordinateAxis,
    /// Whether it looks along the axis rather than against it.
    pub(crate) is_positive: bool,
}

/// One of the three axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum CoordinateAxis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}
