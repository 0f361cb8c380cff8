//! Refuses structures that the oracle has no answer for.
//!
//! Solvers turn a NaN into a confident number, so nothing non-finite passes.

use std::fmt::Arguments;

use crate::spatial::Vec3;

use super::connector::Model;
use super::hull::origin_in_hull;
use super::structure::{Anchor, Structure};
use super::tolerances::UNIT;

/// What is wrong with a structure that cannot be assessed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidStructure {
    /// Where, as a path into [`Structure`], e.g. `bodies[3].mass`.
    pub place: String,
    /// What is wrong there.
    pub problem: String,
}

impl std::fmt::Display for InvalidStructure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)
    }
}

impl std::error::Error for InvalidStructure {}

/// Collects every reason why `structure` cannot be assessed.
///
/// # Errors
/// All problems at once, in the order of the structure's fields.
pub fn validate(structure: &Structure) -> Result<(), Vec<InvalidStructure>> {
    let mut found = Found(Vec::new());
    found.finite(format_args!("gravity"), &structure.gravity);
    for (i, body) in structure.bodies.iter().enumerate() {
        found.at_least_zero(format_args!("bodies[{i}].mass"), body.mass);
        found.finite(format_args!("bodies[{i}].com"), &body.com);
    }
    for (i, connector) in structure.connectors.iter().enumerate() {
        found.positive(format_args!("connectors[{i}].strength"), connector.strength);
        found.model(format_args!("connectors[{i}].model"), &connector.model);
    }
    let bodies = structure.bodies.len();
    for (i, connection) in structure.connections.iter().enumerate() {
        let place = format_args!("connections[{i}]");
        found.anchor(format_args!("{place}.parent"), connection.parent, bodies);
        found.anchor(format_args!("{place}.child"), connection.child, bodies);
        found.require(connection.parent != connection.child, place, "connects something to itself");
        found.require(
            connection.connector < structure.connectors.len(),
            format_args!("{place}.connector"),
            "there is no such connector",
        );
        found.finite(format_args!("{place}.frame"), &connection.frame.translation.vector);
        let length = connection.frame.rotation.as_ref().norm();
        found.require(
            (length - 1.0).abs() <= UNIT,
            format_args!("{place}.frame"),
            "the rotation is not a unit quaternion",
        );
    }
    for (i, contact) in structure.contacts.iter().enumerate() {
        let place = format_args!("contacts[{i}]");
        found.anchor(format_args!("{place}.body"), Anchor::Body(contact.body), bodies);
        found.anchor(format_args!("{place}.against"), contact.against, bodies);
        found.require(contact.against != Anchor::Body(contact.body), place, "a body touches itself");
        found.finite(format_args!("{place}.position"), &contact.position);
        found.require(
            (contact.normal.norm() - 1.0).abs() <= UNIT,
            format_args!("{place}.normal"),
            "the normal is not a unit vector",
        );
        found.at_least_zero(format_args!("{place}.friction"), contact.friction);
    }
    for (i, load) in structure.loads.iter().enumerate() {
        let place = format_args!("loads[{i}]");
        found.anchor(format_args!("{place}.body"), Anchor::Body(load.body), bodies);
        found.finite(format_args!("{place}.force"), &load.force);
        found.finite(format_args!("{place}.torque"), &load.torque);
        if let Some(at) = &load.at {
            found.finite(format_args!("{place}.at"), at);
        }
    }
    if found.0.is_empty() { Ok(()) } else { Err(found.0) }
}

struct Found(Vec<InvalidStructure>);

impl Found {
    fn require(&mut self, holds: bool, place: Arguments<'_>, problem: &str) {
        if !holds {
            self.0.push(InvalidStructure { place: place.to_string(), problem: problem.to_owned() });
        }
    }

    fn finite(&mut self, place: Arguments<'_>, vector: &Vec3) {
        self.require(vector.iter().all(|x| x.is_finite()), place, "is not finite");
    }

    fn at_least_zero(&mut self, place: Arguments<'_>, value: f64) {
        self.require(value.is_finite() && value >= 0.0, place, "must be finite and not negative");
    }

    fn positive(&mut self, place: Arguments<'_>, value: f64) {
        self.require(value.is_finite() && value > 0.0, place, "must be finite and positive");
    }

    fn anchor(&mut self, place: Arguments<'_>, anchor: Anchor, bodies: usize) {
        let exists = match anchor {
            Anchor::World => true,
            Anchor::Body(i) => i < bodies,
        };
        self.require(exists, place, "there is no such body");
    }

    fn model(&mut self, place: Arguments<'_>, model: &Model) {
        match model {
            Model::Cone { friction, radius } => {
                for mu in friction {
                    self.positive(format_args!("{place}.friction"), *mu);
                }
                for rho in radius {
                    self.positive(format_args!("{place}.radius"), *rho);
                }
            }
            Model::Box { shear, tension, compression, bending, torsion } => {
                let limits = [("shear", &shear[..]), ("tension", &[*tension]), ("compression", &[*compression])];
                let torques = [("bending", &bending[..]), ("torsion", &[*torsion])];
                for (name, values) in limits.into_iter().chain(torques) {
                    let holds = values.iter().all(|limit| *limit >= 0.0);
                    self.require(holds, format_args!("{place}.{name}"), "a limit must not be negative");
                }
            }
            Model::Patch { friction, points } => {
                self.at_least_zero(format_args!("{place}.friction"), *friction);
                let finite = points.iter().flatten().all(|x| x.is_finite());
                self.require(finite, format_args!("{place}.points"), "is not finite");
                self.require(
                    !finite || origin_in_hull(points),
                    format_args!("{place}.points"),
                    "the origin, where the preload acts, must lie in the convex hull of the points",
                );
            }
        }
    }
}
