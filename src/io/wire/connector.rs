//! Connector models as files write them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::number::{Limit, NonNegative, Positive, Real};

/// A connector model with its limits. Wrenches act on the child, in the
/// connection frame, whose z axis points from the connection point towards the child.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "model", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Connector {
    /// A magnetic or adhesive contact with coupled limits:
    /// |(f_x/mu_x, f_y/mu_y, tau_x/rho_x, tau_y/rho_y, tau_z/rho_z)| <= s + f_z.
    Cone {
        /// Rated characteristic strength S.
        strength_n: Positive,
        /// Friction coefficients along x and y.
        friction: [Positive; 2],
        /// Radii rho about x, y and z.
        radius_m: [Positive; 3],
    },
    /// A mechanical latch with independent limits; null is unlimited, 0 cannot be carried.
    Box {
        /// Rated characteristic strength S: scales what is reported in newtons.
        strength_n: Positive,
        /// Limits of |f_x| and |f_y|.
        shear_n: [Limit; 2],
        /// Limit of pulling the bodies apart.
        tension_n: Limit,
        /// Limit of pushing the bodies together.
        compression_n: Limit,
        /// Limits of |tau_x| and |tau_y|.
        bending_nm: [Limit; 2],
        /// Limit of |tau_z|.
        torsion_nm: Limit,
    },
    /// A face held by a preload at its centre, with frictional contact points in the plane z = 0.
    Patch {
        /// Rated characteristic strength S: the preload.
        strength_n: Positive,
        /// Friction coefficient of the face.
        friction: NonNegative,
        /// Contact points, whose convex hull must contain the origin. Without
        /// them, in a catalogue, the corners of the face it sits on.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        points_m: Option<Vec<[Real; 2]>>,
    },
}
