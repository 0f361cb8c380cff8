//! What makes a start or a goal unfit for planning.

use crate::reconfigure::refusal::{Refusal, Which};
use crate::robot::Fault;
use crate::robot::linkage::{Goal, Linkage};

/// Refuses data that no robot can have and pairs that cannot be compared. Disconnected robots are no bad input
/// here.
pub(super) fn check(start: &Linkage, goal: &Goal) -> Result<(), Refusal> {
    for (which, linkage) in [(Which::Start, start), (Which::Goal, &goal.linkage)] {
        let mut problems = linkage.catalogue.problems();
        if problems.is_empty() {
            problems = linkage.problems();
            problems.retain(|problem| problem.fault != Fault::Disconnected);
        }
        if !problems.is_empty() {
            return Err(Refusal::Unsound { which, problems });
        }
    }
    if start.catalogue != goal.linkage.catalogue {
        return Err(Refusal::CataloguesDiffer);
    }
    Ok(())
}
