//! A velocity of a rigid body.

use super::{Vec3, Wrench};

/// A virtual velocity of a rigid body: the linear velocity in m/s of a named
/// point of it, and the angular velocity in rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    /// Velocity in m/s of the body's reference point.
    pub linear: Vec3,
    /// Angular velocity in rad/s.
    pub angular: Vec3,
}

impl Twist {
    /// No motion.
    pub const ZERO: Self = Self { linear: Vec3::new(0.0, 0.0, 0.0), angular: Vec3::new(0.0, 0.0, 0.0) };

    /// A twist from its two parts.
    pub const fn new(linear: Vec3, angular: Vec3) -> Self {
        Self { linear, angular }
    }

    /// Velocity in m/s of the body's point that `arm` leads to from the
    /// reference point.
    pub fn at(&self, arm: &Vec3) -> Vec3 {
        self.linear + self.angular.cross(arm)
    }

    /// The twist with the body's point at `arm` as its reference point.
    #[must_use]
    pub fn moved(&self, arm: &Vec3) -> Self {
        Self { linear: self.at(arm), angular: self.angular }
    }

    /// Power in W that `wrench`, about the reference point, delivers.
    pub fn power(&self, wrench: &Wrench) -> f64 {
        self.linear.dot(&wrench.force) + self.angular.dot(&wrench.torque)
    }

    /// Whether all six components are finite.
    pub fn is_finite(&self) -> bool {
        self.linear.iter().chain(self.angular.iter()).all(|x| x.is_finite())
    }
}
