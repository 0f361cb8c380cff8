//! `configuration/1`: a robot in its environment.

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::catalogue::Catalogue;
use super::number::{NonNegative, Real};
use super::terrain::Terrain;

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum ConfigurationFormat {
    /// The first version.
    #[serde(rename = "configuration/1")]
    V1,
}

/// A robot in its environment at one moment: a start or a goal. SI units, one
/// right-handed world frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Configuration {
    /// Name and version of the format.
    pub(crate) format: ConfigurationFormat,
    /// The module types: name of a built-in catalogue, path of a file relative
    /// to this one, or inline. A goal may leave it out: the start's holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) catalogue: Option<CatalogueRef>,
    /// Gravity. A goal may leave it out: the start's holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) gravity_m_s2: Option<[Real; 3]>,
    /// What surrounds the robot, by default nothing. A goal may leave it out: the start's holds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) environment: Option<Environment>,
    /// The modules.
    #[schemars(length(min = 1))]
    pub(crate) modules: Vec<Module>,
    /// Which ports are connected.
    pub(crate) connections: Connections,
    /// External loads. A goal may leave them out: the start's hold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) loads: Option<Vec<ModuleLoad>>,
    /// What every transient state must satisfy; said in the start.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) require: Option<Require>,
    /// How a goal is compared with a state; said in the goal.
    #[serde(default, rename = "match", skip_serializing_if = "Option::is_none")]
    pub(crate) matching: Option<Match>,
}

/// Where the module types are.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum CatalogueRef {
    /// Name of a built-in catalogue, or path of a file relative to this one.
    Name(String),
    /// The catalogue itself.
    Inline(Box<Catalogue>),
}

/// What surrounds the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Environment {
    /// Horizontal ground, by default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) ground: Option<Ground>,
    /// What else stands there.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) obstacles: Vec<Obstacle>,
    /// Friction coefficient between modules that touch without being connected, by default 0.4.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) module_friction: Option<NonNegative>,
}

/// Horizontal frictional ground, filling everything below its height.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Ground {
    /// z of its surface.
    pub(crate) height_m: Real,
    /// Friction coefficient.
    pub(crate) friction: NonNegative,
}

/// Something immovable.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Obstacle {
    /// Its shape.
    pub(crate) shape: Terrain,
    /// Origin of its frame; the centre of a cuboid, a cylinder or a ball.
    pub(crate) position_m: [Real; 3],
    /// Its orientation, a unit quaternion, by default along the world's axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) rotation_xyzw: Option<[Real; 4]>,
    /// Friction coefficient of its surface.
    pub(crate) friction: NonNegative,
}

/// A module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Module {
    /// Unique name.
    pub(crate) id: String,
    /// Name of its type in the catalogue.
    #[serde(rename = "type")]
    pub(crate) module_type: String,
    /// Cell of a lattice module, which places it: it fills [x, x+1] x [y, y+1] x [z, z+1] times the pitch.
    #[schemars(inner(range(min = -1_000_000, max = 1_000_000)))]
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) cell: Option<[i32; 3]>,
    /// Position of its first body's frame, for modules outside lattices. A module that connections
    /// join to others which have a place needs none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) position_m: Option<[Real; 3]>,
    /// Orientation, a unit quaternion; of a lattice module one of the 24 rotations of a cube.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) rotation_xyzw: Option<[Real; 4]>,
    /// Joint positions by name.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) joints_deg: Option<IndexMap<String, Real>>,
    /// Whether it is held immovably.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) fixed: bool,
}

/// Which ports are connected.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum Connections {
    /// Every pair of ports that coincides.
    Touching(Touching),
    /// The listed pairs.
    List(Vec<PairConnection>),
}

/// Every pair of ports that coincides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Touching {
    /// Every pair of ports that coincides.
    Touching,
}

/// Two ports that are connected, each `MODULE:PORT` as in `a:+z`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum PairConnection {
    /// The two ports.
    Pair([String; 2]),
    /// The two ports and the angle at which they engage.
    Rolled(RolledConnection),
}

/// Two ports that are connected, and how one engages with the other. That places a module
/// which has no place of its own; of modules that have one it is checked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RolledConnection {
    /// The two ports.
    pub(crate) ports: [String; 2],
    /// Angle by which the one port's x axis is turned from the other's about the axis that they
    /// share, by default 0; a multiple of 90 for faces. Of lattice modules the placements alone
    /// decide at which of the four they engage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) roll_deg: Option<Real>,
    /// Of a port on a surface: the direction from the ball's centre to it, of any length, in the
    /// frame of the ball's body (of a module of one body the module's).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) direction: Option<[Real; 3]>,
    /// Of a port on a surface: the angle by which its x axis is turned about the direction outwards,
    /// by default 0. At 0 it looks towards growing angles from the ball's z axis (south, were z north);
    /// at the poles along the ball's x axis, or against it below.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) spin_deg: Option<Real>,
}

/// An external wrench that stays on a module wherever it goes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ModuleLoad {
    /// The loaded module.
    pub(crate) module: String,
    /// Force, in the world frame.
    pub(crate) force_n: [Real; 3],
    /// Torque, in the world frame, by default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) torque_nm: Option<[Real; 3]>,
    /// Point of action in the module frame, by default the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) at_m: Option<[Real; 3]>,
}

/// What every transient state must satisfy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Require {
    /// Smallest admissible internal stability margin, by default 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) margin: Option<Real>,
    /// Whether all modules must stay connected, by default true.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) connected: Option<bool>,
    /// Modules that no action may move, though nothing else holds them, by their ids.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) stay: Vec<String>,
    /// Boxes that no move may pass through; they carry nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) keep_out: Vec<Region>,
}

/// A box with its edges along the world's axes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Region {
    /// Its lowest corner.
    pub(crate) low_m: [Real; 3],
    /// Its highest corner, above the lowest along every axis.
    pub(crate) high_m: [Real; 3],
}

/// How a goal is compared with a state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Match {
    /// Whether modules of one type may swap places, by default `interchangeable`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) modules: Option<ModuleMatch>,
    /// Whether the goal may be met displaced over the ground, by default `world`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) frame: Option<FrameMatch>,
}

/// Which module may be where.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ModuleMatch {
    /// Any module of the same type.
    Interchangeable,
    /// Each module at its own place, by its id.
    Labelled,
}

/// In which frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum FrameMatch {
    /// At the very place.
    World,
    /// Up to a displacement over the ground.
    Free,
}
