//! Arithmetic that cannot round in our favour.
//!
//! An [`Interval`] holds a real number that is known only to lie between two
//! doubles. Every operation returns an interval that holds the exact result for
//! all numbers in its operands: each end is computed in ordinary arithmetic, whose
//! error is at most half a unit in the last place, and moved outwards by one whole
//! unit. What is no number at all becomes the interval of all numbers, about which
//! nothing can be proved.

use std::ops::{Add, Div, Mul, Neg, Sub};

use crate::spatial::{Rotation, Vec3};

/// Holds a real number: `lower <= x <= upper`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// Largest double that is proved to be at most the number.
    pub lower: f64,
    /// Smallest double that is proved to be at least the number.
    pub upper: f64,
}

impl Interval {
    /// The number 0, exactly.
    pub const ZERO: Self = Self { lower: 0.0, upper: 0.0 };

    /// Any number: nothing is known.
    pub const ALL: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY };

    /// A double, exactly; [`Self::ALL`] for what is not finite.
    pub fn exact(x: f64) -> Self {
        if x.is_finite() { Self { lower: x, upper: x } } else { Self::ALL }
    }

    /// The ends of a computed result, moved outwards by the rounding that they may have.
    fn outward(lower: f64, upper: f64) -> Self {
        if lower.is_nan() || upper.is_nan() {
            return Self::ALL;
        }
        Self { lower: lower.next_down(), upper: upper.next_up() }
    }

    /// The larger of the number's distances from 0.
    pub fn magnitude(self) -> f64 {
        self.lower.abs().max(self.upper.abs())
    }

    /// `x * x`, which is not negative.
    pub fn square(self) -> Self {
        let product = self * self;
        Self { lower: product.lower.max(0.0), upper: product.upper }
    }

    /// `sqrt(max(x, 0))`.
    pub fn sqrt(self) -> Self {
        if self == Self::ZERO {
            return self;
        }
        let root = Self::outward(self.lower.max(0.0).sqrt(), self.upper.max(0.0).sqrt());
        Self { lower: root.lower.max(0.0), upper: root.upper }
    }
}

impl Add for Interval {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        if self == Self::ZERO {
            return other;
        }
        if other == Self::ZERO {
            return self;
        }
        Self::outward(self.lower + other.lower, self.upper + other.upper)
    }
}

impl Neg for Interval {
    type Output = Self;
    fn neg(self) -> Self {
        Self { lower: -self.upper, upper: -self.lower }
    }
}

impl Sub for Interval {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Interval {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        if self == Self::ZERO || other == Self::ZERO {
            return Self::ZERO;
        }
        hull([self.lower * other.lower, self.lower * other.upper, self.upper * other.lower, self.upper * other.upper])
    }
}

impl Div for Interval {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if other.lower <= 0.0 && other.upper >= 0.0 {
            return Self::ALL;
        }
        if self == Self::ZERO {
            return Self::ZERO;
        }
        hull([self.lower / other.lower, self.lower / other.upper, self.upper / other.lower, self.upper / other.upper])
    }
}

/// The interval between the smallest and the largest of computed results, outwards.
fn hull(results: [f64; 4]) -> Interval {
    if results.iter().any(|x| x.is_nan()) {
        return Interval::ALL;
    }
    let [a, b, c, d] = results;
    Interval::outward(a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
}

/// Length of a list of numbers as a vector.
pub fn length(parts: &[Interval]) -> Interval {
    parts.iter().fold(Interval::ZERO, |sum, part| sum + part.square()).sqrt()
}

/// A vector of intervals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vector {
    /// First component.
    pub x: Interval,
    /// Second component.
    pub y: Interval,
    /// Third component.
    pub z: Interval,
}

impl Vector {
    /// The zero vector, exactly.
    pub const ZERO: Self = Self { x: Interval::ZERO, y: Interval::ZERO, z: Interval::ZERO };

    /// A vector of doubles, exactly.
    pub fn exact(v: &Vec3) -> Self {
        Self { x: Interval::exact(v.x), y: Interval::exact(v.y), z: Interval::exact(v.z) }
    }

    /// The vector times a number.
    pub fn times(&self, factor: Interval) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor }
    }

    /// Scalar product.
    pub fn dot(&self, other: &Self) -> Interval {
        self.x * other.x + self.y * other.y + self.z * other.z
    }

    /// Vector product.
    pub fn cross(&self, other: &Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }

    /// Length of the vector.
    pub fn norm(&self) -> Interval {
        length(&[self.x, self.y, self.z])
    }

    /// The vector divided by its length.
    pub fn unit(&self) -> Self {
        let norm = self.norm();
        Self { x: self.x / norm, y: self.y / norm, z: self.z / norm }
    }
}

impl Add for Vector {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { x: self.x + other.x, y: self.y + other.y, z: self.z + other.z }
    }
}

impl Neg for Vector {
    type Output = Self;
    fn neg(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z }
    }
}

impl Sub for Vector {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

/// The axes of a frame in W.
#[derive(Clone, Copy, Debug)]
pub struct Axes([Vector; 3]);

impl Axes {
    /// The axes of a rotation: those of its quaternion (x, y, z, w) brought to unit length.
    pub fn of(rotation: &Rotation) -> Self {
        let [x, y, z, w] = [rotation.i, rotation.j, rotation.k, rotation.w].map(Interval::exact);
        let two = Interval::exact(2.0);
        let norm = x.square() + y.square() + z.square() + w.square();
        let diagonal =
            |a: Interval, b: Interval, c: Interval| (w.square() + a.square() - b.square() - c.square()) / norm;
        let twice = |a: Interval, b: Interval| two * (a + b) / norm;
        Self([
            Vector { x: diagonal(x, y, z), y: twice(x * y, w * z), z: twice(x * z, -(w * y)) },
            Vector { x: twice(x * y, -(w * z)), y: diagonal(y, x, z), z: twice(y * z, w * x) },
            Vector { x: twice(x * z, w * y), y: twice(y * z, -(w * x)), z: diagonal(z, x, y) },
        ])
    }

    /// A vector given in the frame, in W.
    pub fn to_world(&self, local: &Vector) -> Vector {
        let [x, y, z] = &self.0;
        x.times(local.x) + y.times(local.y) + z.times(local.z)
    }

    /// A vector given in W, in the frame.
    pub fn to_local(&self, world: &Vector) -> Vector {
        let [x, y, z] = &self.0;
        Vector { x: x.dot(world), y: y.dot(world), z: z.dot(world) }
    }
}
