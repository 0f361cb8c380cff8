//! What a caller asks of planning, and what it sees of a running search. Plain data.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

pub use planners::Pass;

use crate::robot::FaceConnection;

use super::action::Action;
use super::baseline::Baseline;
use super::plan::{Objective, Plan};

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
    /// How many plans; 0 counts as 1. They are the best ones by margin and then by moves, with [`Objective::Moves`]
    /// those of the fewest moves; [`Objective::Pareto`] has as many as its front.
    pub plans: usize,
    /// Time to stop after; plans in the middle of a check finish it.
    pub time_limit: Option<Duration>,
    /// Expansions to stop after.
    pub max_expansions: Option<u64>,
    /// Memory in bytes that is not to be exceeded: of the search with all that it remembers of the oracle's answers, in
    /// approximate bytes, or as `measure_bytes` finds it.
    pub max_bytes: Option<usize>,
    /// Measures the memory in use in bytes, for a caller that has a process to itself.
    pub measure_bytes: Option<fn() -> Option<usize>>,
    /// Says what time it is to a measurement of what the oracle takes, for lattice robots: the processor's, or the wall's.
    pub clock: Option<fn() -> Duration>,
    /// Set it from any thread to stop.
    pub cancel: Option<Arc<AtomicBool>>,
    /// Where no plan is found, say [what is in the way](super::InTheWay): a search of its own, for about as long again.
    pub explain: bool,
    /// Plan by geometry and connectedness alone, for comparison.
    pub ignore_stability: bool,
    /// What the search goes by.
    pub reduction: Reduction,
    /// A poorer search to compare with, of the saturated space.
    pub baseline: Option<Baseline>,
    /// How plans are looked for.
    pub method: Method,
    /// Seed of a decomposition's choices among equals; the exact search draws no random numbers.
    pub seed: u64,
}

/// What a caller sees of a running search: what is new, and all that is known by then.
///
/// Bounds only ever get tighter from one event to the next, and every plan is better than those before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Event<A = Action, C = FaceConnection> {
    /// What is new.
    pub news: News<A, C>,
    /// What is known.
    pub known: Known,
}

/// What is new about a running search.
#[derive(Clone, Debug, PartialEq)]
pub enum News<A = Action, C = FaceConnection> {
    /// It goes on.
    Progress,
    /// A plan that is better than all before it, by the objective: complete, and as good to carry out as the last one.
    Plan(Plan<A, C>),
    /// More is proved about all plans.
    Bound,
}

/// What is known of a search that is not done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// What the search is doing.
    pub pass: Pass,
    /// Margin of the best plan so far, its proved lower end; `None` without one, or where plans are made by geometry alone.
    pub margin: Option<f64>,
    /// Moves of the best plan so far.
    pub moves: Option<u32>,
    /// No plan has a larger margin.
    pub margin_at_most: f64,
    /// No plan that would be better than the best so far (by margin, where that counts first: by more than the tolerance) has
    /// fewer moves.
    pub moves_at_least: u32,
    /// What the search has spent.
    pub statistics: planners::Statistics,
    /// Structures that the oracle has assessed.
    pub oracle_solves: u64,
}

impl Known {
    /// What is known before a search begins.
    pub(super) const NOTHING: Self = Self {
        pass: Pass::Greedy,
        margin: None,
        moves: None,
        margin_at_most: f64::INFINITY,
        moves_at_least: 0,
        statistics: planners::Statistics { expanded: 0, generated: 0, certified: 0, states: 0, bytes: 0 },
        oracle_solves: 0,
    };
}
