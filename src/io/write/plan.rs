//! A plan with its problem to `plan/1`.

use super::super::plan_document::{LinkagePlanDocument, PlanDocument};
use super::super::wire::{self, NonNegative, Real};
use super::in_the_way::in_the_way;
use super::lattice_plan::LatticePlans;
use super::linkage_plan::LinkagePlans;
use super::sequence::{Family, sequence};
use super::{Unwritable, configuration, linkage, outcome};
use crate::reconfigure::{Objective, Outcome, Proof, Report, Statistics};
use crate::statics::{Rung, Tally};

/// A plan for lattice modules.
pub(super) fn wire(document: &PlanDocument) -> Result<wire::Plan, Unwritable> {
    let problem = &document.problem;
    let ends = [configuration::start(&problem.start), configuration::goal(&problem.goal)];
    written(&document.report, &mut LatticePlans::new(document), ends)
}

/// A plan for a linkage.
pub(super) fn linkage_wire(document: &LinkagePlanDocument) -> Result<wire::Plan, Unwritable> {
    let problem = &document.problem;
    let ends = [linkage::start(&problem.start), linkage::goal(&problem.goal)];
    written(&document.report, &mut LinkagePlans { problem }, ends)
}

fn written<F: Family>(
    report: &Report<F::Action, F::Connection>,
    family: &mut F,
    [start, goal]: [wire::Configuration; 2],
) -> Result<wire::Plan, Unwritable> {
    let best = report.plan.as_ref().map(|plan| sequence(family, 0, plan)).transpose()?;
    let (margin, moves, bottleneck, actions, profile, if_stronger) = match best {
        Some(best) => {
            (best.margin, Some(best.moves), best.bottleneck, Some(best.actions), best.profile, best.if_stronger)
        }
        None => (None, None, None, None, Vec::new(), None),
    };
    let ids: Vec<String> = start.modules.iter().map(|module| module.id.clone()).collect();
    let in_the_way = report.in_the_way.as_ref().map(|found| in_the_way(found, family, &ids)).transpose()?;
    let offset = usize::from(report.plan.is_some());
    let alternatives = report.alternatives.iter().enumerate();
    let alternatives = alternatives.map(|(index, plan)| sequence(family, offset + index, plan));
    let alternatives = alternatives.collect::<Result<_, _>>()?;
    let (impossible, stopped_by) = match &report.outcome {
        Outcome::Solved => (None, None),
        Outcome::Impossible(reason) => (Some(reason), None),
        Outcome::OutOfBudget(limit) => (None, Some(outcome::limit(*limit))),
    };
    Ok(wire::Plan {
        format: wire::PlanFormat::V1,
        outcome: match report.outcome {
            Outcome::Solved => wire::Outcome::Solved,
            Outcome::Impossible(_) => wire::Outcome::Impossible,
            Outcome::OutOfBudget(_) => wire::Outcome::OutOfBudget,
        },
        impossible_because: impossible.map(ToString::to_string),
        impossible: impossible.map(|reason| outcome::impossible(reason, family)).transpose()?,
        stopped_by,
        alternatives_cut_by: report.alternatives_cut_by.map(outcome::limit),
        objective: match report.objective {
            Objective::Margin => wire::Objective::Margin,
            Objective::Moves => wire::Objective::Moves,
            Objective::Pareto => wire::Objective::Pareto,
        },
        required_margin: report.required.map(Real),
        margin,
        moves,
        proof: proof(&report.proof),
        bottleneck,
        actions,
        profile,
        if_stronger,
        in_the_way,
        alternatives,
        start,
        goal,
        statistics: statistics(&report.statistics),
    })
}

/// Bounds that say nothing, or that hold because there is no plan at all, are `null`.
fn proof(proof: &Proof) -> wire::Proof {
    wire::Proof {
        optimal: proof.optimal,
        margin_at_most: (!proof.margin_at_most.is_infinite()).then_some(Real(proof.margin_at_most)),
        moves_at_least: (proof.moves_at_least < u32::MAX).then_some(proof.moves_at_least),
    }
}

fn answers(tally: &Tally) -> wire::Answers {
    wire::Answers {
        closed_form: tally.of(Rung::ClosedForm),
        carried_over: tally.of(Rung::CarriedOver),
        stopped_early: tally.of(Rung::StoppedEarly),
        solved: tally.of(Rung::Solved),
        solved_generally: tally.of(Rung::SolvedGenerally),
    }
}

pub(super) fn statistics(statistics: &Statistics) -> wire::Statistics {
    wire::Statistics {
        expanded: statistics.expanded,
        states: Some(statistics.states),
        generated: Some(statistics.generated),
        certified: Some(statistics.certified),
        oracle_solves: statistics.oracle_solves,
        decided_by_bounds: statistics.decided_by_bounds(),
        answers: (statistics.decided_by.total() > 0).then(|| answers(&statistics.decided_by)),
        memory_bytes: Some(statistics.bytes),
        seconds: NonNegative(statistics.seconds),
    }
}
