//! What can be wrong with a plan.
//!
//! `C` names a connection and `T` what a module hits; without parameters those of a lattice.

use std::fmt;

use crate::reconfigure::assembly::Touched;
use crate::robot::FaceConnection;
use crate::statics::Bracket;

/// One thing that is wrong with a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure<C = FaceConnection, T = Touched> {
    /// Index of the action; `None` for the start, the plan's own claims and the goal.
    pub action: Option<usize>,
    /// Phase of the action, where it happens during a move.
    pub phase: Option<f64>,
    /// What is wrong.
    pub fault: Fault<T>,
    /// The connection that fails first, where one does.
    pub connection: Option<C>,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Fault<T = Touched> {
    /// A module index points beyond the start's modules.
    UnknownModule,
    /// A fixed module would have to move.
    FixedModule,
    /// A module that is not allowed to would have to move.
    MustStay,
    /// A module passes through a region where none may be.
    KeepOut {
        /// Index of the region in the start's requirement.
        region: usize,
    },
    /// The two faces or ports to connect do not meet.
    FacesApart,
    /// The connection to engage is engaged already.
    AlreadyEngaged,
    /// The connection to release is not engaged.
    NotEngaged,
    /// The module is not made for the motion, or an edge has no hinge.
    Unable,
    /// The cell is not one that the motion leads to.
    NoSuchMotion,
    /// A module that the motion needs is missing: a coplanar neighbour, a support, or a landing.
    NoSupport,
    /// A cell that the motion needs empty is not.
    NotFree,
    /// The module is not connected where the motion starts from.
    NotHeld,
    /// A connection that the motion cannot keep is engaged.
    NotReleased,
    /// The side of the joint or connection that is carried holds on to the other side as well.
    NotABridge,
    /// The joint cannot be turned there.
    BeyondRange,
    /// The moving module hits something.
    Collision {
        /// What it hits.
        with: T,
    },
    /// Not all modules are connected.
    Disconnected,
    /// The margin is below the required one.
    Unstable {
        /// The margin found; minus infinity when the robot as a whole tips, slides or falls.
        margin: Bracket,
        /// The margin required.
        required: f64,
    },
    /// The plan claims another margin than the oracle finds.
    MarginDiffers {
        /// What the plan claims.
        claimed: Bracket,
        /// What was found.
        found: Bracket,
    },
    /// The plan claims another number of moves than it has.
    MovesDiffer {
        /// What the plan claims.
        claimed: u32,
        /// How many there are.
        found: usize,
    },
    /// The plan's margin is not attained where it says, or not limited by that connection.
    BottleneckDiffers,
    /// Some claims on margins are missing while others are made.
    ClaimsIncomplete,
    /// A module is not where the goal wants one of its kind.
    PlacementsDiffer,
    /// The engaged connections are not the goal's.
    ConnectionsDiffer,
}

impl<T: fmt::Display> fmt::Display for Fault<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownModule => f.write_str("no such module"),
            Self::FixedModule => f.write_str("a fixed module cannot move"),
            Self::MustStay => f.write_str("the module is not allowed to move"),
            Self::KeepOut { region } => write!(f, "it passes through forbidden region number {region}"),
            Self::FacesApart => f.write_str("the two ports do not meet"),
            Self::NotABridge => f.write_str("what moves is held by more than the joint or connection that it turns at"),
            Self::BeyondRange => f.write_str("the joint's range ends before this position"),
            Self::AlreadyEngaged => f.write_str("the connection is engaged already"),
            Self::NotEngaged => f.write_str("the connection is not engaged"),
            Self::Unable => f.write_str("the module cannot make this motion"),
            Self::NoSuchMotion => f.write_str("no single motion leads there from where the module is"),
            Self::NoSupport => f.write_str("a module that the motion needs as support or landing is missing"),
            Self::NotFree => f.write_str("a module is in a cell that the motion needs empty"),
            Self::NotHeld => f.write_str("the module is not connected to the support of its motion"),
            Self::NotReleased => f.write_str("a connection that the motion cannot keep is engaged"),
            Self::Collision { with } => write!(f, "it collides with {with}"),
            Self::Disconnected => f.write_str("the robot is not connected"),
            Self::Unstable { margin, .. } if margin.upper == f64::NEG_INFINITY => {
                f.write_str("the robot tips, slides or falls as a whole")
            }
            Self::Unstable { margin, required } => {
                write!(f, "the margin is {:.6}, {required:.6} is required", margin.lower)
            }
            Self::MarginDiffers { claimed, found } => {
                write!(f, "the plan claims a margin of {:.6}, {:.6} was found", claimed.lower, found.lower)
            }
            Self::MovesDiffer { claimed, found } => write!(f, "the plan claims {claimed} moves and has {found}"),
            Self::BottleneckDiffers => f.write_str("the plan's margin is not attained where it says"),
            Self::ClaimsIncomplete => f.write_str("the plan claims margins for some of its actions only"),
            Self::PlacementsDiffer => f.write_str("the modules do not end where the goal wants them"),
            Self::ConnectionsDiffer => f.write_str("the connections at the end are not the goal's"),
        }
    }
}

impl fmt::Display for Touched {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Module(other) => write!(f, "module number {other}"),
            Self::Obstacle(index) => write!(f, "obstacle number {index}"),
            Self::Ground => f.write_str("the ground"),
        }
    }
}
