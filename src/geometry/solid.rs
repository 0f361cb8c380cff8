//! Convex solids at a pose.

use std::sync::Arc;

use crate::robot::Shape;
use crate::spatial::{Point, Pose, Vec3};

use super::figure::Figure;

/// A convex solid at a pose in W.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Its shape.
    pub shape: Shape,
    /// Pose of the shape's frame in W.
    pub pose: Pose,
}

impl Solid {
    /// A solid from its two parts.
    pub const fn new(shape: Shape, pose: Pose) -> Self {
        Self { shape, pose }
    }

    /// A point inside, in W, in m: the centre of its shape.
    pub fn centre(&self) -> Vec3 {
        match &self.shape {
            Shape::Cuboid { .. } | Shape::Cylinder { .. } | Shape::Ball { .. } => self.pose.translation.vector,
            Shape::Convex(hull) => (self.pose * Point::from(hull.centre())).coords,
        }
    }

    /// Half of the largest extent along its own axes, in m.
    pub fn size(&self) -> f64 {
        match &self.shape {
            Shape::Cuboid { half_extents } => half_extents.max(),
            Shape::Cylinder { radius, height } => radius.max(height / 2.0),
            Shape::Ball { radius } => *radius,
            Shape::Convex(hull) => {
                let (low, high) = bounds(hull.corners());
                (high - low).max() / 2.0
            }
        }
    }

    /// Half extents of a cuboid along its own axes, in m.
    pub(super) fn cuboid(&self) -> Option<Vec3> {
        match self.shape {
            Shape::Cuboid { half_extents } => Some(half_extents),
            Shape::Cylinder { .. } | Shape::Ball { .. } | Shape::Convex(_) => None,
        }
    }

    /// Whether it is bounded by more than planes.
    pub(super) fn is_round(&self) -> bool {
        match self.shape {
            Shape::Cuboid { .. } | Shape::Convex(_) => false,
            Shape::Cylinder { .. } | Shape::Ball { .. } => true,
        }
    }

    /// Its axes in W, unit length.
    pub(super) fn axes(&self) -> [Vec3; 3] {
        let matrix = self.pose.rotation.to_rotation_matrix().into_inner();
        [0, 1, 2].map(|i| matrix.column(i).into_owned())
    }

    /// Corners in W in m: of a cuboid or a hull its own, of what is round those of the
    /// smallest box around it along its own axes.
    pub fn vertices(&self) -> Vec<Vec3> {
        let half = match &self.shape {
            Shape::Cuboid { half_extents } => *half_extents,
            Shape::Cylinder { radius, height } => Vec3::new(*radius, *radius, height / 2.0),
            Shape::Ball { radius } => Vec3::repeat(*radius),
            Shape::Convex(hull) => {
                return hull.corners().iter().map(|p| (self.pose * Point::from(*p)).coords).collect();
            }
        };
        let corner = |i: usize| {
            let sign = |bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
            (self.pose * Point::new(sign(1) * half.x, sign(2) * half.y, sign(4) * half.z)).coords
        };
        (0..8).map(corner).collect()
    }

    /// Lowest and highest corner of its axis-aligned bounding box in W, in m.
    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        let around = |half: Vec3| (self.centre() - half, self.centre() + half);
        match &self.shape {
            Shape::Cuboid { half_extents } => {
                let matrix = self.pose.rotation.to_rotation_matrix().into_inner();
                around(matrix.abs() * half_extents)
            }
            Shape::Ball { radius } => around(Vec3::repeat(*radius)),
            Shape::Cylinder { .. } => {
                let figure = Figure::new(self);
                around([0, 1, 2].map(|i| figure.reach(&Vec3::ith(i, 1.0)) - self.centre()[i]).into())
            }
            Shape::Convex(_) => bounds(&self.vertices()),
        }
    }

    /// A solid that holds every point within `by` in m, at least 0, of this one.
    #[must_use]
    pub fn grown(&self, by: f64) -> Self {
        let shape = match &self.shape {
            Shape::Cuboid { half_extents } => Shape::Cuboid { half_extents: half_extents.add_scalar(by) },
            Shape::Cylinder { radius, height } => Shape::Cylinder { radius: radius + by, height: height + 2.0 * by },
            Shape::Ball { radius } => Shape::Ball { radius: radius + by },
            // Every face moves outwards by at least that, as none is nearer to the centre than the nearest.
            Shape::Convex(hull) => Shape::Convex(Arc::new(hull.scaled(1.0 + by / hull.inner_radius()))),
        };
        Self { shape, pose: self.pose }
    }

    /// The same solid with every face moved inwards by `skin` in m, those of a hull at
    /// least by that; a solid thinner than twice that becomes flat.
    #[must_use]
    pub(super) fn shrunk(&self, skin: f64) -> Self {
        let less = |length: f64| (length - skin).max(0.0);
        let shape = match &self.shape {
            Shape::Cuboid { half_extents } => Shape::Cuboid { half_extents: half_extents.map(less) },
            Shape::Cylinder { radius, height } => {
                Shape::Cylinder { radius: less(*radius), height: 2.0 * less(height / 2.0) }
            }
            Shape::Ball { radius } => Shape::Ball { radius: less(*radius) },
            Shape::Convex(hull) => {
                let share = less(hull.inner_radius()) / hull.inner_radius();
                Shape::Convex(Arc::new(hull.scaled(share)))
            }
        };
        Self { shape, pose: self.pose }
    }
}

fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let extreme = |of: fn(&Vec3, &Vec3) -> Vec3| points.iter().skip(1).fold(points[0], |so_far, p| of(&so_far, p));
    (extreme(Vec3::inf), extreme(Vec3::sup))
}
