//! `plan/1` to a plan with its problem.

use super::super::codes;
use super::super::document::{
    PlanBottleneck, PlanDocument, PlanObjective, PlanOutcome, PlanProof, PlanSequence, PlanStatistics, PlannedAction,
    PlannedStep, no_references,
};
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::connections::ports_of;
use super::decode::decode;
use super::goal::read_problem;
use super::names::Names;
use crate::robot::{Face, Port};
use crate::statics::Bracket;

pub(super) fn read(root: &Place<'_>, findings: &mut Findings) -> Option<PlanDocument> {
    let wire: wire::Plan = decode("plan", root, findings)?;
    let problem = read_problem(Some(&root.key("start")), Some(&root.key("goal")), &no_references, findings)?;
    let ids = problem.start.modules.iter().map(|module| module.id.as_str()).collect();
    let modules = Names::new("modules", ids, |_| root.clone(), findings);

    let mut plans = Vec::new();
    if let Some(actions) = &wire.actions {
        let moves = wire.moves.unwrap_or_default();
        plans.push(sequence((wire.margin, moves, wire.bottleneck.as_ref(), actions), &modules, root, findings));
    }
    for (index, other) in wire.alternatives.iter().enumerate() {
        let place = root.key("alternatives").index(index);
        let parts = (other.margin, other.moves, other.bottleneck.as_ref(), other.actions.as_slice());
        plans.push(sequence(parts, &modules, &place, findings));
    }
    check_outcome(&wire, root, findings);
    let statistics = PlanStatistics {
        expanded: wire.statistics.expanded,
        oracle_solves: wire.statistics.oracle_solves,
        decided_by_bounds: wire.statistics.decided_by_bounds,
        seconds: wire.statistics.seconds.0,
    };
    let plans = plans.into_iter().collect::<Option<_>>()?;
    drop(modules);
    Some(PlanDocument {
        outcome: outcome(wire.outcome),
        objective: objective(wire.objective),
        proof: proof(&wire.proof),
        plans,
        problem,
        statistics,
    })
}

fn check_outcome(wire: &wire::Plan, root: &Place<'_>, findings: &mut Findings) {
    match (wire.outcome, wire.actions.is_some()) {
        (wire::Outcome::Solved, false) => {
            let message = "a solved problem has a plan, but `actions` is missing";
            findings.add(
                &root.key("outcome"),
                codes::PLAN,
                message,
                "an empty list is the plan that does nothing".to_string(),
            );
        }
        (wire::Outcome::Impossible, true) => {
            findings.add(
                &root.key("outcome"),
                codes::PLAN,
                "an impossible problem has no plan, but there are `actions`",
                "leave the actions out".to_string(),
            );
        }
        _ => {}
    }
}

type Parts<'w> = (Option<wire::Bracket>, u32, Option<&'w wire::Bottleneck>, &'w [wire::Action]);

fn sequence(
    (margin, moves, bottleneck, actions): Parts<'_>,
    modules: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<PlanSequence> {
    let actions_place = place.key("actions");
    let steps: Vec<_> =
        actions.iter().enumerate().map(|(i, wire)| step(wire, modules, &actions_place.index(i), findings)).collect();
    let bottleneck = bottleneck.map(|wire| {
        let place = place.key("bottleneck");
        if let Some(action) = wire.action.filter(|action| *action as usize >= actions.len()) {
            let message = format!("there is no action {action}, only {} of them, counted from 0", actions.len());
            findings.add(&place.key("action"), codes::PLAN, message, "null means the start itself".to_string());
        }
        let connection = wire.connection.as_ref().map(|ports| pair(ports, modules, &place.key("connection"), findings));
        let action = wire.action.map(|action| action as usize);
        PlanBottleneck { action, phase: wire.phase.0, connection: connection.flatten() }
    });
    let counted =
        actions.iter().filter(|a| matches!(a, wire::Action::Slide { .. } | wire::Action::Pivot { .. })).count();
    if moves as usize != counted {
        let message = format!("says {moves}, but {counted} of the actions are moves");
        findings.add(&place.key("moves"), codes::PLAN, message, "slides and pivots are moves".to_string());
    }
    let actions = steps.into_iter().collect::<Option<_>>()?;
    Some(PlanSequence { margin: margin.map(bracket), moves: moves as usize, bottleneck, actions })
}

fn step(wire: &wire::Action, modules: &Names<'_>, place: &Place<'_>, findings: &mut Findings) -> Option<PlannedStep> {
    let (action, margin) = match wire {
        wire::Action::Attach { ports, margin } => {
            (PlannedAction::Attach(pair(ports, modules, &place.key("ports"), findings)?), margin)
        }
        wire::Action::Detach { ports, margin } => {
            (PlannedAction::Detach(pair(ports, modules, &place.key("ports"), findings)?), margin)
        }
        wire::Action::Slide { module, to, margin } => {
            let module = modules.find(module, &place.key("module"), findings)?;
            (PlannedAction::Slide { module, to: to.cell }, margin)
        }
        wire::Action::Pivot { module, support, axis, angle_deg, to, margin } => {
            let module = modules.find(module, &place.key("module"), findings);
            let support = modules.find(support, &place.key("support"), findings);
            if module.is_some() && module == support {
                let message = "a module cannot support itself";
                findings.add(
                    &place.key("support"),
                    codes::SELF_CONNECTION,
                    message,
                    "name the neighbour that carries the hinge".to_string(),
                );
            }
            if !matches!(angle_deg, 90 | 180) {
                let message = format!("a cube pivots by 90 or 180 degrees, found {angle_deg}");
                findings.add(
                    &place.key("angle_deg"),
                    codes::OUT_OF_RANGE,
                    message,
                    "the direction is in `axis`".to_string(),
                );
            }
            let quarter_turns = if *angle_deg == 90 { 1 } else { 2 };
            let axis = face(*axis);
            (PlannedAction::Pivot { module: module?, support: support?, axis, quarter_turns, to: to.cell }, margin)
        }
    };
    Some(PlannedStep { action, margin: margin.map(bracket) })
}

fn pair(ports: &[String; 2], modules: &Names<'_>, place: &Place<'_>, findings: &mut Findings) -> Option<[Port; 2]> {
    let [a, b] = ports_of(ports, modules, place, findings);
    Some([a?, b?])
}

/// An end where nothing was proved is infinite.
fn bracket(wire: wire::Bracket) -> Bracket {
    Bracket::new(wire.lower.0.unwrap_or(f64::NEG_INFINITY), wire.upper.0.unwrap_or(f64::INFINITY))
}

fn outcome(wire: wire::Outcome) -> PlanOutcome {
    match wire {
        wire::Outcome::Solved => PlanOutcome::Solved,
        wire::Outcome::Impossible => PlanOutcome::Impossible,
        wire::Outcome::OutOfBudget => PlanOutcome::OutOfBudget,
    }
}

fn objective(wire: wire::Objective) -> PlanObjective {
    match wire {
        wire::Objective::Margin => PlanObjective::Margin,
        wire::Objective::Moves => PlanObjective::Moves,
    }
}

fn proof(wire: &wire::Proof) -> PlanProof {
    PlanProof {
        optimal: wire.optimal,
        margin_at_most: wire.margin_at_most.map(|margin| margin.0),
        moves_at_least: wire.moves_at_least.map(|moves| moves as usize),
    }
}

fn face(wire: wire::Axis) -> Face {
    match wire {
        wire::Axis::NegX => Face::NegX,
        wire::Axis::PosX => Face::PosX,
        wire::Axis::NegY => Face::NegY,
        wire::Axis::PosY => Face::PosY,
        wire::Axis::NegZ => Face::NegZ,
        wire::Axis::PosZ => Face::PosZ,
    }
}
