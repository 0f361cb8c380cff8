//! The three connector models, as data.
//!
//! Each model says which strength a wrench demands of the connector. All are
//! convex cones in (wrench, strength): twice the wrench demands twice the
//! strength, no wrench demands none, and pushing the bodies together is free.

use super::hull::edges;

/// A kind of connector: a model of its limits and its rated strength.
#[derive(Clone, Debug, PartialEq)]
pub struct Connector {
    /// Name, for reports.
    pub name: String,
    /// Rated characteristic strength S in N, positive.
    pub strength: f64,
    /// How the limits of the six wrench components are coupled.
    pub model: Model,
}

/// How a connector's limits depend on each other. Components are those of the
/// wrench on the child, in the connection frame, z towards the child; a
/// positive `f_z` pushes the bodies together (compression).
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// A magnetic or adhesive contact with coupled limits:
    /// `|(f_x/mu_x, f_y/mu_y, tau_x/rho_x, tau_y/rho_y, tau_z/rho_z)| <= s + f_z`.
    Cone {
        /// Friction coefficients mu along x and y, positive.
        friction: [f64; 2],
        /// Radii rho about x, y and z in m, positive.
        radius: [f64; 3],
    },
    /// A mechanical latch with independent limits, each scaled by `s / S`.
    /// A limit of `f64::INFINITY` never binds; a limit of 0 cannot be carried.
    Box {
        /// Limits of `|f_x|` and `|f_y|` in N.
        shear: [f64; 2],
        /// Limit of `-f_z` in N.
        tension: f64,
        /// Limit of `f_z` in N.
        compression: f64,
        /// Limits of `|tau_x|` and `|tau_y|` in N m.
        bending: [f64; 2],
        /// Limit of `|tau_z|` in N m.
        torsion: f64,
    },
    /// A face held by a preload `s` at the frame's origin: contact points in
    /// the plane z = 0 carry frictional forces.
    Patch {
        /// Friction coefficient of the face, not negative.
        friction: f64,
        /// Contact points (x, y) in m, in the connection frame; the origin
        /// must lie in their convex hull.
        points: Vec<[f64; 2]>,
    },
}

impl Model {
    /// Whether a connector of this kind holds whatever comes: it has no finite limit.
    pub(super) fn is_unlimited(&self) -> bool {
        match self {
            Self::Cone { .. } | Self::Patch { .. } => false,
            Self::Box { shear, tension, compression, bending, torsion } => {
                [shear[0], shear[1], *tension, *compression, bending[0], bending[1], *torsion]
                    .iter()
                    .all(|limit| *limit == f64::INFINITY)
            }
        }
    }

    /// Whether a connector of this kind with strength without bound joins its two bodies rigidly.
    pub(super) fn is_rigid(&self) -> bool {
        match self {
            Self::Cone { .. } => true,
            Self::Box { shear, tension, compression, bending, torsion } => {
                [shear[0], shear[1], *tension, *compression, bending[0], bending[1], *torsion]
                    .iter()
                    .all(|limit| *limit > 0.0)
            }
            Self::Patch { friction, points } => *friction > 0.0 && edges(points).iter().all(|edge| edge.distance > 0.0),
        }
    }
}
