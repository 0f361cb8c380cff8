//! Why a search found no plan, to `plan/1`.

use super::super::wire::{self, Real};
use super::sequence::Family;
use super::{Unwritable, bracket};
use crate::reconfigure::{Impossible, Limit, Which};

/// The reason.
pub(super) fn impossible<F: Family>(
    reason: &Impossible<F::Connection>,
    family: &F,
) -> Result<wire::Impossible, Unwritable> {
    Ok(match reason {
        Impossible::ModulesDiffer { module_type, start, goal } => wire::Impossible::ModulesDiffer {
            module_type: module_type.clone(),
            start: *start as u64,
            goal: *goal as u64,
        },
        Impossible::FixedModule { module } => wire::Impossible::FixedModule { module: module.clone() },
        Impossible::Disconnected(end) => wire::Impossible::Disconnected { which: which(*end) },
        Impossible::Unstable { which: end, margin, required, connection } => {
            let held = connection.map(|held| family.held(*end, held)).transpose()?;
            let (connection, joint) = held.unwrap_or_default();
            wire::Impossible::Unstable {
                which: which(*end),
                margin: (margin.upper != f64::NEG_INFINITY).then(|| bracket(*margin)),
                required_margin: Real(*required),
                connection,
                joint,
            }
        }
        Impossible::Sealed { level, which: end } => wire::Impossible::Sealed { level: *level, which: which(*end) },
        Impossible::Exhausted { required } => {
            wire::Impossible::Exhausted { required_margin: (*required != f64::NEG_INFINITY).then_some(Real(*required)) }
        }
    })
}

/// What ended the search.
pub(super) fn limit(limit: Limit) -> wire::StoppedBy {
    match limit {
        Limit::Deadline => wire::StoppedBy::Deadline,
        Limit::Expansions => wire::StoppedBy::Expansions,
        Limit::Memory => wire::StoppedBy::Memory,
        Limit::Cancelled => wire::StoppedBy::Cancelled,
        Limit::Precision => wire::StoppedBy::Precision,
        Limit::Incomplete => wire::StoppedBy::Incomplete,
    }
}

fn which(which: Which) -> wire::Which {
    match which {
        Which::Start => wire::Which::Start,
        Which::Goal => wire::Which::Goal,
    }
}
