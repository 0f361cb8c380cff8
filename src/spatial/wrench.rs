//! A force and a torque about a point.

use std::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use super::{Rotation, Vec3};

/// A force in N and a torque in N m, about a point and in a frame that the
/// context names.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// Force in N.
    pub force: Vec3,
    /// Torque in N m about the point of action.
    pub torque: Vec3,
}

impl Wrench {
    /// No force and no torque.
    pub const ZERO: Self = Self { force: Vec3::new(0.0, 0.0, 0.0), torque: Vec3::new(0.0, 0.0, 0.0) };

    /// A wrench from its two parts.
    pub const fn new(force: Vec3, torque: Vec3) -> Self {
        Self { force, torque }
    }

    /// The same wrench about another point: `lever` leads from the new point
    /// to the old one, in m. `torque' = torque + lever x force`.
    #[must_use]
    pub fn moved(&self, lever: &Vec3) -> Self {
        Self { force: self.force, torque: self.torque + lever.cross(&self.force) }
    }

    /// The wrench about the same point, expressed in a frame turned by
    /// `rotation` (`f_a = r_ab * f_b`).
    #[must_use]
    pub fn rotated(&self, rotation: &Rotation) -> Self {
        Self { force: rotation * self.force, torque: rotation * self.torque }
    }

    /// Whether all six components are finite.
    pub fn is_finite(&self) -> bool {
        self.force.iter().chain(self.torque.iter()).all(|x| x.is_finite())
    }
}

impl Add for Wrench {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

impl AddAssign for Wrench {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Wrench {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl SubAssign for Wrench {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl Neg for Wrench {
    type Output = Self;
    fn neg(self) -> Self {
        Self { force: -self.force, torque: -self.torque }
    }
}

impl Mul<f64> for Wrench {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { force: self.force * factor, torque: self.torque * factor }
    }
}
