//! One-parameter motions of a rigid body.

use nalgebra::Unit;

use crate::spatial::{Point, Pose, Rotation, Vec3};

/// A motion of a body in W, run through by a phase from 0 to 1.
#[derive(Clone, Debug, PartialEq)]
pub enum Motion {
    /// A straight displacement.
    Translation {
        /// Displacement at phase 1, in m.
        by: Vec3,
    },
    /// A rotation about a fixed line.
    Rotation {
        /// A point of the line, in m.
        centre: Vec3,
        /// Direction of the line; right-handed.
        axis: Unit<Vec3>,
        /// Angle at phase 1, in rad.
        angle: f64,
    },
}

impl Motion {
    /// The displacement of W's points at a phase: `pose = at(phase) * start`.
    pub fn at(&self, phase: f64) -> Pose {
        match self {
            Self::Translation { by } => Pose::translation(by.x * phase, by.y * phase, by.z * phase),
            Self::Rotation { centre, axis, angle } => {
                let rotation = Rotation::from_axis_angle(axis, angle * phase);
                Pose::rotation_wrt_point(rotation, Point::from(*centre))
            }
        }
    }

    /// The pose at a phase of a body that starts at `start`.
    pub fn pose(&self, start: &Pose, phase: f64) -> Pose {
        self.at(phase) * start
    }

    /// Length in m of the way that a point goes, in one unit of phase.
    pub(super) fn speed_of(&self, point: &Vec3) -> f64 {
        match self {
            Self::Translation { by } => by.norm(),
            Self::Rotation { centre, axis, angle } => axis.cross(&(point - centre)).norm() * angle.abs(),
        }
    }

    /// By how much the phase may rise from that at which corners of the body are
    /// at `points`, until one of them has gone `gap` in m, at least 0, beyond
    /// where the last of them is now against `normal` (unit). Exact but for
    /// rounding; infinite when none ever does.
    pub(super) fn free_advance(&self, points: &[Vec3], normal: &Vec3, gap: f64) -> f64 {
        match self {
            Self::Translation { by } => {
                let approach = -normal.dot(by);
                if approach > 0.0 { gap / approach } else { f64::INFINITY }
            }
            Self::Rotation { centre, axis, angle } => {
                let axis = axis.into_inner() * angle.signum();
                let last = points.iter().map(|p| normal.dot(p)).fold(f64::INFINITY, f64::min);
                let free = |p: &Vec3| free_angle(&(p - centre), &axis, normal, normal.dot(p) - last + gap);
                points.iter().map(free).fold(f64::INFINITY, f64::min) / angle.abs()
            }
        }
    }
}

/// Angle in rad by which the point at `arm` from a unit `axis` through the origin turns
/// until it has moved by `gap` against `normal`.
///
/// Along the normal the point is at `level + radius cos(angle - peak)`, highest
/// at the angle `peak` from where it is now.
fn free_angle(arm: &Vec3, axis: &Vec3, normal: &Vec3, gap: f64) -> f64 {
    let across = axis.cross(arm);
    let radial = across.cross(axis);
    let (cos, sin) = (normal.dot(&radial), normal.dot(&across));
    let radius = cos.hypot(sin);
    let lowest = cos - gap;
    if lowest <= -radius {
        return f64::INFINITY;
    }
    // The point is above `lowest` now, so now is within `reach` of the peak.
    let peak = sin.atan2(cos);
    let reach = (lowest / radius).min(1.0).acos();
    (peak + reach).max(0.0)
}
