//! From texts to core types, with everything that is wrong on the way.
//!
//! Each reader takes the wire types' values and the places they came from. What
//! a file means is decided here; how it is written, in [`super::wire`].

mod angle;
mod catalogue;
mod certificate;
mod configuration;
mod connections;
mod connector;
mod decode;
mod environment;
mod faults;
mod goal;
mod in_the_way;
mod lattice;
mod lattice_plan;
mod lattice_type;
mod linkage;
mod linkage_plan;
mod matching;
mod module_type;
mod motion;
mod names;
mod outcome;
mod plan;
mod results;
mod robots;
mod rofi;
mod rotation;
mod sequence;
mod stl_and_obj;
mod structure;
mod suite;
mod terrain;

pub use results::{Message, Results};
pub(super) use rotation::port_rotation;

use super::certificate_document::CertificateDocument;
use super::codes;
use super::diagnostics::Diagnostics;
use super::document::{Checkable, NamedStructure, Problem, Resolve, SourceFile, Verifiable};
use super::findings::Findings;
use super::form::Form;
use super::plan_document::{LinkagePlanDocument, PlanDocument};
use crate::robot::linkage::Linkage;
use crate::robot::{Catalogue, Configuration};
use crate::suite::Suite;
use configuration::{Robot, read_start};

/// Reads a `structure/1` file.
///
/// # Errors
/// All problems of the file at once.
pub fn read_structure(file: &SourceFile) -> Result<NamedStructure, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open(file);
    let value = document.as_ref().and_then(|document| structure::read(&document.root(), &mut findings));
    findings.finish(value)
}

/// Reads a `catalogue/1` file.
///
/// # Errors
/// All problems of the file at once.
pub fn read_catalogue(file: &SourceFile) -> Result<Catalogue, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open(file);
    let value = document.as_ref().and_then(|document| catalogue::read(&document.root(), &mut findings));
    findings.finish(value)
}

/// Reads a `configuration/1` file on its own, as a start; its modules must be lattice modules.
///
/// # Errors
/// All problems of the file, and of the catalogue that it refers to, at once.
pub fn read_configuration(file: &SourceFile, resolve: Resolve<'_>) -> Result<Configuration, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open(file);
    let value =
        document.as_ref().and_then(|document| read_start(&document.root(), resolve, &mut findings, lattice::build));
    findings.finish(value)
}

/// Reads a `configuration/1` file on its own, as a start, with modules of any kind, or a file of the RoFI
/// platform. Lattice modules are taken as rigid modules with six ports.
///
/// # Errors
/// All problems of the file, and of the catalogue that it refers to, at once.
pub fn read_linkage(file: &SourceFile, resolve: Resolve<'_>) -> Result<Linkage, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open_robot(file);
    let value = document.as_ref().and_then(|document| match document.form {
        Form::Own | Form::Tables => read_start(&document.root(), resolve, &mut findings, linkage::build),
        _ => rofi::parse(document, &mut findings).and_then(|world| rofi::start(&world, None, &mut findings)),
    });
    findings.finish(value)
}

/// Reads a start and a goal, each a `configuration/1` file or one of the RoFI platform, and checks them
/// against each other.
///
/// # Errors
/// All problems of both files, and of the catalogues that they refer to, at once.
pub fn read_problem(start: &SourceFile, goal: &SourceFile, resolve: Resolve<'_>) -> Result<Problem, Diagnostics> {
    let mut findings = Findings::default();
    let (start, goal) = (findings.open_robot(start), findings.open_robot(goal));
    let value = goal::read_documents(start.as_ref(), goal.as_ref(), resolve, &mut findings);
    findings.finish(value)
}

/// Reads a structure or a configuration, by what its `format` says, or a file of the RoFI platform.
///
/// # Errors
/// All problems of the file, and of the catalogue that it refers to, at once.
pub fn read_checkable(file: &SourceFile, resolve: Resolve<'_>) -> Result<Checkable, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open_robot(file);
    let value = document.as_ref().and_then(|document| {
        if document.form != Form::Own {
            let world = rofi::parse(document, &mut findings)?;
            return rofi::start(&world, None, &mut findings).map(Checkable::Linkage);
        }
        let root = document.root();
        match decode::format_of(&root, &["structure", "configuration"], &mut findings)? {
            "structure" => structure::read(&root, &mut findings).map(Checkable::Structure),
            _ => match read_start(&root, resolve, &mut findings, |draft, findings| draft.build(findings))? {
                Robot::Lattice(configuration) => Some(Checkable::Configuration(configuration)),
                Robot::Linkage(linkage) => Some(Checkable::Linkage(linkage)),
            },
        }
    });
    findings.finish(value)
}

/// Reads a `plan/1` file for lattice modules. Checks its form and its names; whether the plan holds is
/// for a replay to say, and what the file says against itself is kept for the verdict.
///
/// # Errors
/// All problems of the file at once.
pub fn read_plan(file: &SourceFile) -> Result<PlanDocument, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open(file);
    let value = document.as_ref().and_then(|document| match plan::read(&document.root(), &mut findings)? {
        Verifiable::Plan(plan) => Some(*plan),
        Verifiable::LinkagePlan(_) | Verifiable::Certificate(_) => {
            let hint = "all modules of its start must sit in a lattice".to_string();
            findings.add(&document.root().key("start"), codes::UNSUPPORTED, "is no robot of a lattice", hint);
            None
        }
    });
    findings.finish(value)
}

/// Reads a `plan/1` file for a linkage, as [`read_plan`] does one for lattice modules.
///
/// # Errors
/// All problems of the file at once.
pub fn read_linkage_plan(file: &SourceFile) -> Result<LinkagePlanDocument, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open(file);
    let value = document.as_ref().and_then(|document| match plan::read(&document.root(), &mut findings)? {
        Verifiable::LinkagePlan(plan) => Some(*plan),
        Verifiable::Plan(_) | Verifiable::Certificate(_) => {
            let hint = "some module of its start must be outside lattices".to_string();
            findings.add(&document.root().key("start"), codes::UNSUPPORTED, "is a robot of a lattice", hint);
            None
        }
    });
    findings.finish(value)
}

/// Reads a `suite/1` file, which is written in TOML.
///
/// # Errors
/// All problems of the file at once.
pub fn read_suite(file: &SourceFile) -> Result<Suite, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open_tables(file);
    let value = document.as_ref().and_then(|document| suite::read(&document.root(), &mut findings));
    findings.finish(value)
}

/// Reads a file of results, a `result/1` document on each line. A last line without a line feed was being written
/// when the program was stopped: it is left out.
///
/// # Errors
/// All problems of the file at once.
pub fn read_results(file: &SourceFile) -> Result<Results, Diagnostics> {
    let mut findings = Findings::default();
    let documents = findings.open_lines(file);
    let value = documents.map(|documents| results::read(&documents, file, &mut findings));
    findings.finish(value)
}

/// Reads a line that a job writes while it runs; `None` where it is none.
pub fn read_message(line: &str) -> Option<Message> {
    results::message(line)
}

/// Reads a `certificate/1` file, whose checksum must be right. Whether the certificate
/// holds is for its checker to say.
///
/// # Errors
/// All problems of the file at once.
pub fn read_certificate(file: &SourceFile) -> Result<CertificateDocument, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open(file);
    let value = document.as_ref().and_then(|document| certificate::read(&document.root(), &mut findings));
    findings.finish(value)
}

/// Reads a plan or a certificate, by what its `format` says.
///
/// # Errors
/// All problems of the file at once.
pub fn read_verifiable(file: &SourceFile) -> Result<Verifiable, Diagnostics> {
    let mut findings = Findings::default();
    let document = findings.open(file);
    let value = document.as_ref().and_then(|document| {
        let root = document.root();
        match decode::format_of(&root, &["plan", "certificate"], &mut findings)? {
            "plan" => plan::read(&root, &mut findings),
            _ => certificate::read(&root, &mut findings).map(|found| Verifiable::Certificate(Box::new(found))),
        }
    });
    findings.finish(value)
}
