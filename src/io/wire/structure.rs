//! `structure/1`: rigid bodies held by connections and contacts under loads.

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::connector::Connector;
use super::number::{NonNegative, Real};

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum StructureFormat {
    /// The first version.
    #[serde(rename = "structure/1")]
    V1,
}

/// Rigid bodies held by connections and contacts under loads. SI units, one
/// right-handed world frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Structure {
    /// Name and version of the format.
    pub(crate) format: StructureFormat,
    /// Gravity.
    pub(crate) gravity_m_s2: [Real; 3],
    /// The rigid bodies.
    pub(crate) bodies: Vec<Body>,
    /// Connector models by name.
    #[serde(default)]
    pub(crate) connectors: IndexMap<String, Connector>,
    /// Bodies held together.
    #[serde(default)]
    pub(crate) connections: Vec<Connection>,
    /// Point contacts that are not connections.
    #[serde(default)]
    pub(crate) contacts: Vec<Contact>,
    /// External loads beside gravity.
    #[serde(default)]
    pub(crate) loads: Vec<Load>,
}

/// A rigid body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Body {
    /// Unique name; not `world`.
    pub(crate) id: String,
    /// Mass.
    pub(crate) mass_kg: NonNegative,
    /// Centre of mass.
    pub(crate) com_m: [Real; 3],
    /// Whether it is held immovably.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub(crate) fixed: bool,
}

/// Two bodies, or a body and the world, held together by a connector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Connection {
    /// Unique name; by default its place in the list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) id: Option<String>,
    /// A body or `world`.
    pub(crate) parent: String,
    /// A body or `world`; the frame's z axis points towards it.
    pub(crate) child: String,
    /// Name of the connector.
    pub(crate) connector: String,
    /// The connection point.
    pub(crate) position_m: [Real; 3],
    /// Orientation of the connection frame, a unit quaternion.
    pub(crate) rotation_xyzw: [Real; 4],
}

/// A frictional point contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Contact {
    /// Unique name; by default its place in the list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) id: Option<String>,
    /// The body that the normal points into.
    pub(crate) body: String,
    /// What it touches: a body or `world`.
    pub(crate) against: String,
    /// The contact point.
    pub(crate) position_m: [Real; 3],
    /// Unit normal, pointing into `body`.
    pub(crate) normal: [Real; 3],
    /// Friction coefficient.
    pub(crate) friction: NonNegative,
}

/// An external wrench on a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Load {
    /// The loaded body.
    pub(crate) body: String,
    /// Force.
    pub(crate) force_n: [Real; 3],
    /// Torque, by default none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) torque_nm: Option<[Real; 3]>,
    /// Point of action, by default the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) at_m: Option<[Real; 3]>,
}
