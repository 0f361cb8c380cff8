//! What is in the way of a plan, as `plan/1` says it.

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::outcome::limit;
use super::sequence::{Family, Held, Parts, bracket, sequence};
use crate::reconfigure::{InTheWay, Nearest, Which};
use crate::statics::Bracket;

fn nearest(wire: wire::Nearest) -> Nearest {
    Nearest { modules: wire.modules as usize, in_place: wire.in_place as usize, stuck: wire.stuck as usize }
}

/// What a file says; `ids` are those of the start's modules.
pub(super) fn in_the_way<F: Family>(
    wire: &wire::InTheWay,
    family: &mut F,
    ids: &[&str],
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<InTheWay<F::Action, F::Connection>> {
    let before = findings.count();
    let plan = wire.plan.as_ref().map(|plan| {
        let place = place.key("plan");
        sequence(family, 0, Parts::of(plan), &place, findings)
    });
    let mut too_weak = Vec::with_capacity(wire.too_weak.len());
    for (index, weak) in wire.too_weak.iter().enumerate() {
        let place = place.key("too_weak").index(index);
        let held = Held::of(weak.connection.as_ref(), weak.joint.as_ref(), &place, findings);
        let held = held.and_then(|held| family.connection(Which::Start, held, &place, findings));
        too_weak.extend(held.map(|held| (held, bracket(weak.margin))));
    }
    let mut never_move = Vec::new();
    for (index, id) in wire.never_move.iter().flatten().enumerate() {
        match ids.iter().position(|known| known == id) {
            Some(module) => never_move.push(module),
            None => {
                let message = format!("there is no module `{id}`");
                let hint = "name a module of the start".to_string();
                findings.add(&place.key("never_move").index(index), codes::PLAN, message, hint);
            }
        }
    }
    if findings.count() > before {
        return None;
    }
    // A factor that is not there is without bound.
    let end = |end: wire::Bound| end.0.unwrap_or(f64::INFINITY);
    let factor = wire.strength_factor;
    Some(InTheWay {
        margin: if wire.no_requirement_helps { Bracket::exact(f64::NEG_INFINITY) } else { bracket(wire.margin) },
        strength_factor: Bracket::new(end(factor.lower), end(factor.upper)),
        plan: plan.flatten(),
        too_weak,
        never_move: wire.never_move.is_some().then_some(never_move),
        nearest: wire.nearest.map(nearest),
        cut_by: wire.cut_by.map(limit),
    })
}
