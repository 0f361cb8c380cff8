//! One plan to its actions in `plan/1`.

use super::super::turn::{AxisAngle, Cells};
use super::super::wire::{self, Real};
use super::{Unwritable, bracket, configuration};
use crate::reconfigure::{Action, Bottleneck, Plan, PlannedAction, Turn};
use crate::robot::{Configuration, Face, FaceConnection};

/// Writes plans that begin at `start`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Writer<'a> {
    pub(super) start: &'a Configuration,
}

impl Writer<'_> {
    /// A plan; `given` is the turn that an action is to be written with, where it is not its own.
    pub(super) fn sequence(
        self,
        plan: &Plan,
        given: impl Fn(usize) -> Option<AxisAngle>,
    ) -> Result<wire::Alternative, Unwritable> {
        let mut cells = Cells::of(self.start);
        let actions = plan.actions.iter().enumerate().map(|(index, planned)| {
            let turn = cells.take(&planned.action);
            self.action(planned, given(index).or(turn))
        });
        Ok(wire::Alternative {
            actions: actions.collect::<Result<_, _>>()?,
            margin: plan.margin.map(bracket),
            moves: plan.moves,
            bottleneck: plan.bottleneck.as_ref().map(|bottleneck| self.bottleneck(bottleneck)).transpose()?,
        })
    }

    fn action(self, planned: &PlannedAction, turn: Option<AxisAngle>) -> Result<wire::Action, Unwritable> {
        let (margin, phase) = (planned.margin.map(bracket), planned.phase.map(Real));
        let target = |to| wire::CellTarget { cell: to };
        Ok(match planned.action {
            Action::Attach(pair) => wire::Action::Attach { ports: ports(self.start, pair)?, margin, phase },
            Action::Detach(pair) => wire::Action::Detach { ports: ports(self.start, pair)?, margin, phase },
            Action::Slide { module, to } => {
                wire::Action::Slide { module: self.id(module)?, to: target(to), margin, phase }
            }
            Action::Pivot { module, support, to } => {
                let turn = turn.ok_or_else(|| Unwritable::new("a pivot that no turn makes"))?;
                wire::Action::Pivot {
                    module: self.id(module)?,
                    support: self.id(support)?,
                    axis: axis(turn.axis),
                    angle_deg: match turn.turn {
                        Turn::Quarter => 90,
                        Turn::Half => 180,
                    },
                    to: target(to),
                    margin,
                    phase,
                }
            }
        })
    }

    fn bottleneck(self, bottleneck: &Bottleneck) -> Result<wire::Bottleneck, Unwritable> {
        Ok(wire::Bottleneck {
            action: bottleneck.action.map(|action| u32::try_from(action).unwrap_or(u32::MAX)),
            phase: Real(bottleneck.phase),
            connection: bottleneck.connection.map(|connection| ports(self.start, connection)).transpose()?,
        })
    }

    fn id(self, module: usize) -> Result<String, Unwritable> {
        let module = self
            .start
            .modules
            .get(module)
            .ok_or_else(|| Unwritable::new("an action on a module beyond the start's"))?;
        Ok(module.id.clone())
    }
}

/// The two ports of a connection between modules of a configuration.
pub(super) fn ports(configuration: &Configuration, connection: FaceConnection) -> Result<[String; 2], Unwritable> {
    if connection.modules().iter().any(|&module| module >= configuration.modules.len()) {
        return Err(Unwritable::new("a connection of a module beyond those there are"));
    }
    Ok(connection.ports.map(|port| configuration::port(configuration, port)))
}

fn axis(face: Face) -> wire::Axis {
    match face {
        Face::NegX => wire::Axis::NegX,
        Face::PosX => wire::Axis::PosX,
        Face::NegY => wire::Axis::NegY,
        Face::PosY => wire::Axis::PosY,
        Face::NegZ => wire::Axis::NegZ,
        Face::PosZ => wire::Axis::PosZ,
    }
}
