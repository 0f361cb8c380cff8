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
    /// Move a module by one cell over the faces of two coplanar neighbours.
    Slide {
        /// The module.
        module: usize,
        /// The cell that it arrives in, next to its own.
        to: Cell,
    },
    /// Turn a module about an edge that it shares with a neighbour: by 90
    /// degrees into a cell next to its own, or by 180 degrees into the cell
    /// diagonally across the neighbour's edge.
    Pivot {
        /// The module.
        module: usize,
        /// The neighbour that carries it.
        support: usize,
        /// The cell that it arrives in.
        to: Cell,
    },
}

impl Action {
    /// Whether it moves a module.
    pub const fn is_move(&self) -> bool {
        matches!(self, Self::Slide { .. } | Self::Pivot { .. })
    }

    /// The module that it moves.
    pub const fn moved(&self) -> Option<usize> {
        match self {
            Self::Slide { module, .. } | Self::Pivot { module, .. } => Some(*module),
            Self::Attach(_) | Self::Detach(_) => None,
        }
    }

    /// Its kind as plans write it.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Attach(_) => "attach",
            Self::Detach(_) => "detach",
            Self::Slide { .. } => "slide",
            Self::Pivot { .. } => "pivot",
        }
    }
}
