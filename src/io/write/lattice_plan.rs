//! The actions of a plan for lattice modules.

use super::super::plan_document::PlanDocument;
use super::super::turn::{AxisAngle, Cells};
use super::super::wire;
use super::sequence::{Family, Named, Worth};
use super::{Unwritable, configuration};
use crate::reconfigure::{Action, Turn, Which};
use crate::robot::{Configuration, Face, FaceConnection};

/// Writes the plans of a document.
pub(super) struct LatticePlans<'a> {
    document: &'a PlanDocument,
    plan: usize,
    cells: Cells,
}

impl<'a> LatticePlans<'a> {
    pub(super) fn new(document: &'a PlanDocument) -> Self {
        Self { document, plan: 0, cells: Cells::of(&document.problem.start) }
    }

    fn start(&self) -> &Configuration {
        &self.document.problem.start
    }

    fn id(&self, module: usize) -> Result<String, Unwritable> {
        let found = self.start().modules.get(module);
        let module = found.ok_or_else(|| Unwritable::new("an action on a module beyond the start's"))?;
        Ok(module.id.clone())
    }
}

impl Family for LatticePlans<'_> {
    type Action = Action;
    type Connection = FaceConnection;

    fn begin(&mut self, plan: usize) {
        self.plan = plan;
        self.cells = Cells::of(&self.document.problem.start);
    }

    /// A turn is written as the one that its file gave, where that is not its own.
    fn action(&mut self, index: usize, action: &Action, (margin, phase): Worth) -> Result<wire::Action, Unwritable> {
        let turn = self.cells.take(action);
        let given = self.document.contradictions_of(self.plan).find(|c| c.action == index).map(|c| c.given);
        let target = |to| wire::CellTarget { cell: to };
        Ok(match *action {
            Action::Attach(pair) => wire::Action::Attach { ports: ports(self.start(), pair)?, margin, phase },
            Action::Detach(pair) => wire::Action::Detach { ports: ports(self.start(), pair)?, margin, phase },
            Action::Move { motion, module, support, to } => {
                let kinds = &self.start().catalogue.motions;
                let kind = kinds.get(usize::from(motion)).map(|motion| motion.name.as_str());
                let motion = kind.ok_or_else(|| Unwritable::new("a motion beyond the catalogue's"))?;
                let (module, to) = (self.id(module)?, target(to));
                let support = support.map(|support| self.id(support)).transpose()?;
                let turned = || given.or(turn).ok_or_else(|| Unwritable::new("a turn that no axis makes"));
                match (motion, support) {
                    ("slide", None) => wire::Action::Slide { module, to, margin, phase },
                    ("pivot", Some(support)) => {
                        let wire::TurnAbout { axis, angle_deg } = about(turned()?);
                        wire::Action::Pivot { module, support, axis, angle_deg, to, margin, phase }
                    }
                    (motion, support) => {
                        let turn = support.is_some().then(turned).transpose()?.map(about);
                        wire::Action::Move { motion: motion.into(), module, support, turn, to, margin, phase }
                    }
                }
            }
        })
    }

    fn held(&self, which: Which, held: FaceConnection) -> Result<Named, Unwritable> {
        let configuration = match which {
            Which::Start => self.start(),
            Which::Goal => &self.document.problem.goal.configuration,
        };
        Ok((Some(ports(configuration, held)?), None))
    }
}

/// The two ports of a connection between modules of a configuration.
fn ports(configuration: &Configuration, connection: FaceConnection) -> Result<[String; 2], Unwritable> {
    if connection.modules().iter().any(|&module| module >= configuration.modules.len()) {
        return Err(Unwritable::new("a connection of a module beyond those there are"));
    }
    Ok(connection.ports.map(|port| configuration::port(configuration, port)))
}

fn about(turn: AxisAngle) -> wire::TurnAbout {
    let angle_deg = match turn.turn {
        Turn::Quarter => 90,
        Turn::Half => 180,
    };
    wire::TurnAbout { axis: axis(turn.axis), angle_deg }
}

/// A direction as files say it.
pub(super) fn axis(face: Face) -> wire::Axis {
    match face {
        Face::NegX => wire::Axis::NegX,
        Face::PosX => wire::Axis::PosX,
        Face::NegY => wire::Axis::NegY,
        Face::PosY => wire::Axis::PosY,
        Face::NegZ => wire::Axis::NegZ,
        Face::PosZ => wire::Axis::PosZ,
    }
}
