//! Shapes of rigid bodies.

use std::sync::Arc;

use crate::spatial::Vec3;

use super::hull::Hull;
use super::problem::{Findings, Part};

/// A convex solid in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box with these half extents in m, centred on its frame.
    Cuboid {
        /// Half of the edge lengths along x, y and z in m, positive.
        half_extents: Vec3,
    },
    /// A right circular cylinder along z, centred on its frame.
    Cylinder {
        /// Radius in m, positive.
        radius: f64,
        /// Height along z in m, positive.
        height: f64,
    },
    /// A ball around the origin of its frame.
    Ball {
        /// Radius in m, positive.
        radius: f64,
    },
    /// The convex hull of points.
    Convex(Arc<Hull>),
}

impl Shape {
    /// Half extents in m of a cuboid; `None` for other shapes.
    pub fn cuboid(&self) -> Option<&Vec3> {
        match self {
            Self::Cuboid { half_extents } => Some(half_extents),
            Self::Cylinder { .. } | Self::Ball { .. } | Self::Convex(_) => None,
        }
    }

    /// Radius in m of a ball; `None` for other shapes.
    pub fn ball_radius(&self) -> Option<f64> {
        match self {
            Self::Ball { radius } => Some(*radius),
            Self::Cuboid { .. } | Self::Cylinder { .. } | Self::Convex(_) => None,
        }
    }

    /// Adds everything that is wrong with the shape, which is that of a part. A hull is sound by construction.
    pub(super) fn check(&self, findings: &mut Findings, part: Part) {
        match self {
            Self::Cuboid { half_extents } => findings.positive(part, "half_extents", half_extents.as_slice()),
            Self::Cylinder { radius, height } => {
                findings.positive(part, "radius", &[*radius]);
                findings.positive(part, "height", &[*height]);
            }
            Self::Ball { radius } => findings.positive(part, "radius", &[*radius]),
            Self::Convex(_) => {}
        }
    }
}

/// Why points or triangles make no shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeFault {
    /// A number is infinite, not a number, or larger than [`LARGEST`] in magnitude.
    OutOfBounds,
    /// A length that must be above zero is not.
    NotPositive,
    /// There are fewer items than it takes.
    TooFew {
        /// How many it takes.
        least: usize,
    },
    /// There are more items than are taken.
    TooMany {
        /// How many are taken.
        most: usize,
    },
    /// All points lie in a plane, or all triangles are without area.
    Flat,
    /// A row of heights is not as long as the first.
    Uneven {
        /// Index of the row.
        row: usize,
    },
    /// A triangle names a vertex that there is not.
    NoVertex {
        /// Index of the triangle.
        triangle: usize,
    },
}

/// Largest coordinate in m of a hull, a height field or a mesh: with them all squares and cubes of
/// lengths are finite and exact to far below a robot's tolerances.
pub const LARGEST: f64 = 1e6;

/// Whether all coordinates are finite and within [`LARGEST`].
pub(super) fn within_bounds<'a>(points: impl IntoIterator<Item = &'a Vec3>) -> bool {
    points.into_iter().flat_map(|p| p.iter()).all(|c| c.abs() <= LARGEST)
}
