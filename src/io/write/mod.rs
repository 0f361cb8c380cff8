//! From core types to texts that read back equal.

mod check;
mod configuration;
mod connector;
mod errors;
mod plan;
mod structure;

use std::fmt;

use serde::Serialize;

use super::diagnostics::Diagnostics;
use super::document::{NamedStructure, PlanDocument};
use super::{layout, wire};
use crate::robot::Configuration;
use crate::spatial::{Rotation, Vec3};
use crate::statics::{Assessment, Bracket};

/// A value holds a NaN or an infinity where JSON has no way to say so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotFinite {
    problem: String,
}

impl fmt::Display for NotFinite {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.problem)
    }
}

impl std::error::Error for NotFinite {}

/// Writes a `structure/1` file that reads back equal, bit for bit.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit of a box.
pub fn write_structure(structure: &NamedStructure) -> Result<String, NotFinite> {
    text(&structure::wire(structure))
}

/// Writes a `configuration/1` file that reads back equal, bit for bit. A
/// catalogue that is not built in is written into it.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit of a box.
pub fn write_configuration(configuration: &Configuration) -> Result<String, NotFinite> {
    text(&configuration::start(configuration))
}

/// Writes a `plan/1` file that stands on its own. An end of a margin where
/// nothing was proved is `null`.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit or an unproved end.
pub fn write_plan(plan: &PlanDocument) -> Result<String, NotFinite> {
    text(&plan::wire(plan))
}

/// Writes a `check/1` report on an assessed structure, which took `seconds`.
///
/// `utilisation`, `margin` and `required_strength_n` are `null` when the verdict is
/// whole-body unstable; the lists are then empty. An end of a bracket where nothing was proved is `null`.
///
/// # Errors
/// A wrench or a force that is not finite.
pub fn write_check(structure: &NamedStructure, assessment: &Assessment, seconds: f64) -> Result<String, NotFinite> {
    text(&check::wire(structure, assessment, seconds))
}

impl Diagnostics {
    /// The problems as an `errors/1` document, for programs.
    pub fn to_json(&self) -> String {
        // Strings and counts only: nothing that JSON could not say.
        text(&errors::wire(self)).unwrap_or_default()
    }
}

fn text(wire: &impl Serialize) -> Result<String, NotFinite> {
    let value = serde_json::to_value(wire).map_err(|error| NotFinite { problem: error.to_string() })?;
    Ok(layout::text(&value))
}

fn vector(v: Vec3) -> [wire::Real; 3] {
    wire::reals([v.x, v.y, v.z])
}

fn xyzw(rotation: &Rotation) -> [wire::Real; 4] {
    let q = rotation.coords;
    wire::reals([q.x, q.y, q.z, q.w])
}

fn bracket(bracket: Bracket) -> wire::Bracket {
    let end = |value: f64| wire::Bound((!value.is_infinite()).then_some(value));
    wire::Bracket { lower: end(bracket.lower), upper: end(bracket.upper) }
}
