//! Rigid-body vocabulary: poses, wrenches, twists.
//!
//! Everything is SI (m, N, N m, rad) and right-handed. Forces come before
//! torques and linear before angular velocities, as in ROS. This module knows
//! `nalgebra` and nothing else; it does not know bodies, robots or files.

mod twist;
mod wrench;

pub use twist::Twist;
pub use wrench::Wrench;

/// A 3-vector: a position in m, a direction, a force in N, a torque in N m.
pub type Vec3 = nalgebra::Vector3<f64>;

/// A rigid transform `x_ab`: the pose of frame B in frame A, so that
/// `p_a = x_ab * p_b`.
pub type Pose = nalgebra::Isometry3<f64>;

/// A rotation as a unit quaternion.
pub type Rotation = nalgebra::UnitQuaternion<f64>;

/// A position as a `nalgebra` point, which is what [`Pose`] transforms.
pub type Point = nalgebra::Point3<f64>;
