//! A certificate file once read.

use super::document::NamedStructure;
use crate::certificate::{Certificate, Fault};

/// All that a certificate file says: a certificate and the names of its structure's parts.
#[derive(Clone, Debug, PartialEq)]
pub struct CertificateDocument {
    /// The claim and its proof.
    pub certificate: Certificate,
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Names of the connections.
    pub connections: Vec<String>,
    /// Names of the contacts.
    pub contacts: Vec<String>,
}

impl CertificateDocument {
    /// A certificate of the structure `named`.
    pub fn new(named: &NamedStructure, certificate: Certificate) -> Self {
        let NamedStructure { bodies, connections, contacts, .. } = named.clone();
        Self { certificate, bodies, connections, contacts }
    }

    /// The structure that it is about, with its names.
    pub fn named(&self) -> NamedStructure {
        NamedStructure {
            structure: self.certificate.structure.clone(),
            bodies: self.bodies.clone(),
            connections: self.connections.clone(),
            contacts: self.contacts.clone(),
        }
    }

    /// What is wrong, in a sentence with the file's own names.
    pub fn sentence(&self, fault: &Fault) -> String {
        let (what, names, index, problem) = match fault {
            Fault::Unsound(problem) | Fault::Claim(problem) => return problem.clone(),
            Fault::Body { body, problem } => ("body", &self.bodies, *body, problem),
            Fault::Connection { connection, problem } => ("connection", &self.connections, *connection, problem),
            Fault::Contact { contact, problem } => ("contact", &self.contacts, *contact, problem),
        };
        match names.get(index) {
            Some(name) => format!("{what} {name} {problem}"),
            None => fault.to_string(),
        }
    }
}
