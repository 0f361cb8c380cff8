//! Shapes of rigid bodies.

use crate::spatial::Vec3;

use super::problem::{Findings, Part};

/// A convex solid in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box with these half extents in m, centred on its frame.
    Cuboid {
        /// Half of the edge lengths along x, y and z in m, positive.
        half_extents: Vec3,
    },
}

impl Shape {
    /// Half extents in m of a cuboid; `None` for other shapes.
    pub fn cuboid(&self) -> Option<&Vec3> {
        match self {
            Self::Cuboid { half_extents } => Some(half_extents),
        }
    }

    /// Radius in m of a ball; `None` for other shapes.
    pub fn ball_radius(&self) -> Option<f64> {
        match self {
            Self::Cuboid { .. } => None,
        }
    }

    /// Adds everything that is wrong with the shape, which is that of a part.
    pub(super) fn check(&self, findings: &mut Findings, part: Part) {
        match self {
            Self::Cuboid { half_extents } => findings.positive(part, "half_extents", half_extents.as_slice()),
        }
    }
}
