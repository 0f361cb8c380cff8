//! The actions of a plan for lattice modules.

use super::super::codes;
use super::super::document::LatticeProblem;
use super::super::findings::{Findings, Place};
use super::super::plan_document::Contradiction;
use super::super::turn::{AxisAngle, Cells};
use super::super::wire;
use super::connections::ports_of;
use super::module_type::refuse;
use super::names::Names;
use super::sequence::{Family, Held};
use crate::reconfigure::{Action, Turn, Which};
use crate::robot::{Configuration, Face, FaceConnection};

/// Reads plans for lattice modules.
pub(super) struct LatticePlans<'a> {
    start: &'a Configuration,
    modules: Names<'a>,
    goal_modules: Names<'a>,
    plan: usize,
    cells: Cells,
    /// What was found to contradict itself so far.
    pub(super) contradictions: Vec<Contradiction>,
}

impl<'a> LatticePlans<'a> {
    /// Reads plans for a problem, which stands at `root`.
    pub(super) fn new(problem: &'a LatticeProblem, root: &Place<'_>, findings: &mut Findings) -> Self {
        let mut names = |configuration: &'a Configuration| {
            let ids = configuration.modules.iter().map(|module| module.id.as_str()).collect();
            Names::new("modules", ids, |_| root.clone(), findings)
        };
        Self {
            start: &problem.start,
            modules: names(&problem.start),
            goal_modules: names(&problem.goal.configuration),
            plan: 0,
            cells: Cells::of(&problem.start),
            contradictions: Vec::new(),
        }
    }

    /// An action, and the turn that the file gives with it.
    fn read(
        &self,
        wire: &wire::Action,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<(Action, Option<AxisAngle>)> {
        Some(match wire {
            wire::Action::Attach { ports, .. } => {
                (Action::Attach(pair(ports, &self.modules, &place.key("ports"), findings)?), None)
            }
            wire::Action::Detach { ports, .. } => {
                (Action::Detach(pair(ports, &self.modules, &place.key("ports"), findings)?), None)
            }
            wire::Action::Slide { module, to, .. } => {
                let module = self.modules.find(module, &place.key("module"), findings)?;
                (Action::Slide { module, to: to.cell }, None)
            }
            wire::Action::Pivot { module, support, axis, angle_deg, to, .. } => {
                let module = self.modules.find(module, &place.key("module"), findings);
                let support = self.modules.find(support, &place.key("support"), findings);
                if module.is_some() && module == support {
                    let hint = "name the neighbour that carries the hinge".to_string();
                    let message = "a module cannot support itself";
                    findings.add(&place.key("support"), codes::SELF_CONNECTION, message, hint);
                }
                let turn = turn(*angle_deg, &place.key("angle_deg"), findings);
                let action = Action::Pivot { module: module?, support: support?, to: to.cell };
                (action, Some(AxisAngle { axis: face(*axis), turn: turn? }))
            }
            wire::Action::Roll { .. } | wire::Action::Rotate { .. } => {
                let hint = "lattice modules slide and pivot";
                refuse(&place.key("kind"), "not a motion of lattice modules", hint, findings);
                return None;
            }
        })
    }
}

impl Family for LatticePlans<'_> {
    type Action = Action;
    type Connection = FaceConnection;

    fn begin(&mut self, plan: usize) {
        self.plan = plan;
        self.cells = Cells::of(self.start);
    }

    fn action(
        &mut self,
        index: usize,
        wire: &wire::Action,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<Action> {
        let (action, given) = self.read(wire, place, findings)?;
        let actual = self.cells.take(&action);
        if let Some(given) = given.filter(|given| Some(*given) != actual) {
            self.contradictions.push(Contradiction { plan: self.plan, action: index, given, actual });
        }
        Some(action)
    }

    fn connection(
        &self,
        which: Which,
        held: Held<'_>,
        place: &Place<'_>,
        findings: &mut Findings,
    ) -> Option<FaceConnection> {
        let modules = match which {
            Which::Start => &self.modules,
            Which::Goal => &self.goal_modules,
        };
        match held {
            Held::Ports(ports) => pair(ports, modules, &place.key("connection"), findings),
            Held::Joint(_) => {
                refuse(&place.key("joint"), "lattice modules have no joints", "name a `connection`", findings);
                None
            }
        }
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
fn pair(
    ports: &[String; 2],
    modules: &Names<'_>,
    place: &Place<'_>,
    findings: &mut Findings,
) -> Option<FaceConnection> {
    let [a, b] = ports_of(ports, modules, place, findings);
    Some(FaceConnection::new(a?, b?))
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
