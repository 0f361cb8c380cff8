//! The actions of a plan for a linkage.
//!
//! Data only: which actions are legal is decided in `moves` for the planner and, again, in `replay` for
//! the check.

use crate::robot::linkage::{Connection, Spot};

/// A side of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Half {
    /// The side of the joint's parent body.
    Parent,
    /// The side of the joint's child body.
    Child,
}

/// One action of a plan. Modules are indices into the start's modules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Action {
    /// Engage the connection of two ports that meet.
    Attach(Connection),
    /// Release an engaged connection.
    Detach(Connection),
    /// Roll a port over the ball that it holds, by one step, with everything on one side of that connection.
    Roll {
        /// The connection that rolls, between a port at a point and a surface.
        connection: Connection,
        /// Where and how the port arrives.
        to: Spot,
        /// The module of the connection whose side moves.
        carried: usize,
    },
    /// Turn a joint by one step, with everything on one side of it.
    Rotate {
        /// The module whose joint it is.
        module: usize,
        /// Index of the joint in the module's type.
        joint: usize,
        /// The position that it arrives in, in steps.
        to: i32,
        /// The side that moves.
        carried: Half,
    },
}

impl Action {
    /// Whether it moves modules.
    pub const fn is_move(&self) -> bool {
        matches!(self, Self::Roll { .. } | Self::Rotate { .. })
    }

    /// Its kind as plans write it.
    pub const fn kind(&self) -> &'static str {
        match self {
            Self::Attach(_) => "attach",
            Self::Detach(_) => "detach",
            Self::Roll { .. } => "roll",
            Self::Rotate { .. } => "rotate",
        }
    }
}
