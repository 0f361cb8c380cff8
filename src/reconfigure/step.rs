//! Primitive steps on cells, and what they do to a configuration: exactly, on
//! integers, so that a step and its reversal return the identical state.

use crate::robot::{Configuration, Motion};

use super::action::Action;
use super::layout::{Bond, neighbour};
use super::moves::Move;
use super::problem::{bonds, cells, connection, module_at};

/// A primitive action on cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Step {
    /// Engage the connection of two coinciding faces.
    Attach(Bond),
    /// Release an engaged connection.
    Detach(Bond),
    /// Move a module.
    Move(Move),
}

impl Step {
    /// The step as an action on the modules of the state that it is taken in.
    /// `None` where a cell that it needs is empty.
    pub fn action(self, before: &Configuration) -> Option<Action> {
        Some(match self {
            Self::Attach(bond) => Action::Attach(connection(before, bond)?),
            Self::Detach(bond) => Action::Detach(connection(before, bond)?),
            Self::Move(step) => {
                let support = match step.motion {
                    Motion::Translation { .. } => None,
                    Motion::Rotation { support, .. } => Some(module_at(before, neighbour(step.from, support))?),
                };
                Action::Move { motion: step.kind, module: module_at(before, step.from)?, support, to: step.to() }
            }
        })
    }

    /// Takes the step. The configuration keeps its connections sorted.
    pub fn apply(self, configuration: &mut Configuration) {
        match self {
            Self::Attach(bond) => configuration.connections.extend(connection(configuration, bond)),
            Self::Detach(bond) => {
                let released = connection(configuration, bond);
                configuration.connections.retain(|engaged| Some(*engaged) != released);
            }
            Self::Move(step) => apply_move(configuration, step),
        }
        configuration.connections.sort_unstable();
        configuration.connections.dedup();
    }

    /// The steps that lead back exactly. A move may have engaged faces that were
    /// not engaged before (a translation engages all that it ends beside), so its
    /// way back ends with releasing them.
    pub fn reversal(self, before: &Configuration) -> Vec<Self> {
        match self {
            Self::Attach(bond) => vec![Self::Detach(bond)],
            Self::Detach(bond) => vec![Self::Attach(bond)],
            Self::Move(step) => {
                let engaged = bonds(before);
                let gained = step.departure(&cells(before)).into_iter().filter(|bond| !engaged.contains(bond));
                [Self::Move(step.inverse())].into_iter().chain(gained.map(Self::Detach)).collect()
            }
        }
    }
}

fn apply_move(configuration: &mut Configuration, step: Move) {
    let Some(module) = module_at(configuration, step.from) else { return };
    let landing = step.landing(&cells(configuration));
    configuration.connections.retain(|engaged| !engaged.modules().contains(&module));
    let placement = &mut configuration.modules[module].placement;
    placement.cell = step.to();
    placement.orientation = placement.orientation.turned(step.rotation());
    let landed: Vec<_> = landing.into_iter().filter_map(|bond| connection(configuration, bond)).collect();
    configuration.connections.extend(landed);
}
