//! One plan of `plan/1` to a plan of the planner.

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::plan_document::Contradiction;
use super::super::turn::{AxisAngle, Cells};
use super::super::wire;
use super::connections::ports_of;
use super::names::Names;
use crate::reconfigure::{Action, Bottleneck, Plan, PlannedAction, Turn};
use crate::robot::{Configuration, Face, FaceConnection};
use crate::statics::Bracket;

/// Reads plans that begin at `start`.
pub(super) struct Reader<'a> {
    pub(super) start: &'a Configuration,
    pub(super) modules: &'a Names<'a>,
    /// What was found to contradict itself so far.
    pub(super) contradictions: Vec<Contradiction>,
}

/// What a file says of one plan.
pub(super) struct Parts<'w> {
    pub(super) margin: Option<wire::Bracket>,
    pub(super) moves: Option<u32>,
    pub(super) bottleneck: Option<&'w wire::Bottleneck>,
    pub(super) actions: &'w [wire::Action],
}

impl Reader<'_> {
    /// The plan at `place`, which is number `plan` of its file. What it claims is
    /// taken as it stands: a replay tells whether it holds.
    pub(super) fn sequence(
        &mut self,
        plan: usize,
        parts: Parts<'_>,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<Plan> {
        let mut cells = Cells::of(self.start);
        let actions_place = place.key("actions");
        let mut actions = Vec::with_capacity(parts.actions.len());
        for (index, wire) in parts.actions.iter().enumerate() {
            let planned = self.action(wire, &actions_place.index(index), findings);
            if let Some((planned, given)) = &planned {
                let actual = cells.take(&planned.action);
                if let Some(given) = given.filter(|given| Some(*given) != actual) {
                    self.contradictions.push(Contradiction { plan, action: index, given, actual });
                }
            }
            actions.push(planned.map(|(planned, _)| planned));
        }
        let bottleneck = parts.bottleneck.map(|wire| {
            let place = place.key("bottleneck").key("connection");
            let connection = wire.connection.as_ref().map(|ports| pair(ports, self.modules, &place, findings));
            let action = wire.action.map(|action| action as usize);
            Bottleneck { action, phase: wire.phase.0, connection: connection.flatten() }
        });
        let actions = actions.into_iter().collect::<Option<Vec<_>>>()?;
        Some(Plan { margin: parts.margin.map(bracket), moves: parts.moves.unwrap_or_default(), bottleneck, actions })
    }

    /// An action, and the turn that the file gives with it.
    fn action(
        &self,
        wire: &wire::Action,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<(PlannedAction, Option<AxisAngle>)> {
        let (action, margin, phase, turn) = match wire {
            wire::Action::Attach { ports, margin, phase } => {
                let connection = pair(ports, self.modules, &place.key("ports"), findings)?;
                (Action::Attach(connection), margin, phase, None)
            }
            wire::Action::Detach { ports, margin, phase } => {
                let connection = pair(ports, self.modules, &place.key("ports"), findings)?;
                (Action::Detach(connection), margin, phase, None)
            }
            wire::Action::Slide { module, to, margin, phase } => {
                let module = self.modules.find(module, &place.key("module"), findings)?;
                (Action::Slide { module, to: to.cell }, margin, phase, None)
            }
            wire::Action::Pivot { module, support, axis, angle_deg, to, margin, phase } => {
                let module = self.modules.find(module, &place.key("module"), findings);
                let support = self.modules.find(support, &place.key("support"), findings);
                if module.is_some() && module == support {
                    let hint = "name the neighbour that carries the hinge".to_string();
                    let message = "a module cannot support itself";
                    findings.add(&place.key("support"), codes::SELF_CONNECTION, message, hint);
                }
                let turn = turn(*angle_deg, &place.key("angle_deg"), findings);
                let action = Action::Pivot { module: module?, support: support?, to: to.cell };
                (action, margin, phase, Some(AxisAngle { axis: face(*axis), turn: turn? }))
            }
        };
        Some((PlannedAction { action, margin: margin.map(bracket), phase: phase.map(|phase| phase.0) }, turn))
    }
}

fn turn(angle_deg: u32, place: &Place<'_>, findings: &mut Findings) -> Option<Turn> {
    match angle_deg {
        90 => Some(Turn::Quarter),
        180 => Some(Turn::Half),
        other => {
            let message = format!("a cube pivots by 90 or 180 degrees, found {other}");
            findings.add(place, codes::OUT_OF_RANGE, message, "the direction is in `axis`".to_string());
            None
        }
    }
}

/// The connection of two ports, which stand at `place`.
pub(super) fn pair(
    ports: &[String; 2],
    modules: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<FaceConnection> {
    let [a, b] = ports_of(ports, modules, place, findings);
    Some(FaceConnection::new(a?, b?))
}

/// An end where nothing was proved is infinite.
pub(super) fn bracket(wire: wire::Bracket) -> Bracket {
    Bracket::new(wire.lower.0.unwrap_or(f64::NEG_INFINITY), wire.upper.0.unwrap_or(f64::INFINITY))
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
