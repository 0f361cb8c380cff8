//! The built-in motions of lattice modules.

use crate::robot::lattice::Face;
use crate::robot::motion::{Motion, Turn};
use crate::robot::stencil::{MotionType, Stencil};

/// Names of the built-in motions.
pub const BUILT_IN_MOTIONS: [&str; 2] = ["slide", "pivot"];

impl MotionType {
    /// The built-in motion with this name.
    pub fn built_in(name: &str) -> Option<Self> {
        match name {
            "slide" => Some(Self::slide()),
            "pivot" => Some(Self::pivot()),
            _ => None,
        }
    }

    /// By one cell over the faces of two coplanar neighbours.
    pub fn slide() -> Self {
        let over = Stencil {
            motion: Motion::Translation { by: [1, 0, 0] },
            occupied: vec![[0, 0, -1], [1, 0, -1]],
            free: Vec::new(),
            mirrored: false,
        };
        Self { name: "slide".into(), stencils: vec![over] }
    }

    /// About an edge shared with a neighbour: by 90 degrees onto the face of the support's coplanar neighbour, or
    /// by 180 degrees round the support's convex edge.
    pub fn pivot() -> Self {
        let about = |turn| Motion::Rotation { support: Face::NegZ, towards: Face::PosX, turn };
        let quarter = Stencil {
            motion: about(Turn::Quarter),
            occupied: vec![[0, 0, -1], [1, 0, -1]],
            free: Vec::new(),
            mirrored: false,
        };
        let half = Stencil { motion: about(Turn::Half), occupied: vec![[0, 0, -1]], free: Vec::new(), mirrored: false };
        Self { name: "pivot".into(), stencils: vec![quarter, half] }
    }
}
