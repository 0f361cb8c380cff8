//! Shapes of rigid bodies.

use crate::spatial::Vec3;

/// A convex solid in its own frame.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A box with these half extents in m, centred on its frame.
    Cuboid {
        /// Half of the edge lengths along x, y and z in m, positive.
        half_extents: Vec3,
    },
}
