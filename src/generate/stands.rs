//! Whether a robot stands with a margin.

use crate::reconfigure::assembly;
use crate::reconfigure::linkage;
use crate::robot::Configuration;
use crate::robot::linkage::Linkage;
use crate::statics::{Question, Structure, assess};

/// Whether cubes provably stand with at least this margin.
pub fn cubes(configuration: &Configuration, margin: f64) -> bool {
    stands(&assembly::assemble(configuration).structure, margin)
}

/// Whether a linkage provably stands with at least this margin.
pub fn modules(linkage: &Linkage, margin: f64) -> bool {
    stands(&linkage::assembly::assemble(linkage).structure, margin)
}

fn stands(structure: &Structure, margin: f64) -> bool {
    let question = Question::Decide(1.0 - margin);
    assess(structure, question).is_ok_and(|assessment| assessment.margin().lower >= margin)
}
