//! The stability oracle: structure in, verdict and bracket out.

mod assessment;
mod connector;
mod structure;

pub use assessment::{Assessment, Bracket, ConnectionState, LeftOut, Question, Verdict};
pub use connector::{Connector, Model};
pub use structure::{Anchor, Body, Connection, Contact, Load, Structure};

/// What is wrong with a structure that cannot be assessed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InvalidStructure {
    /// Where, e.g. `bodies[3].mass`.
    pub place: String,
    /// What is wrong there.
    pub problem: String,
}

/// Finds the utilisation of `structure` as a bracket, and all that follows from it.
///
/// # Errors
/// Non-finite or out-of-range data, or indices that point nowhere; all of them at once.
pub fn assess(structure: &Structure, question: Question) -> Result<Assessment, Vec<InvalidStructure>> {
    let _ = (structure, question);
    unimplemented!("being written")
}
