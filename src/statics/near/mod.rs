//! States near one that was assessed before.

mod breathing;
mod carry;
mod memory;
mod project;
mod room;

pub use carry::STAGES;
pub use memory::{Memory, NotNear};

use super::assess::assess_with;
use super::assessment::{Assessment, Question};
use super::structure::Structure;
use super::validate::{InvalidStructure, validate};
use carry::Carried;

/// As [`assess`](super::assess), with what a neighbouring state can use.
///
/// # Errors
/// As for [`assess`](super::assess).
pub fn assess_keeping(
    structure: &Structure,
    question: Question,
) -> Result<(Assessment, Memory), Vec<InvalidStructure>> {
    validate(structure)?;
    let mut carried = Carried::nothing(structure, question);
    let answer = assess_with(structure, question, &mut carried);
    let memory = carried.into_memory(&answer);
    Ok((answer, memory))
}

/// As [`assess`](super::assess), for a structure that differs little from the one of `memory`.
///
/// # Errors
/// As for [`assess`](super::assess), or when `matching` does not fit.
pub fn assess_near(
    structure: &Structure,
    question: Question,
    memory: &Memory,
    matching: &[Option<usize>],
) -> Result<(Assessment, Memory), NotNear> {
    validate(structure).map_err(NotNear::Structure)?;
    let mut carried = Carried::new(structure, question, memory, matching)?;
    let answer = assess_with(structure, question, &mut carried);
    let memory = carried.into_memory(&answer);
    Ok((answer, memory))
}
