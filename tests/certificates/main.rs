//! Certificates: what is issued verifies and holds the truth, and nothing else
//! verifies.

#[path = "../support/families/mod.rs"]
#[allow(dead_code, unused_imports, reason = "other tests use the other families")]
mod families;
#[path = "../support/stiff.rs"]
#[allow(dead_code, reason = "their widths are the oracle's concern")]
mod members;
#[path = "../support/random.rs"]
mod random;

mod files;
mod intervals;
mod issued;
mod tampered;
mod tampers;

use steadfast::certificate::{Certificate, Uncertified, issue};
use steadfast::io::{NamedStructure, SourceFile, read_structure};
use steadfast::statics::{Question, Structure, assess};

/// A certificate of the oracle's answer.
fn certify(structure: &Structure) -> Result<Certificate, Uncertified> {
    let answer = assess(structure, Question::VALUE).expect("the structure is valid");
    issue(structure, &answer)
}

/// A structure of the library.
fn library(name: &str) -> NamedStructure {
    let path = problems::root().join("structures").join(format!("{name}.json"));
    read_structure(&SourceFile::new(name, std::fs::read(path).unwrap())).unwrap()
}

/// A structure with names of no meaning.
fn named(structure: &Structure) -> NamedStructure {
    let names = |what: &str, count: usize| (0..count).map(|i| format!("{what}{i}")).collect();
    NamedStructure {
        structure: structure.clone(),
        bodies: names("b", structure.bodies.len()),
        connections: names("c", structure.connections.len()),
        contacts: names("k", structure.contacts.len()),
    }
}
