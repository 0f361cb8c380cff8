//! What files mean, once read: core types with the names that the file gave.

use super::certificate_document::CertificateDocument;
use super::plan_document::{LinkagePlanDocument, PlanDocument};
use crate::robot::linkage::{self, Linkage};
use crate::robot::{Configuration, Goal};
use crate::statics::Structure;

/// Largest file that is read, in bytes. A million modules fit.
pub const LARGEST_FILE: usize = 64 << 20;

/// A text and what to call it in messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Name as messages show it, usually the path as the user gave it.
    pub name: String,
    /// The bytes, which need not be valid UTF-8 nor valid JSON; or why the file
    /// cannot be read, which every reader reports as a problem of the file.
    pub bytes: Result<Vec<u8>, String>,
}

impl SourceFile {
    /// A text under a name.
    pub fn new(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), bytes: Ok(bytes.into()) }
    }

    /// A file that cannot be read, and why.
    pub fn unreadable(name: impl Into<String>, why: impl Into<String>) -> Self {
        Self { name: name.into(), bytes: Err(why.into()) }
    }
}

/// Fetches a file that another one refers to: the name of the referring
/// file, then the reference as written there. The error is shown to the user.
pub type Resolve<'a> = &'a dyn Fn(&str, &str) -> Result<SourceFile, String>;

/// Refuses every reference: for texts that must stand on their own.
///
/// # Errors
/// Always.
pub fn no_references(_from: &str, _reference: &str) -> Result<SourceFile, String> {
    Err("references to other files are not followed here".to_string())
}

/// A structure with the names of its parts, each list in the structure's order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedStructure {
    /// The oracle's input.
    pub structure: Structure,
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Names of the connections.
    pub connections: Vec<String>,
    /// Names of the contacts.
    pub contacts: Vec<String>,
}

/// A start and a goal of lattice modules that have been checked against each other: the same
/// catalogue, gravity, environment and loads, and modules that can match.
/// The goal's modules are in the start's order when the goal is labelled.
#[derive(Clone, Debug, PartialEq)]
pub struct LatticeProblem {
    /// Where the robot is.
    pub start: Configuration,
    /// Where it is to be.
    pub goal: Goal,
}

/// As [`LatticeProblem`], of modules some of which are outside lattices.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkageProblem {
    /// Where the robot is.
    pub start: Linkage,
    /// Where it is to be.
    pub goal: linkage::Goal,
}

/// What `plan` can plan for.
#[derive(Clone, Debug, PartialEq)]
pub enum Problem {
    /// All modules sit in a lattice.
    Lattice(LatticeProblem),
    /// Some modules do not.
    Linkage(LinkageProblem),
}

impl Problem {
    /// The problem, if all modules sit in a lattice.
    pub fn into_lattice(self) -> Option<LatticeProblem> {
        match self {
            Self::Lattice(problem) => Some(problem),
            Self::Linkage(_) => None,
        }
    }

    /// The problem, if some modules do not sit in a lattice.
    pub fn into_linkage(self) -> Option<LinkageProblem> {
        match self {
            Self::Lattice(_) => None,
            Self::Linkage(problem) => Some(problem),
        }
    }
}

/// What `plan check` can look at.
#[derive(Clone, Debug, PartialEq)]
pub enum Checkable {
    /// Bodies and connections without a robot.
    Structure(NamedStructure),
    /// A robot in a lattice, in its environment.
    Configuration(Configuration),
    /// A robot with modules outside lattices, in its environment.
    Linkage(Linkage),
}

/// What `plan verify` can look at.
#[derive(Clone, Debug, PartialEq)]
pub enum Verifiable {
    /// A plan for lattice modules with its problem.
    Plan(Box<PlanDocument>),
    /// A plan for a linkage with its problem.
    LinkagePlan(Box<LinkagePlanDocument>),
    /// A certificate with its structure.
    Certificate(Box<CertificateDocument>),
}
