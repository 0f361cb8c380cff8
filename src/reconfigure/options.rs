//! What a caller asks of planning, and what it sees of a running search. Plain data.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use planners::Progress;

use super::plan::Objective;

/// Which transitions a search goes by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Reduction {
    /// Whole moves between states with every possible connection engaged.
    #[default]
    Saturated,
    /// Every attach, detach and move on its own: the reference, for small problems.
    Primitive,
}

/// How plans of lattice robots are looked for. Robots of joints and struts are always searched exactly.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// Exact search for as many movable modules as it is made for, decomposition beyond.
    #[default]
    Auto,
    /// Search of the space of all states: plans with proofs of optimality.
    Exact,
    /// One module after another to where it is wanted: plans for hundreds of
    /// modules, of which nothing is proved but that they are safe.
    Decompose,
}

/// What is wanted and what may be spent. The default asks for the one plan of
/// the largest margin, without a limit.
///
/// The oracle's work is spread over the rayon pool that [`solve`](super::solve) is called in;
/// the plans do not depend on its size.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What makes a plan better.
    pub objective: Objective,
    /// Margin that every transient state must have, where it is more than the start requires.
    pub min_margin: Option<f64>,
    /// How many plans; 0 counts as 1. With [`Objective::Margin`] further plans have
    /// the best margin too, with [`Objective::Moves`] the required one.
    pub plans: usize,
    /// Time to stop after; plans in the middle of a check finish it.
    pub time_limit: Option<Duration>,
    /// Expansions to stop after.
    pub max_expansions: Option<u64>,
    /// Approximate memory of the search in bytes to stop at.
    pub max_bytes: Option<usize>,
    /// Set it from any thread to stop.
    pub cancel: Option<Arc<AtomicBool>>,
    /// Plan by geometry and connectedness alone, for comparison.
    pub ignore_stability: bool,
    /// What the search goes by.
    pub reduction: Reduction,
    /// How plans are looked for.
    pub method: Method,
    /// Seed of a decomposition's choices among equals; the exact search draws no random numbers.
    pub seed: u64,
}

/// What a caller sees of a running search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Event {
    /// The search itself; widths are margins, costs are moves.
    pub progress: Progress,
    /// Structures that the oracle has assessed.
    pub oracle_solves: u64,
}
