//! `catalogue/1`: module types and the connectors they carry.

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::connector::Connector;
use super::motion::Stencil;
use super::number::{AngleRange, NonNegative, Positive, Real};

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum CatalogueFormat {
    /// The first version.
    #[serde(rename = "catalogue/1")]
    V1,
}

/// Module types and the connectors they carry. SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Catalogue {
    /// Name and version of the format.
    pub(crate) format: CatalogueFormat,
    /// Name for reports, by default where it was read from.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) name: Option<String>,
    /// Connector models by name.
    pub(crate) connectors: IndexMap<String, Connector>,
    /// Motions of modules with ports `faces` beside `slide` and `pivot`, by name: all ways to make
    /// each. For every way there must be one that leads back.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub(crate) motions: IndexMap<String, Vec<Stencil>>,
    /// Module types by name.
    pub(crate) module_types: IndexMap<String, ModuleType>,
}

/// A kind of module.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct ModuleType {
    /// Edge length of a lattice cell, for modules whose ports are `faces`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) pitch_m: Option<Positive>,
    /// Its rigid bodies. The first one's frame is the module's; while all joints are
    /// at 0, the frames of all bodies coincide with it.
    #[schemars(length(min = 1))]
    pub(crate) bodies: Vec<BodyType>,
    /// Where its connectors sit.
    pub(crate) ports: Ports,
    /// Connector on every face, for ports `faces`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) connector: Option<String>,
    /// Connector at a shared edge while turning about it: a `box`, z along the edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) hinge: Option<String>,
    /// What it is capable of: `slide` over the faces of two coplanar neighbours, `pivot` about an edge shared with
    /// a neighbour, and the catalogue's own `motions`, for ports `faces`; `roll` of a port over a surface and
    /// `rotate` of a joint for others.
    #[serde(default)]
    pub(crate) motions: Vec<String>,
    /// Joints between its bodies, which make them one tree.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) joints: Vec<Joint>,
    /// Step in which its ports roll over surfaces, a whole part of 180 degrees; by
    /// default 90 for a module that can `roll`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) roll_step_deg: Option<Positive>,
}

/// A rigid body of a module type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyType {
    /// Name within the module type.
    pub(crate) name: String,
    /// Mass.
    pub(crate) mass_kg: NonNegative,
    /// Centre of mass in the body's frame, by default `shape_position_m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) com_m: Option<[Real; 3]>,
    /// Its solid.
    pub(crate) shape: Shape,
    /// Where the solid's own frame is in the body's frame, by default at its origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) shape_position_m: Option<[Real; 3]>,
    /// How the solid's own frame is turned in the body's frame, a unit quaternion, by default not at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) shape_rotation_xyzw: Option<[Real; 4]>,
}

/// A convex solid; all but a hull are centred on their own frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Shape {
    /// A box.
    Cuboid {
        /// Half of the edge lengths along x, y and z.
        half_extents_m: [Positive; 3],
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius.
        radius_m: Positive,
        /// Height.
        height_m: Positive,
    },
    /// A ball.
    Ball {
        /// Radius.
        radius_m: Positive,
    },
    /// The convex hull of points.
    Convex {
        /// At least four points that do not lie in a plane, in the frame of the shape.
        #[schemars(length(min = 4, max = 256))]
        points_m: Vec<[Real; 3]>,
    },
}

/// Where connectors sit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum Ports {
    /// On the six faces of a cube, named by their normals: `+x`, `-x`, ...
    Faces(Faces),
    /// At the listed places.
    List(Vec<PortType>),
}

/// The six faces of a cube.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Faces {
    /// On the six faces of a cube.
    Faces,
}

/// A place where connectors engage: at a point, or anywhere on a ball.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PortType {
    /// Name within the module type, without a colon.
    pub(crate) name: String,
    /// Body that it sits on.
    pub(crate) body: String,
    /// Where, in the body's frame; of ports at a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) position_m: Option<[Real; 3]>,
    /// Outward direction, in the body's frame; of ports at a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) axis: Option<[Real; 3]>,
    /// Direction from which angles of engagement are counted and along which a connector's x
    /// lies, made perpendicular to `axis`; by default the body's x axis, or its y axis where
    /// `axis` is within 26 degrees of x.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) x_axis: Option<[Real; 3]>,
    /// Instead of `axis` and `x_axis`: the unit quaternion that turns the body's z axis to
    /// the one and its x axis to the other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) rotation_xyzw: Option<[Real; 4]>,
    /// At how many angles, equally spaced over a turn, it engages with another port at a point; by default 4,
    /// 0 for one that engages with surfaces only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 3600))]
    pub(crate) orientations: Option<u32>,
    /// Name of the connector; none for a port that only connectors of others hold on to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) connector: Option<String>,
    /// Whether connectors can engage anywhere on the body's surface, a ball's.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) surface: bool,
}

/// A revolute joint between two bodies of a module type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Joint {
    /// Name within the module type.
    pub(crate) name: String,
    /// The body that it is fixed to.
    pub(crate) parent: String,
    /// The body that it turns.
    pub(crate) child: String,
    /// Direction of its axis in the parent's frame; positive positions turn the child
    /// right-handed about it.
    pub(crate) axis: [Real; 3],
    /// A point of its axis in the parent's frame.
    pub(crate) origin_m: [Real; 3],
    /// Smallest and largest position, whole steps around 0; null for one that turns without end.
    pub(crate) range_deg: AngleRange,
    /// Step between positions.
    pub(crate) step_deg: Positive,
    /// Holding torque about its axis; it carries any other force and torque.
    pub(crate) torque_nm: Positive,
}
