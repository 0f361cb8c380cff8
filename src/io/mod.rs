//! Files in, files out: wire types, diagnostics with line and column, schemas.
//!
//! The only module that names `serde`. Every function is pure: text in, value
//! or diagnostics out; files that a text refers to are fetched by a closure of
//! the caller. Knows no search and runs no oracle.
//!
//! A text passes through four stages, each of which reports all it finds: the
//! grammar of JSON (`json`), the form of the format (`conform`, by the schema
//! that is made from the types in `wire`), names and values on their own
//! (`read`), and what the core types find unsound (`read::faults`).

mod assembled;
mod certificate_document;
mod check_report;
mod codes;
mod conform;
mod diagnostics;
mod document;
mod excerpt;
mod findings;
mod form;
mod json;
mod layout;
mod load_range_report;
mod partial_order_report;
mod plan_document;
mod read;
mod rofi;
mod schema;
mod suggest;
mod tables;
mod turn;
mod wire;
mod write;

pub use certificate_document::CertificateDocument;
pub use check_report::CheckReport;
pub use codes::{CODES, Code};
pub use diagnostics::{Diagnostic, Diagnostics};
pub use document::{
    Checkable, LARGEST_FILE, LatticeProblem, LinkageProblem, NamedStructure, Problem, Resolve, SourceFile, Verifiable,
    no_references,
};
pub use form::Form;
pub use load_range_report::LoadRangeReport;
pub use partial_order_report::PartialOrderReport;
pub use plan_document::{Contradiction, LinkagePlanDocument, PlanDocument};
pub use read::{
    Message, Results, read_catalogue, read_certificate, read_checkable, read_configuration, read_linkage,
    read_linkage_plan, read_message, read_plan, read_problem, read_results, read_structure, read_suite,
    read_verifiable,
};
pub use schema::{schema, schema_names};
pub use turn::AxisAngle;
pub use write::{
    Unwritable, in_space_because, write_catalogue, write_certificate, write_check, write_configuration, write_goal,
    write_linkage, write_linkage_goal, write_linkage_partial_order, write_linkage_plan, write_load_range,
    write_partial_order, write_plan, write_point, write_result, write_rofi, write_structure,
};
