//! How a search ended, as `plan/1` says it.

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::sequence::{Family, Held, bracket};
use crate::reconfigure::{Impossible, Limit, Outcome, Which};
use crate::statics::Bracket;

/// The outcome of a file at `root`, which must have what belongs to it and nothing else.
pub(super) fn outcome<F: Family>(
    wire: &wire::Plan,
    family: &F,
    root: &Place<'_>,
    findings: &mut Findings,
) -> Option<Outcome<F::Connection>> {
    let before = findings.count();
    let mut wrong = |key: &str, message: &str, hint: &str| {
        findings.add(&root.key(key), codes::PLAN, message, hint.to_string());
    };
    if wire.outcome == wire::Outcome::Solved && wire.actions.is_none() {
        let message = "a solved problem has a plan, but `actions` is missing";
        wrong("outcome", message, "an empty list is the plan that does nothing");
    }
    if wire.outcome == wire::Outcome::Impossible {
        if wire.actions.is_some() {
            let message = "an impossible problem has no plan, but there are `actions`";
            wrong("outcome", message, "leave the actions out");
        }
        if wire.impossible.is_none() {
            wrong("outcome", "it is not said why it is impossible", "the reason stands in `impossible`");
        }
    } else {
        let hint = "leave it out, or say \"outcome\": \"impossible\"";
        if wire.impossible.is_some() {
            wrong("impossible", "a reason, but the outcome is not \"impossible\"", hint);
        }
        if wire.impossible_because.is_some() {
            wrong("impossible_because", "a reason, but the outcome is not \"impossible\"", hint);
        }
    }
    if wire.outcome == wire::Outcome::OutOfBudget {
        if wire.stopped_by.is_none() {
            wrong("outcome", "it is not said what was used up", "the limit stands in `stopped_by`");
        }
    } else if wire.stopped_by.is_some() {
        let hint = "leave it out, or say \"outcome\": \"out-of-budget\"";
        wrong("stopped_by", "a limit, but the outcome is not \"out-of-budget\"", hint);
    }
    if findings.count() > before {
        return None;
    }
    Some(match wire.outcome {
        wire::Outcome::Solved => Outcome::Solved,
        wire::Outcome::Impossible => {
            Outcome::Impossible(impossible(wire.impossible.as_ref()?, family, &root.key("impossible"), findings)?)
        }
        wire::Outcome::OutOfBudget => Outcome::OutOfBudget(limit(wire.stopped_by?)),
    })
}

fn impossible<F: Family>(
    wire: &wire::Impossible,
    family: &F,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<Impossible<F::Connection>> {
    Some(match wire {
        wire::Impossible::ModulesDiffer { module_type, start, goal } => Impossible::ModulesDiffer {
            module_type: module_type.clone(),
            start: usize::try_from(*start).unwrap_or(usize::MAX),
            goal: usize::try_from(*goal).unwrap_or(usize::MAX),
        },
        wire::Impossible::FixedModule { module } => Impossible::FixedModule { module: module.clone() },
        wire::Impossible::Disconnected { which: end } => Impossible::Disconnected(which(*end)),
        wire::Impossible::Unstable { which: end, margin, required_margin, connection, joint } => {
            let before = findings.count();
            let held = Held::of(connection.as_ref(), joint.as_ref(), place, findings);
            let connection = held.and_then(|held| family.connection(which(*end), held, place, findings));
            if findings.count() > before {
                return None;
            }
            Impossible::Unstable {
                which: which(*end),
                margin: margin.map_or(Bracket::exact(f64::NEG_INFINITY), bracket),
                required: required_margin.0,
                connection,
            }
        }
        wire::Impossible::Sealed { level, which: end } => Impossible::Sealed { level: *level, which: which(*end) },
        wire::Impossible::Exhausted { required_margin } => {
            Impossible::Exhausted { required: required_margin.map_or(f64::NEG_INFINITY, |margin| margin.0) }
        }
    })
}

fn which(wire: wire::Which) -> Which {
    match wire {
        wire::Which::Start => Which::Start,
        wire::Which::Goal => Which::Goal,
    }
}

pub(super) fn limit(wire: wire::StoppedBy) -> Limit {
    match wire {
        wire::StoppedBy::Deadline => Limit::Deadline,
        wire::StoppedBy::Expansions => Limit::Expansions,
        wire::StoppedBy::Memory => Limit::Memory,
        wire::StoppedBy::Cancelled => Limit::Cancelled,
        wire::StoppedBy::Precision => Limit::Precision,
        wire::StoppedBy::Incomplete => Limit::Incomplete,
    }
}
