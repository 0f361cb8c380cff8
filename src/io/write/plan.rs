//! A plan with its problem to `plan/1`.

use super::super::document::{
    PlanBottleneck, PlanDocument, PlanObjective, PlanOutcome, PlanSequence, PlannedAction, PlannedStep,
};
use super::super::wire::{self, NonNegative, Real};
use super::{bracket, configuration};
use crate::robot::{Configuration, Face, Port};

pub(super) fn wire(plan: &PlanDocument) -> wire::Plan {
    let start = &plan.problem.start;
    let first = plan.plans.first();
    let alternatives = plan.plans.iter().skip(1).map(|sequence| wire::Alternative {
        margin: sequence.margin.map(bracket),
        moves: count(sequence.moves),
        bottleneck: sequence.bottleneck.as_ref().map(|b| bottleneck(start, b)),
        actions: actions(start, sequence),
    });
    wire::Plan {
        format: wire::PlanFormat::V1,
        outcome: match plan.outcome {
            PlanOutcome::Solved => wire::Outcome::Solved,
            PlanOutcome::Impossible => wire::Outcome::Impossible,
            PlanOutcome::OutOfBudget => wire::Outcome::OutOfBudget,
        },
        objective: match plan.objective {
            PlanObjective::Margin => wire::Objective::Margin,
            PlanObjective::Moves => wire::Objective::Moves,
        },
        margin: first.and_then(|sequence| sequence.margin).map(bracket),
        moves: first.map(|sequence| count(sequence.moves)),
        proof: wire::Proof {
            optimal: plan.proof.optimal,
            margin_at_most: plan.proof.margin_at_most.map(Real),
            moves_at_least: plan.proof.moves_at_least.map(count),
        },
        bottleneck: first.and_then(|sequence| sequence.bottleneck.as_ref()).map(|b| bottleneck(start, b)),
        actions: first.map(|sequence| actions(start, sequence)),
        alternatives: alternatives.collect(),
        start: configuration::start(start),
        goal: configuration::goal(&plan.problem.goal),
        statistics: wire::Statistics {
            expanded: plan.statistics.expanded,
            oracle_solves: plan.statistics.oracle_solves,
            decided_by_bounds: plan.statistics.decided_by_bounds,
            seconds: NonNegative(plan.statistics.seconds),
        },
    }
}

fn count(count: usize) -> u32 {
    u32::try_from(count).unwrap_or(u32::MAX)
}

fn ports(start: &Configuration, ports: [Port; 2]) -> [String; 2] {
    ports.map(|port| configuration::port(start, port))
}

fn bottleneck(start: &Configuration, bottleneck: &PlanBottleneck) -> wire::Bottleneck {
    wire::Bottleneck {
        action: bottleneck.action.map(count),
        phase: Real(bottleneck.phase),
        connection: bottleneck.connection.map(|connection| ports(start, connection)),
    }
}

fn actions(start: &Configuration, sequence: &PlanSequence) -> Vec<wire::Action> {
    sequence.actions.iter().map(|step| action(start, step)).collect()
}

fn action(start: &Configuration, step: &PlannedStep) -> wire::Action {
    let id = |module: usize| start.modules[module].id.clone();
    let margin = step.margin.map(bracket);
    match step.action {
        PlannedAction::Attach(pair) => wire::Action::Attach { ports: ports(start, pair), margin },
        PlannedAction::Detach(pair) => wire::Action::Detach { ports: ports(start, pair), margin },
        PlannedAction::Slide { module, to } => {
            wire::Action::Slide { module: id(module), to: wire::CellTarget { cell: to }, margin }
        }
        PlannedAction::Pivot { module, support, axis, quarter_turns, to } => wire::Action::Pivot {
            module: id(module),
            support: id(support),
            axis: axis_of(axis),
            angle_deg: 90 * u32::from(quarter_turns),
            to: wire::CellTarget { cell: to },
            margin,
        },
    }
}

fn axis_of(face: Face) -> wire::Axis {
    match face {
        Face::NegX => wire::Axis::NegX,
        Face::PosX => wire::Axis::PosX,
        Face::NegY => wire::Axis::NegY,
        Face::PosY => wire::Axis::PosY,
        Face::NegZ => wire::Axis::NegZ,
        Face::PosZ => wire::Axis::PosZ,
    }
}
