//! Convex solids at a pose.

use crate::robot::{Obstacle, Shape};
use crate::spatial::{Point, Pose, Vec3};

/// A convex solid at a pose in W.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Its shape, centred on its own frame.
    pub shape: Shape,
    /// Pose of its frame in W.
    pub pose: Pose,
}

impl Solid {
    /// A solid from its two parts.
    pub const fn new(shape: Shape, pose: Pose) -> Self {
        Self { shape, pose }
    }

    /// Centre in W, in m.
    pub fn centre(&self) -> Vec3 {
        self.pose.translation.vector
    }

    /// Half of the largest extent along its own axes, in m.
    pub fn size(&self) -> f64 {
        self.half_extents().max()
    }

    /// Half extents along its own axes, in m.
    pub(super) fn half_extents(&self) -> Vec3 {
        let Shape::Cuboid { half_extents } = self.shape;
        half_extents
    }

    /// Its axes in W, unit length.
    pub(super) fn axes(&self) -> [Vec3; 3] {
        let matrix = self.pose.rotation.to_rotation_matrix().into_inner();
        [0, 1, 2].map(|i| matrix.column(i).into_owned())
    }

    /// Half of its extent along the direction `n` (unit) in W, in m.
    pub(super) fn half_extent_along(&self, n: &Vec3) -> f64 {
        let local = self.pose.rotation.inverse_transform_vector(n);
        self.half_extents().dot(&local.abs())
    }

    /// Its corners in W, in m.
    pub fn vertices(&self) -> [Vec3; 8] {
        let h = self.half_extents();
        std::array::from_fn(|i| {
            let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            (self.pose * Point::new(sign(1) * h.x, sign(2) * h.y, sign(4) * h.z)).coords
        })
    }

    /// Half extents of its axis-aligned bounding box in W, in m.
    pub(super) fn bounds(&self) -> Vec3 {
        let matrix = self.pose.rotation.to_rotation_matrix().into_inner();
        matrix.abs() * self.half_extents()
    }

    /// The same solid with every face moved inwards by `skin` in m; a solid
    /// thinner than twice that becomes flat.
    #[must_use]
    pub(super) fn shrunk(&self, skin: f64) -> Self {
        let half_extents = self.half_extents().map(|h| (h - skin).max(0.0));
        Self { shape: Shape::Cuboid { half_extents }, pose: self.pose }
    }
}

impl From<&Obstacle> for Solid {
    fn from(obstacle: &Obstacle) -> Self {
        Self::new(obstacle.shape.clone(), obstacle.pose)
    }
}
