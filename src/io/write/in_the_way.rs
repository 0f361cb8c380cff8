//! What is in the way of a plan, to `plan/1`.

use super::super::wire;
use super::outcome::limit;
use super::sequence::{Family, sequence};
use super::{Unwritable, bracket};
use crate::reconfigure::{InTheWay, Nearest, Which};
use crate::statics::Bracket;

fn nearest(found: Nearest) -> wire::Nearest {
    let count = |modules| u32::try_from(modules).unwrap_or(u32::MAX);
    wire::Nearest { modules: count(found.modules), in_place: count(found.in_place), stuck: count(found.stuck) }
}

/// What was found; `ids` are those of the start's modules.
pub(super) fn in_the_way<F: Family>(
    found: &InTheWay<F::Action, F::Connection>,
    family: &mut F,
    ids: &[String],
) -> Result<wire::InTheWay, Unwritable> {
    let too_weak = found.too_weak.iter().map(|&(held, margin)| {
        let (connection, joint) = family.held(Which::Start, held)?;
        Ok(wire::TooWeak { connection, joint, margin: bracket(margin) })
    });
    let too_weak = too_weak.collect::<Result<_, Unwritable>>()?;
    let id = |&module: &usize| {
        ids.get(module).cloned().ok_or_else(|| Unwritable::new("a module beyond the start's that never moves"))
    };
    let never_move = found.never_move.as_ref().map(|modules| modules.iter().map(id).collect::<Result<_, _>>());
    Ok(wire::InTheWay {
        margin: bracket(found.margin),
        no_requirement_helps: found.margin == Bracket::exact(f64::NEG_INFINITY),
        strength_factor: bracket(found.strength_factor),
        plan: found.plan.as_ref().map(|plan| sequence(family, 0, plan)).transpose()?,
        too_weak,
        never_move: never_move.transpose()?,
        nearest: found.nearest.map(nearest),
        cut_by: found.cut_by.map(limit),
    })
}
