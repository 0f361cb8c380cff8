//! What cannot be planned for, and what is proved impossible before any search.

use std::fmt;

use crate::geometry::environment_problems;
use crate::robot::{Configuration, FaceConnection, Goal, Problem as Unsound};
use crate::statics::{Bracket, InvalidStructure};

/// Largest coordinate of a cell, so that no arithmetic on cells overflows in
/// any plan that could ever be found.
const LARGEST_COORDINATE: u32 = 1 << 24;

/// Why a problem is refused: bad input, which says nothing about plans.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// The data of the start or the goal is unsound.
    Unsound {
        /// Which of the two.
        which: Which,
        /// Everything that is wrong with it.
        problems: Vec<Unsound>,
    },
    /// The oracle cannot assess the robot.
    Structure(Vec<InvalidStructure>),
    /// A cell is too far from the origin for plans to be counted in cells.
    TooFar {
        /// Which of the two.
        which: Which,
        /// The module.
        module: String,
    },
    /// Start and goal are made of different catalogues.
    CataloguesDiffer,
    /// Modules whose face connectors are of different models touch or could
    /// come to touch each other.
    ConnectorsDoNotMate {
        /// Names of the two module types.
        types: [String; 2],
    },
    /// The goal does not say where a loaded module of the start ends.
    LoadedModuleMissing {
        /// The module.
        module: String,
    },
    /// The goal may be met up to a displacement, but that changes the problem: there are obstacles
    /// or fixed modules, or gravity is not vertical.
    NoFreeFrame {
        /// What stands in the way.
        because: &'static str,
    },
    /// Something is asked for that only lattices have.
    LatticesOnly {
        /// What, in the plural.
        what: &'static str,
    },
}

/// The start or the goal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Which {
    /// The start.
    Start,
    /// The goal.
    Goal,
}

impl Which {
    fn other(self) -> Self {
        match self {
            Self::Start => Self::Goal,
            Self::Goal => Self::Start,
        }
    }
}

/// Why there is no plan. `C` names a connection of the robot.
#[derive(Clone, Debug, PartialEq)]
pub enum Impossible<C = FaceConnection> {
    /// Start and goal have another number of modules of one kind.
    ModulesDiffer {
        /// The module type.
        module_type: String,
        /// How many the start has (with the same loads and label).
        start: usize,
        /// How many the goal has.
        goal: usize,
    },
    /// A module is fixed, or may not move, where the goal does not want it; or the goal fixes one that is not.
    FixedModule {
        /// The module.
        module: String,
    },
    /// The start or the goal is not connected.
    Disconnected(Which),
    /// The start or the goal cannot stand with the margin required.
    Unstable {
        /// Which of the two.
        which: Which,
        /// Its margin.
        margin: Bracket,
        /// The margin required.
        required: f64,
        /// The connection that fails first, if it is one; by ports of the start or the goal.
        connection: Option<C>,
    },
    /// Start or goal has no module in some cells near the ground, the other has, and no module gets there while none is
    /// there, nor does the last one leave.
    Sealed {
        /// The cells: those whose third coordinate is this or less.
        level: i32,
        /// The one of the two that has none there.
        which: Which,
    },
    /// Every sequence of actions was tried, or proved too weak.
    Exhausted {
        /// The margin required.
        required: f64,
    },
}

/// Why a problem is not searched.
#[derive(Clone, Debug, PartialEq)]
pub enum Rejection<C = FaceConnection> {
    /// Bad input.
    Refused(Refusal),
    /// Proved to have no plan.
    Impossible(Impossible<C>),
}

impl<C> From<Refusal> for Rejection<C> {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

impl<C> From<Impossible<C>> for Rejection<C> {
    fn from(impossible: Impossible<C>) -> Self {
        Self::Impossible(impossible)
    }
}

impl fmt::Display for Which {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Start => "start",
            Self::Goal => "goal",
        })
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unsound { which, problems } => {
                let listed: Vec<_> = problems.iter().map(ToString::to_string).collect();
                write!(f, "the {which} is unsound: {}", listed.join("; "))
            }
            Self::Structure(problems) => {
                let listed: Vec<_> = problems.iter().map(|p| format!("{}: {}", p.place, p.problem)).collect();
                write!(f, "the oracle cannot assess the robot: {}", listed.join("; "))
            }
            Self::TooFar { which, module } => {
                write!(f, "module `{module}` of the {which} is more than {LARGEST_COORDINATE} cells from the origin")
            }
            Self::CataloguesDiffer => f.write_str("start and goal are made of different catalogues"),
            Self::ConnectorsDoNotMate { types: [a, b] } => {
                write!(f, "the face connectors of `{a}` and `{b}` are of different models and do not mate")
            }
            Self::LoadedModuleMissing { module } => {
                write!(f, "the goal does not place module `{module}`, which carries a load in the start")
            }
            Self::NoFreeFrame { because } => write!(f, "the goal cannot be met up to a displacement: {because}"),
            Self::LatticesOnly { what } => write!(f, "{what} are for lattices only"),
        }
    }
}

impl std::error::Error for Refusal {}

impl<C> fmt::Display for Impossible<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ModulesDiffer { module_type, start, goal } => {
                write!(f, "the start has {start} interchangeable modules of type `{module_type}`, the goal {goal}")
            }
            Self::FixedModule { module } => {
                write!(f, "module `{module}` may not move and cannot be as the goal wants it")
            }
            Self::Disconnected(which) => write!(f, "the {which} is not connected"),
            Self::Unstable { which, margin, .. } if margin.upper == f64::NEG_INFINITY => {
                write!(f, "the {which} tips, slides or falls as a whole")
            }
            Self::Unstable { which, margin, required, .. } => write!(
                f,
                "the {which} is not stable enough: its margin is at most {:.4}, {required:.4} is required",
                margin.upper
            ),
            Self::Sealed { level, which } => write!(
                f,
                "the {which} has no module in cells at a height of {level} or below, the {} has, and there the first \
                 one cannot come nor the last one leave",
                which.other()
            ),
            Self::Exhausted { required } if *required == f64::NEG_INFINITY => {
                f.write_str("no sequence of actions leads from the start to the goal")
            }
            Self::Exhausted { required } => {
                write!(f, "no sequence of actions keeps the margin at {required:.4} or above")
            }
        }
    }
}

/// Refuses data that no robot can have and pairs that cannot be compared.
/// Disconnected robots are no bad input here.
pub(super) fn check(start: &Configuration, goal: &Goal) -> Result<(), Refusal> {
    for (which, configuration) in [(Which::Start, start), (Which::Goal, &goal.configuration)] {
        let mut problems = configuration.catalogue.problems();
        if problems.is_empty() {
            problems = configuration.problems();
            problems.retain(|problem| problem.fault != crate::robot::Fault::Disconnected);
        }
        if problems.is_empty() {
            check_reach(which, configuration)?;
            problems = environment_problems(configuration);
        }
        if !problems.is_empty() {
            return Err(Refusal::Unsound { which, problems });
        }
    }
    if start.catalogue != goal.configuration.catalogue {
        return Err(Refusal::CataloguesDiffer);
    }
    check_mating(start)
}

/// Refuses modules out of reach.
fn check_reach(which: Which, configuration: &Configuration) -> Result<(), Refusal> {
    let is_far = |c: i32| c.unsigned_abs() > LARGEST_COORDINATE;
    match configuration.modules.iter().find(|module| module.placement.cell.into_iter().any(is_far)) {
        Some(module) => Err(Refusal::TooFar { which, module: module.id.clone() }),
        None => Ok(()),
    }
}

/// Refuses modules whose faces could meet without being able to connect. Faces of
/// one model connect, so it is enough to compare all modules with the first.
fn check_mating(start: &Configuration) -> Result<(), Refusal> {
    let types = start.modules.iter().map(|module| module.module_type);
    let Some(first) = types.clone().next() else { return Ok(()) };
    let name = |index: usize| start.catalogue.module_types[index].name.clone();
    match types.into_iter().find(|&other| start.catalogue.face_connector(first, other).is_none()) {
        Some(other) => Err(Refusal::ConnectorsDoNotMate { types: [first, other].map(name) }),
        None => Ok(()),
    }
}
