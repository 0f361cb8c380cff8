//! `certificate/1`: a bracket with the two fields that prove it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::check::Verdict;
use super::number::{NonNegative, Real};
use super::plan::Bracket;
use super::structure::Structure;

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub(crate) enum CertificateFormat {
    /// The first version.
    #[serde(rename = "certificate/1")]
    V1,
}

/// A claim about a structure with its proof, so that it stands on its own. SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Certificate {
    /// Name and version of the format.
    pub(crate) format: CertificateFormat,
    /// SHA-256, in hexadecimal digits, of this document as compact JSON with this key
    /// empty: guards against accidental damage, and proves nothing.
    pub(crate) checksum_sha256: String,
    /// What is claimed.
    pub(crate) verdict: Verdict,
    /// Bracket of the smallest common factor on all rated strengths with which it stands;
    /// null when whole-body-unstable.
    pub(crate) utilisation: Option<Bracket>,
    /// What it is claimed of.
    pub(crate) structure: Structure,
    /// Forces that hold it: the proof of the upper end; null when there is none.
    pub(crate) stress: Option<Stress>,
    /// A motion in which it fails: the proof of the lower end; null when that is 0.
    pub(crate) mechanism: Option<Mechanism>,
}

/// Forces that hold a structure.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Stress {
    /// What each connection carries, in the structure's order.
    pub(crate) connections: Vec<Carried>,
    /// Force on each contact's `body`, in the world frame, in the structure's order.
    pub(crate) contact_forces_n: Vec<[Real; 3]>,
}

/// What a connection carries: a wrench through a cone or a box, the forces of its points
/// through a patch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Carried {
    /// Wrench on the child, at the connection point, in the connection frame.
    Wrench(CarriedWrench),
    /// Forces of a patch's points on the child, in the connection frame.
    Points(CarriedPoints),
}

/// A force and a torque.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CarriedWrench {
    /// Force.
    pub(crate) force_n: [Real; 3],
    /// Torque.
    pub(crate) torque_nm: [Real; 3],
}

/// Forces of points that add up to a wrench once the preload is subtracted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CarriedPoints {
    /// Preload of the face.
    pub(crate) preload_n: NonNegative,
    /// Force at each of the face's points.
    pub(crate) forces_n: Vec<[Real; 3]>,
}

/// A motion in which a structure fails.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Mechanism {
    /// The point that all twists refer to.
    pub(crate) about_m: [Real; 3],
    /// Twist of each body, in the structure's order: equal where bodies move as one.
    pub(crate) twists: Vec<Twist>,
}

/// A virtual velocity of a body, in the world frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Twist {
    /// Velocity of the body's point at `about_m`.
    pub(crate) linear_m_s: [Real; 3],
    /// Angular velocity.
    pub(crate) angular_rad_s: [Real; 3],
}
