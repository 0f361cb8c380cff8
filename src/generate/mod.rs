//! Random problems: a start and a goal that both stand, drawn from a seed.
//!
//! Knows robots, the oracle and random walks; knows no files and never prints. What is drawn
//! depends on the [`Request`] alone: on no clock, no thread and no order of a hash map. Random numbers are
//! those of ChaCha8, of which the start, the goal and the surroundings have a stream each, so that the same seed has the
//! same start whatever the goal. Robots in a lattice are integers and so the same on every machine; poses of linkages
//! go through the platform's sine and cosine.
//!
//! How shapes grow and what is rejected is told in `docs/random_problems.md`.

mod cubes;
mod draw;
mod freesn;
mod modular;
mod rofi;
mod setting;
mod stands;
#[cfg(test)]
mod tests;

use std::fmt;

use crate::reconfigure::Refusal;
use crate::robot::linkage::{self, Linkage};
use crate::robot::{Configuration, Goal};

pub use setting::Setting;

/// Attempts at a start, or at a goal for one, before giving up.
const ATTEMPTS: usize = 200;

/// What kind of robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Family {
    /// Magnetic cubes in a lattice.
    Cubes,
    /// Struts and nodes.
    Freesn,
    /// Universal modules of the RoFI platform.
    Rofi,
}

/// Where a goal comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum GoalKind {
    /// Grown like the start, on the same ground: nobody knows whether a plan exists. The hard kind.
    Grown,
    /// The end of a random walk of admissible moves from the start: a plan exists.
    Walk,
}

/// What is to be drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// What kind of robot.
    pub family: Family,
    /// How many modules: of struts and nodes together.
    pub modules: usize,
    /// Where the random numbers begin.
    pub seed: u64,
    /// What surrounds the robot, and what it stands on.
    pub setting: Setting,
    /// Whether the first module is held immovably; always so in [`Setting::Mounted`].
    pub held: bool,
    /// Where the goal comes from.
    pub goal: GoalKind,
    /// How far the goal is: of a grown one how many modules must change places, of a walk how many moves it
    /// takes. `None`: all but the one that the goal grows from; twice as many moves as there are modules. Grown
    /// goals of linkages take none.
    pub difficulty: Option<usize>,
    /// Margin that start and goal have at least, and every state of a walk.
    pub margin: f64,
}

impl Request {
    /// A request for the family's usual kind of problem: cubes that grow on a flat floor; struts and nodes on a
    /// held foot, and RoFI modules without gravity, that walk.
    pub fn new(family: Family, modules: usize, seed: u64) -> Self {
        let (setting, held, goal) = match family {
            Family::Cubes => (Setting::Flat, false, GoalKind::Grown),
            Family::Freesn => (Setting::Flat, true, GoalKind::Walk),
            Family::Rofi => (Setting::Space, false, GoalKind::Walk),
        };
        Self { family, modules, seed, setting, held, goal, difficulty: None, margin: 0.1 }
    }
}

/// A start and a goal.
#[derive(Clone, Debug, PartialEq)]
pub enum Pair {
    /// Of cubes.
    Lattice {
        /// Where the robot is.
        start: Configuration,
        /// Where it is to be.
        goal: Goal,
    },
    /// Of struts and nodes, or of RoFI modules.
    Linkage {
        /// Where the robot is.
        start: Linkage,
        /// Where it is to be.
        goal: linkage::Goal,
    },
}

/// What was drawn, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct Generated {
    /// The problem.
    pub pair: Pair,
    /// How far the goal is, as [`Request::difficulty`] counts; `None` for a grown goal of a linkage. A walk may end
    /// early, where no move is left that leads anywhere new.
    pub difficulty: Option<usize>,
    /// What it took.
    pub tally: Tally,
}

/// What it took to draw a problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Modules that were placed, those of rejected shapes included.
    pub drawn: u64,
    /// Of these, how many hit others or the surroundings (cubes are only drawn where there is room).
    pub blocked: u64,
    /// Of these, how many were taken back because the robot would not have stood with the margin asked for.
    pub unstable: u64,
    /// Shapes that were given up.
    pub restarts: u64,
}

/// Why nothing was drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Failure {
    /// The family has no problems of that size.
    Modules {
        /// Fewest modules.
        least: usize,
        /// Most modules.
        most: usize,
    },
    /// No goal is that far, or none that near.
    Difficulty {
        /// The least.
        least: usize,
        /// The most.
        most: usize,
    },
    /// How far a grown goal of a linkage is cannot be chosen.
    NoDifficulty,
    /// The margin is not below 1, or no number.
    Margin,
    /// All attempts failed.
    NoneFound(Tally),
    /// The planner refuses what was drawn.
    Refused(Refusal),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Modules { least, most } => write!(f, "this family has from {least} to {most} modules"),
            Self::Difficulty { least, most } => write!(f, "the difficulty is from {least} to {most} here"),
            Self::NoDifficulty => {
                f.write_str("how far a grown goal of this family is cannot be chosen; that of a walk can")
            }
            Self::Margin => f.write_str("the margin of start and goal is a number below 1"),
            Self::NoneFound(tally) => write!(
                f,
                "found no such problem in {ATTEMPTS} attempts; of {} modules placed, {} hit something and {} would \
                 not have stood: ask for less margin, fewer modules or another seed",
                tally.drawn, tally.blocked, tally.unstable
            ),
            Self::Refused(refusal) => refusal.fmt(f),
        }
    }
}

impl std::error::Error for Failure {}

impl Family {
    /// Name as files write it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Cubes => "cubes",
            Self::Freesn => "freesn",
            Self::Rofi => "rofi",
        }
    }

    /// Fewest and most modules that are drawn.
    pub const fn sizes(self) -> [usize; 2] {
        match self {
            Self::Cubes => [2, 2000],
            Self::Freesn => [2, 100],
            Self::Rofi => [1, 50],
        }
    }
}

impl GoalKind {
    /// Name as files write it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Grown => "grown",
            Self::Walk => "walk",
        }
    }
}

/// Draws the problem of a request.
///
/// # Errors
/// What cannot be drawn, or was not found.
pub fn generate(request: &Request) -> Result<Generated, Failure> {
    let [least, most] = request.family.sizes();
    if !(least..=most).contains(&request.modules) {
        return Err(Failure::Modules { least, most });
    }
    if !(request.margin < 1.0 && request.margin >= 0.0) {
        return Err(Failure::Margin);
    }
    let request = &Request { held: request.held || request.setting == Setting::Mounted, ..*request };
    match request.family {
        Family::Cubes => cubes::generate(request),
        Family::Freesn | Family::Rofi => modular::generate(request),
    }
}

/// How far the goal of a walk is to be.
///
/// # Errors
/// A walk of no moves, or of very many.
fn walk_length(request: &Request) -> Result<usize, Failure> {
    /// Longer walks take long and lead no farther.
    const LONGEST: usize = 10_000;
    match request.difficulty.unwrap_or(2 * request.modules) {
        moves @ 1..=LONGEST => Ok(moves),
        _ => Err(Failure::Difficulty { least: 1, most: LONGEST }),
    }
}
