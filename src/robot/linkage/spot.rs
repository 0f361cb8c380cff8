//! Where and how a port sits on the surface of a ball, in integers.

use nalgebra::Vector3;

use crate::spatial::{Rotation, Vec3};

/// Units in one degree.
pub const MICRO: i32 = 1_000_000;

/// Half a turn in micro-degrees.
const HALF: i32 = 180 * MICRO;

/// How a port engages with the surface of a ball, in micro-degrees.
///
/// `R = R_z(azimuth) R_y(polar) R_z(spin)` turns the frame of the ball's body to the frame of the
/// connection, z outwards from the ball: azimuth and polar angle are where the port sits, spin is how it
/// is turned there. One rotation has one spot: the polar angle is from 0 to 180 degrees, the others are from
/// 0 to below 360, and at the poles, where azimuth and spin turn about the same axis, the azimuth is 0.
///
/// A direction that is measured is rounded to a micro-degree (2 nm at 0.1 m); every plan goes by
/// these integers, so it runs backwards to the state that it came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Spot {
    azimuth: i32,
    polar: i32,
    spin: i32,
}

impl Spot {
    /// The spot of these angles in micro-degrees, whatever their size.
    pub fn new(azimuth: i32, polar: i32, spin: i32) -> Self {
        let turn = |angle: i64| angle.rem_euclid(2 * i64::from(HALF));
        let (mut azimuth, mut spin) = (i64::from(azimuth), i64::from(spin));
        let mut polar = turn(i64::from(polar));
        if polar > i64::from(HALF) {
            // R_y(-p) = R_z(180) R_y(p) R_z(180)
            polar = 2 * i64::from(HALF) - polar;
            azimuth += i64::from(HALF);
            spin += i64::from(HALF);
        }
        if polar == 0 {
            (azimuth, spin) = (0, azimuth + spin);
        } else if polar == i64::from(HALF) {
            (azimuth, spin) = (0, spin - azimuth);
        }
        let narrow = |angle: i64| i32::try_from(angle).expect("below a turn");
        Self { azimuth: narrow(turn(azimuth)), polar: narrow(polar), spin: narrow(turn(spin)) }
    }

    /// The spot nearest to a rotation from the ball's frame to the connection's.
    pub fn of(rotation: &Rotation) -> Self {
        let z = rotation * Vec3::z();
        let across = z.x.hypot(z.y);
        let polar = micro(across.atan2(z.z));
        let azimuth = if polar == 0 || polar == HALF { 0 } else { micro(z.y.atan2(z.x)) };
        let upright = (about_z(azimuth) * about_y(polar)).inverse() * rotation;
        let x = upright * Vec3::x();
        Self::new(azimuth, polar, micro(x.y.atan2(x.x)))
    }

    /// Angle about the ball's z axis from its x axis, 0 to below 360 degrees, in micro-degrees.
    pub const fn azimuth(self) -> i32 {
        self.azimuth
    }

    /// Angle from the ball's z axis, 0 to 180 degrees, in micro-degrees.
    pub const fn polar(self) -> i32 {
        self.polar
    }

    /// Angle about the direction outwards, 0 to below 360 degrees, in micro-degrees.
    pub const fn spin(self) -> i32 {
        self.spin
    }

    /// The rotation from the ball's frame to the connection's.
    pub fn rotation(self) -> Rotation {
        about_z(self.azimuth) * about_y(self.polar) * about_z(self.spin)
    }

    /// Direction outwards in the ball's frame, a unit vector.
    pub fn direction(self) -> Vec3 {
        self.rotation() * Vec3::z()
    }
}

/// An angle in rad, in micro-degrees.
fn micro(angle: f64) -> i32 {
    (angle.to_degrees() * f64::from(MICRO)).round() as i32
}

fn about_y(angle: i32) -> Rotation {
    Rotation::from_axis_angle(&Vector3::y_axis(), radians(angle))
}

fn about_z(angle: i32) -> Rotation {
    Rotation::from_axis_angle(&Vector3::z_axis(), radians(angle))
}

fn radians(angle: i32) -> f64 {
    (f64::from(angle) / f64::from(MICRO)).to_radians()
}
