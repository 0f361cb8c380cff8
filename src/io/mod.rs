//! Files in, files out: wire types, diagnostics with line and column, schemas.
//!
//! The only module that names `serde`. Every function is pure: text in, value
//! or diagnostics out; files that a text refers to are fetched by a closure of
//! the caller. Knows no search and runs no oracle.

mod diagnostics;
mod document;

pub use diagnostics::{Code, Diagnostic, Diagnostics};
pub use document::{
    Checkable, NamedStructure, PlanBottleneck, PlanDocument, PlanObjective, PlanOutcome, PlanProof, PlanSequence,
    PlanStatistics, PlannedAction, PlannedStep, Problem, Resolve, SourceFile, no_references,
};

use crate::robot::{Catalogue, Configuration};
use crate::statics::Assessment;

/// Reads a `structure/1` file.
///
/// # Errors
/// All problems of the file at once.
pub fn read_structure(file: &SourceFile) -> Result<NamedStructure, Diagnostics> {
    let _ = file;
    todo!()
}

/// Reads a `catalogue/1` file.
///
/// # Errors
/// All problems of the file at once.
pub fn read_catalogue(file: &SourceFile) -> Result<Catalogue, Diagnostics> {
    let _ = file;
    todo!()
}

/// Reads a `configuration/1` file on its own (as a start).
///
/// # Errors
/// All problems of the file, or of the catalogue that it refers to, at once.
pub fn read_configuration(file: &SourceFile, resolve: Resolve<'_>) -> Result<Configuration, Diagnostics> {
    let _ = (file, resolve);
    todo!()
}

/// Reads a start and a goal, and checks them against each other.
///
/// # Errors
/// All problems of both files at once.
pub fn read_problem(start: &SourceFile, goal: &SourceFile, resolve: Resolve<'_>) -> Result<Problem, Diagnostics> {
    let _ = (start, goal, resolve);
    todo!()
}

/// Reads a structure or a configuration, by what its `format` says.
///
/// # Errors
/// All problems of the file at once.
pub fn read_checkable(file: &SourceFile, resolve: Resolve<'_>) -> Result<Checkable, Diagnostics> {
    let _ = (file, resolve);
    todo!()
}

/// Reads a `plan/1` file: form and names only; whether the plan holds is for a replay to say.
///
/// # Errors
/// All problems of the file at once.
pub fn read_plan(file: &SourceFile) -> Result<PlanDocument, Diagnostics> {
    let _ = file;
    todo!()
}

/// Writes a `structure/1` file that reads back equal, bit for bit.
pub fn write_structure(structure: &NamedStructure) -> String {
    let _ = structure;
    todo!()
}

/// Writes a `configuration/1` file that reads back equal, bit for bit.
pub fn write_configuration(configuration: &Configuration) -> String {
    let _ = configuration;
    todo!()
}

/// Writes a `plan/1` file that stands on its own.
pub fn write_plan(plan: &PlanDocument) -> String {
    let _ = plan;
    todo!()
}

/// Writes a `check/1` report on an assessed structure. Infinite numbers, which
/// JSON cannot say, appear only where the verdict is whole-body-unstable, and
/// there `utilisation`, `margin` and `required_strength_n` are null.
pub fn write_check(structure: &NamedStructure, assessment: &Assessment, seconds: f64) -> String {
    let _ = (structure, assessment, seconds);
    todo!()
}

/// Names of the formats that have a JSON Schema, e.g. `structure`.
pub fn schema_names() -> &'static [&'static str] {
    &["structure", "catalogue", "configuration", "plan", "check"]
}

/// The JSON Schema of a format, pretty-printed; `None` for an unknown name.
pub fn schema(name: &str) -> Option<String> {
    let _ = name;
    todo!()
}
