//! `catalogue/1`: module types and the connectors they carry.

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::connector::Connector;
use super::number::{NonNegative, Positive, Real};

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
    /// Its rigid bodies.
    #[schemars(length(min = 1))]
    pub(crate) bodies: Vec<BodyType>,
    /// Where its connectors sit.
    pub(crate) ports: Ports,
    /// Connector on every face, for ports `faces`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) connector: Option<String>,
    /// Connector at a shared edge while pivoting: a `box`, z along the edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) hinge: Option<String>,
    /// What it is capable of.
    #[serde(default)]
    pub(crate) motions: Vec<Motion>,
    /// Joints between its bodies.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) joints: Vec<Joint>,
}

/// A rigid body of a module type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct BodyType {
    /// Name within the module type.
    pub(crate) name: String,
    /// Mass.
    pub(crate) mass_kg: NonNegative,
    /// Centre of mass in the module frame, by default its origin.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) com_m: Option<[Real; 3]>,
    /// Its solid, centred on the module frame.
    pub(crate) shape: Shape,
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

/// A place where a connector sits.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct PortType {
    /// Name within the module type.
    name: String,
    /// Body that it sits on.
    body: String,
    /// Where, in the body's frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    position_m: Option<[Real; 3]>,
    /// Outward direction, in the body's frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    axis: Option<[Real; 3]>,
    /// Name of the connector.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    connector: Option<String>,
    /// Whether connectors can engage anywhere on the body's surface.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    surface: bool,
}

/// A motion that a module is capable of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Motion {
    /// Over the faces of two coplanar neighbours.
    Slide,
    /// About an edge shared with a neighbour.
    Pivot,
    /// Of a port over a surface.
    Roll,
    /// Of a joint.
    Rotate,
}

/// A revolute joint between two bodies of a module type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Joint {
    /// Name within the module type.
    name: String,
    /// The body that it is fixed to.
    parent: String,
    /// The body that it turns.
    child: String,
    /// Direction of its axis in the parent's frame.
    axis: [Real; 3],
    /// A point of its axis in the parent's frame.
    origin_m: [Real; 3],
    /// Smallest and largest position.
    range_deg: [Real; 2],
    /// Step between positions.
    step_deg: Positive,
    /// Holding torque.
    torque_nm: Positive,
}
