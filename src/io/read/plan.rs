//! `plan/1` to what the planner reported, with its problem.

use super::super::codes;
use super::super::document::{Problem, Verifiable, no_references};
use super::super::findings::{Findings, Place};
use super::super::plan_document::PlanDocument;
use super::super::wire;
use super::decode::decode;
use super::goal::read_problem;
use super::in_the_way::in_the_way;
use super::lattice_plan::LatticePlans;
use super::linkage_plan::LinkagePlans;
use super::outcome::{limit, outcome};
use super::sequence::{Family, Parts, sequence};
use crate::reconfigure::{Objective, Outcome, Proof, Report, Statistics};
use crate::statics::{Rung, Tally};

/// Reads a plan for whatever robot it is.
pub(super) fn read(root: &Place<'_>, findings: &mut Findings) -> Option<Verifiable> {
    let wire: wire::Plan = decode("plan", root, findings)?;
    match read_problem(&root.key("start"), &root.key("goal"), &no_references, findings)? {
        Problem::Lattice(problem) => {
            let mut family = LatticePlans::new(&problem, root, findings);
            let report = report(&wire, &mut family, root, findings);
            let contradictions = family.contradictions;
            Some(Verifiable::Plan(Box::new(PlanDocument { report: report?, problem, contradictions })))
        }
        Problem::Linkage(problem) => {
            let report = report(&wire, &mut LinkagePlans::new(&problem, root, findings), root, findings);
            let document = PlanDocument { report: report?, problem, contradictions: Vec::new() };
            Some(Verifiable::LinkagePlan(Box::new(document)))
        }
    }
}

/// What the search answered.
fn report<F: Family>(
    wire: &wire::Plan,
    family: &mut F,
    root: &Place<'_>,
    findings: &mut Findings,
) -> Option<Report<F::Action, F::Connection>> {
    let best = wire.actions.as_ref().map(|actions| {
        let parts = Parts {
            margin: wire.margin,
            moves: wire.moves,
            bottleneck: wire.bottleneck.as_ref(),
            actions,
            profile: &wire.profile,
            if_stronger: wire.if_stronger,
        };
        sequence(family, 0, parts, root, findings)
    });
    let mut alternatives = Vec::with_capacity(wire.alternatives.len());
    for (index, other) in wire.alternatives.iter().enumerate() {
        let place = root.key("alternatives").index(index);
        alternatives.push(sequence(family, index + 1, Parts::of(other), &place, findings));
    }
    if wire.actions.is_none() && !wire.alternatives.is_empty() {
        let message = "there are alternatives to a plan, but no `actions`";
        let hint = "the best plan stands in `actions`, the further ones in `alternatives`";
        findings.add(&root.key("alternatives"), codes::PLAN, message, hint.to_string());
    }
    let ids: Vec<&str> = wire.start.modules.iter().map(|module| module.id.as_str()).collect();
    let place = root.key("in_the_way");
    let way = wire.in_the_way.as_ref().map(|wire| in_the_way(wire, family, &ids, &place, findings));
    let outcome = outcome(wire, family, root, findings);
    let statistics = statistics(&wire.statistics, &root.key("statistics"), findings);
    let plan = match best {
        Some(plan) => Some(plan?),
        None => None,
    };
    let outcome = outcome?;
    Some(Report {
        proof: proof(&wire.proof, &outcome),
        outcome,
        objective: match wire.objective {
            wire::Objective::Margin => Objective::Margin,
            wire::Objective::Moves => Objective::Moves,
            wire::Objective::Pareto => Objective::Pareto,
        },
        required: wire.required_margin.map(|margin| margin.0),
        plan,
        alternatives: alternatives.into_iter().collect::<Option<_>>()?,
        alternatives_cut_by: wire.alternatives_cut_by.map(limit),
        in_the_way: match way {
            Some(way) => Some(way?),
            None => None,
        },
        statistics,
    })
}

/// A bound that was not proved says nothing; without any plan, everything holds of all plans.
fn proof<C>(wire: &wire::Proof, outcome: &Outcome<C>) -> Proof {
    let nothing = match outcome {
        Outcome::Impossible(_) => (f64::NEG_INFINITY, u32::MAX),
        Outcome::Solved | Outcome::OutOfBudget(_) => (f64::INFINITY, 0),
    };
    Proof {
        optimal: wire.optimal,
        margin_at_most: wire.margin_at_most.map_or(nothing.0, |margin| margin.0),
        moves_at_least: wire.moves_at_least.unwrap_or(nothing.1),
    }
}

fn tally(wire: wire::Answers) -> Tally {
    let mut tally = Tally::default();
    tally.add(Rung::ClosedForm, wire.closed_form);
    tally.add(Rung::CarriedOver, wire.carried_over);
    tally.add(Rung::StoppedEarly, wire.stopped_early);
    tally.add(Rung::Solved, wire.solved);
    tally.add(Rung::SolvedGenerally, wire.solved_generally);
    tally
}

pub(super) fn statistics(wire: &wire::Statistics, place: &Place<'_>, findings: &mut Findings) -> Statistics {
    let certified = wire.certified.unwrap_or_default();
    let statistics = Statistics {
        expanded: wire.expanded,
        states: wire.states.unwrap_or_default(),
        generated: wire.generated.unwrap_or_else(|| certified.saturating_add(wire.decided_by_bounds)),
        certified,
        oracle_solves: wire.oracle_solves,
        decided_by: wire.answers.map(tally).unwrap_or_default(),
        oracle_seconds: 0.0,
        bytes: wire.memory_bytes.unwrap_or_default(),
        seconds: wire.seconds.0,
    };
    let decided = statistics.decided_by_bounds();
    if wire.decided_by_bounds != decided {
        let message = format!("says {}, but the counts make it {decided}", wire.decided_by_bounds);
        let hint = "it is `generated` less `certified`".to_string();
        findings.add(&place.key("decided_by_bounds"), codes::PLAN, message, hint);
    }
    statistics
}
