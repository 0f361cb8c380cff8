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
    motions: Names<'a>,
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
        let [modules, goal_modules] = [&problem.start, &problem.goal.configuration].map(&mut names);
        let motions = problem.start.catalogue.motions.iter().map(|motion| motion.name.as_str()).collect();
        Self {
            start: &problem.start,
            modules,
            goal_modules,
            motions: Names::new("motions", motions, |_| root.clone(), findings),
            plan: 0,
            cells: Cells::of(&problem.start),
            contradictions: Vec::new(),
        }
    }

    /// The motion of the catalogue with this name, which stands at `place`.
    fn motion(&self, name: &str, place: &Place<'_>, findings: &mut Findings) -> Option<u16> {
        u16::try_from(self.motions.find(name, place, findings)?).ok()
    }

    /// A module that moves and its support, which the action at `place` names.
    fn pair(&self, module: &str, support: &str, place: &Place<'_>, findings: &mut Findings) -> [Option<usize>; 2] {
        let module = self.modules.find(module, &place.key("module"), findings);
        let support = self.modules.find(support, &place.key("support"), findings);
        if module.is_some() && module == support {
            let hint = "name the neighbour that carries the hinge".to_string();
            let message = "a module cannot support itself";
            findings.add(&place.key("support"), codes::SELF_CONNECTION, message, hint);
        }
        [module, support]
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
                let motion = self.motion("slide", &place.key("kind"), findings);
                let module = self.modules.find(module, &place.key("module"), findings);
                (Action::Move { motion: motion?, module: module?, support: None, to: to.cell }, None)
            }
            wire::Action::Pivot { module, support, axis, angle_deg, to, .. } => {
                let motion = self.motion("pivot", &place.key("kind"), findings);
                let [module, support] = self.pair(module, support, place, findings);
                let turn = turn(*angle_deg, "the direction is in `axis`", &place.key("angle_deg"), findings);
                let action = Action::Move { motion: motion?, module: module?, support: Some(support?), to: to.cell };
                (action, Some(AxisAngle { axis: face(*axis), turn: turn? }))
            }
            wire::Action::Move { motion, module, support: Some(support), turn: Some(about), to, .. } => {
                let motion = self.motion(motion, &place.key("motion"), findings);
                let [module, support] = self.pair(module, support, place, findings);
                let angle_at = place.key("turn").key("angle_deg");
                let turn = turn(about.angle_deg, "the direction is in `axis`", &angle_at, findings);
                let action = Action::Move { motion: motion?, module: module?, support: Some(support?), to: to.cell };
                (action, Some(AxisAngle { axis: face(about.axis), turn: turn? }))
            }
            wire::Action::Move { motion, module, support: None, turn: None, to, .. } => {
                let motion = self.motion(motion, &place.key("motion"), findings);
                let module = self.modules.find(module, &place.key("module"), findings);
                (Action::Move { motion: motion?, module: module?, support: None, to: to.cell }, None)
            }
            wire::Action::Move { support, .. } => {
                let missing = if support.is_some() { "turn" } else { "support" };
                let hint = "a module that turns about an edge has a `support` and a `turn`, any other neither";
                findings.add(&place.key(missing), codes::MISSING_KEY, "the key is missing", hint.to_string());
                return None;
            }
            wire::Action::Roll { .. } | wire::Action::Rotate { .. } => {
                let hint = "lattice modules slide, pivot, and make what motions their catalogue has";
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

/// How far a cube turns about an edge; `hint` says where to find in which direction.
pub(super) fn turn(angle_deg: u32, hint: &str, place: &Place<'_>, findings: &mut Findings) -> Option<Turn> {
    let turn = Turn::of_degrees(angle_deg);
    if turn.is_none() {
        let message = format!("a cube pivots by 90 or 180 degrees, found {angle_deg}");
        findings.add(place, codes::OUT_OF_RANGE, message, hint.to_string());
    }
    turn
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

/// The direction of an axis.
pub(super) fn face(wire: wire::Axis) -> Face {
    match wire {
        wire::Axis::NegX => Face::NegX,
        wire::Axis::PosX => Face::PosX,
        wire::Axis::NegY => Face::NegY,
        wire::Axis::PosY => Face::PosY,
        wire::Axis::NegZ => Face::NegZ,
        wire::Axis::PosZ => Face::PosZ,
    }
}
