//! From core types to texts that read back equal.

mod catalogue;
mod certificate;
mod check;
mod configuration;
mod connector;
mod errors;
mod gives_way;
mod in_the_way;
mod lattice_plan;
mod linkage;
mod linkage_plan;
mod load_range;
mod outcome;
mod partial_order;
mod plan;
mod result;
mod rofi;
mod sequence;
mod structure;

pub(super) use certificate::checksum as certificate_checksum;
pub use check::in_space_because;

use std::fmt;

use serde::Serialize;

use super::certificate_document::CertificateDocument;
use super::check_report::CheckReport;
use super::diagnostics::Diagnostics;
use super::document::NamedStructure;
use super::form::Form;
use super::load_range_report::LoadRangeReport;
use super::partial_order_report::PartialOrderReport;
use super::plan_document::{LinkagePlanDocument, PlanDocument};
use super::{layout, wire};
use crate::reconfigure::linkage::assembly::Touched;
use crate::robot::linkage::{self as linkage_core, Linkage};
use crate::robot::{Catalogue, Configuration, Goal};
use crate::spatial::{Rotation, Vec3};
use crate::statics::Bracket;
use crate::suite::{Job, Point, Record};

/// A value that its format has no way to say: a NaN, an infinity, or a plan that is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unwritable {
    problem: String,
}

impl Unwritable {
    fn new(what: impl fmt::Display) -> Self {
        Self { problem: format!("cannot be written: {what}") }
    }
}

impl fmt::Display for Unwritable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.problem)
    }
}

impl std::error::Error for Unwritable {}

/// Writes a `structure/1` file that reads back equal, bit for bit.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit of a box.
pub fn write_structure(structure: &NamedStructure) -> Result<String, Unwritable> {
    text(&structure::wire(structure))
}

/// Writes a `partial-order/1` report about the best plan of a document.
///
/// # Errors
/// A number that is not finite, or a document without a plan.
pub fn write_partial_order(document: &PlanDocument, report: &PartialOrderReport<'_>) -> Result<String, Unwritable> {
    text(&partial_order::of_lattice(document, report)?)
}

/// Writes a `partial-order/1` report about the best plan of a document for a linkage.
///
/// # Errors
/// A number that is not finite, or a document without a plan.
pub fn write_linkage_partial_order(
    document: &LinkagePlanDocument,
    report: &PartialOrderReport<'_, Touched>,
) -> Result<String, Unwritable> {
    text(&partial_order::of_linkage(document, report)?)
}

/// Writes a `configuration/1` file that reads back equal, bit for bit. A
/// catalogue that is not built in is written into it.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit of a box.
pub fn write_configuration(configuration: &Configuration) -> Result<String, Unwritable> {
    text(&configuration::start(configuration))
}

/// Writes a `configuration/1` file of a linkage that reads back equal, bit for bit, with
/// [`read_linkage`](super::read_linkage): every module with its pose and its joints. A catalogue that is not
/// built in is written into it.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit of a box.
pub fn write_linkage(linkage: &Linkage) -> Result<String, Unwritable> {
    text(&linkage::start(linkage))
}

/// Writes a `configuration/1` file of a goal of lattice modules, which takes from its start whatever it does not say.
///
/// # Errors
/// A number that is not finite.
pub fn write_goal(goal: &Goal) -> Result<String, Unwritable> {
    text(&configuration::goal(goal))
}

/// Writes a `configuration/1` file of a goal of a linkage, as [`write_goal`] does one of lattice modules.
///
/// # Errors
/// A number that is not finite.
pub fn write_linkage_goal(goal: &linkage_core::Goal) -> Result<String, Unwritable> {
    text(&linkage::goal(goal))
}

/// Writes a `result/1` document on a line of its own, the line feed included.
///
/// # Errors
/// A number that is not finite where one has to be.
pub fn write_result(job: &Job, record: &Record) -> Result<String, Unwritable> {
    line(&result::wire(job, record))
}

/// Writes what becomes known of a running job on a line of its own, the line feed included.
///
/// # Errors
/// A time that is not finite.
pub fn write_point(point: &Point) -> Result<String, Unwritable> {
    line(&result::point(point))
}

/// Writes a robot of RoFI modules as a file of that platform, in the form that is asked for.
///
/// # Errors
/// What the format cannot express, one sentence each; for [`Form::Own`] that it is none of the platform's.
pub fn write_rofi(linkage: &Linkage, form: Form) -> Result<String, Vec<String>> {
    let json = |text: Result<String, Unwritable>| text.map_err(|problem| vec![problem.to_string()]);
    match form {
        Form::Own | Form::Tables => Err(vec!["it is no format of the RoFI platform".to_string()]),
        Form::RofiWorld => rofi::world(linkage).and_then(|world| json(text(&world))),
        Form::RofiText => rofi::text(linkage),
        Form::RofiVoxels => rofi::voxels(linkage).and_then(|voxels| json(text(&voxels))),
    }
}

/// Writes a `catalogue/1` file that reads back equal, bit for bit.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit of a box.
pub fn write_catalogue(catalogue: &Catalogue) -> Result<String, Unwritable> {
    text(&catalogue::wire(catalogue))
}

/// Writes a `plan/1` file that stands on its own. An end of a margin where
/// nothing was proved is `null`.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit or an unproved end; an
/// action on a module that there is not; a pivot that no turn makes.
pub fn write_plan(plan: &PlanDocument) -> Result<String, Unwritable> {
    text(&plan::wire(plan)?)
}

/// Writes a `plan/1` file of a linkage, as [`write_plan`] does one of lattice modules.
///
/// # Errors
/// A number that is not finite, other than an unlimited limit or an unproved end; an
/// action on a module, a port or a joint that there is not.
pub fn write_linkage_plan(plan: &LinkagePlanDocument) -> Result<String, Unwritable> {
    text(&plan::linkage_wire(plan)?)
}

/// Writes a `check/1` report on an assessed structure.
///
/// `utilisation`, `margin` and `required_strength_n` are `null` when the verdict is
/// whole-body unstable; `connections` and `contacts` are then empty. An end of a bracket where nothing was
/// proved is `null`.
///
/// # Errors
/// A wrench or a force that is not finite.
pub fn write_check(structure: &NamedStructure, report: &CheckReport<'_>) -> Result<String, Unwritable> {
    text(&check::wire(structure, report))
}

/// Writes a `load-range/1` report on a force on a body of a structure.
///
/// # Errors
/// A direction or a point that is not finite.
pub fn write_load_range(structure: &NamedStructure, report: &LoadRangeReport<'_>) -> Result<String, Unwritable> {
    text(&load_range::wire(structure, report))
}

/// Writes a `certificate/1` file that reads back equal, bit for bit, with its checksum.
///
/// # Errors
/// A number that is not finite.
pub fn write_certificate(document: &CertificateDocument) -> Result<String, Unwritable> {
    text(&certificate::wire(document)?)
}

impl Diagnostics {
    /// The problems as an `errors/1` document, for programs.
    pub fn to_json(&self) -> String {
        // Strings and counts only: nothing that JSON could not say.
        text(&errors::wire(self)).unwrap_or_default()
    }
}

fn line(wire: &impl Serialize) -> Result<String, Unwritable> {
    Ok(serde_json::to_string(wire).map_err(Unwritable::new)? + "\n")
}

fn text(wire: &impl Serialize) -> Result<String, Unwritable> {
    let value = serde_json::to_value(wire).map_err(Unwritable::new)?;
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
