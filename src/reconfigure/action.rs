//! The actions of a plan, by module and exact cell.
//!
//! Data only: which actions are legal is decided in `moves` for the planner and, again, in
//! `replay` for the check.

use crate::robot::{Cell, FaceConnection};

/// One action of a plan. Modules are indices into the start's modules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// Engage the connection of two coinciding faces.
    Attach(FaceConnection),
    /// Release an engaged connection.
    Detach(FaceConnection),
    /// Move a module to another cell.
    Move {
        /// Which motion it makes: an index into [`Catalogue::motions`](crate::robot::Catalogue::motions).
        motion: u16,
        /// The module.
        module: usize,
        /// The neighbour that carries it, where it turns about an edge: by 90 degrees into a cell next to its own,
        /// or by 180 degrees into the cell diagonally across the neighbour's edge. `None` where it moves straight on.
        support: Option<usize>,
        /// The cell that it arrives in.
        to: Cell,
    },
}

impl Action {
    /// Whether it moves a module.
    pub const fn is_move(&self) -> bool {
        matches!(self, Self::Move { .. })
    }

    /// The module that it moves.
    pub const fn moved(&self) -> Option<usize> {
        match self {
            Self::Move { module, .. } => Some(*module),
            Self::Attach(_) | Self::Detach(_) => None,
        }
    }

    /// Its kind as plans write it; of a move `move`, whatever its motion is called.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Attach(_) => "attach",
            Self::Detach(_) => "detach",
            Self::Move { .. } => "move",
        }
    }
}
