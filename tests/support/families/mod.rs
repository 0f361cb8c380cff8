//! Structures whose utilisation follows from a page of statics by hand.
//! Every function also returns it, infinite where no strength helps.

mod beams;
mod hanging;
mod measures;
mod standing;

use nalgebra::UnitVector3;
use steadfast::spatial::{Pose, Rotation, Vec3};
use steadfast::statics::{Anchor, Body, Connection, Connector, Contact, Model, Structure};

pub use beams::{cantilever, cantilever_loop, clamped, sheared};
pub use hanging::{chain, hang, ladder_frame, lognormal, off_centre, pins, row, series, slab, two_chains};
pub use measures::{Measures, measured, resting, scaled_to, turned};
pub use standing::{incline, ladder, overhang, seesaw, towed, tripod};

/// Gravity in m/s^2.
pub const G: f64 = 9.81;

fn empty() -> Structure {
    Structure { gravity: Vec3::new(0.0, 0.0, -G), ..Structure::default() }
}

fn body(mass: f64, com: Vec3) -> Body {
    Body { mass, com, fixed: false }
}

fn magnet(strength: f64) -> Connector {
    magnet_with(strength, 0.8, 0.02)
}

fn magnet_with(strength: f64, friction: f64, radius: f64) -> Connector {
    let model = Model::Cone { friction: [friction; 2], radius: [radius; 3] };
    Connector { name: "magnet".to_owned(), strength, model }
}

fn latch(force: f64, torque: f64) -> Connector {
    let model = Model::Box {
        shear: [force; 2],
        tension: force,
        compression: f64::INFINITY,
        bending: [torque; 2],
        torsion: torque,
    };
    Connector { name: "latch".to_owned(), strength: force, model }
}

/// A frame at `at` whose z axis is `z`.
fn connection(parent: Anchor, child: Anchor, connector: usize, at: Vec3, z: Vec3) -> Connection {
    let half_turn = || Rotation::from_axis_angle(&UnitVector3::new_unchecked(Vec3::x()), std::f64::consts::PI);
    let rotation = Rotation::rotation_between(&Vec3::z(), &z).unwrap_or_else(half_turn);
    Connection { parent, child, connector, frame: Pose::from_parts(at.into(), rotation) }
}

fn contact(body: usize, against: Anchor, position: Vec3, normal: Vec3, friction: f64) -> Contact {
    Contact { body, against, position, normal, friction }
}
