//! The partial order of a plan: which of its actions may run at the same time.
//!
//! The order is a graph on the plan's actions. An action may begin once those with an arrow to it have ended, and
//! need not wait for any other: *every* order and *every* overlap that the graph allows is legal, free of collision,
//! connected where that is required, and stable with the margin asked for, and all of them end in the same state.
//!
//! That is checked, not assumed. A moment of such a run is a set of actions that are done, closed under what comes
//! before, and a set of actions under way, each of which could begin. [`partial_order`] goes through all such pairs:
//!
//! - each action is legal out of each set of done actions that it can meet, and leads to the same state whatever the
//!   order, by the definitions of the replay;
//! - what is on its way hits nothing that rests, by its sweep, and nothing that moves as well, by a proof for all
//!   combinations of their phases (`lattice`, `linkage`);
//! - the oracle proves the margin at rest and on the way, for moves under way at once on the product of their
//!   phases (`product`), sampled and refined around the worst as a single move is: nothing is proved between samples.
//!   Contact between what moves by itself and what moves by itself is left out, which never flatters;
//! - attaching and detaching need no states of their own: while connections are being released no state is worse
//!   than with all of them open, while they are being engaged none is worse than before (statics: monotony).
//!
//! There may be exponentially many such moments, so the order grows from the plan's own sequence (`growth`,
//! `meeting`): each action is let go as early as everything that this newly allows can be checked, and waits
//! otherwise. What that takes of a robot is a `family`: modules in a lattice are one, linkages another. Knows no search.

mod asked;
mod family;
mod groups;
mod growth;
mod lattice;
pub(super) mod linkage;
mod meeting;
mod precedence;
mod product;
#[cfg(test)]
mod random_runs;
#[cfg(test)]
mod tests;
mod timetable;

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use petgraph::graph::{DiGraph, NodeIndex};

use crate::robot::Configuration;
use crate::statics::Bracket;

use super::assembly::Touched;
use super::plan::Plan;
use super::refusal::Refusal;
use super::replay::Fault;
use growth::{Growth, least};
use lattice::Lattice;
pub use timetable::Timetable;

/// What may overlap and what may be spent on finding out.
#[derive(Clone, Debug)]
pub struct OrderOptions {
    /// Margin that every state must have.
    pub required: f64,
    /// How many moves may be under way at once.
    pub most_at_once: usize,
    /// How many sets of done actions the order may allow.
    pub max_states: usize,
    /// When to stop: the actions not yet looked at then keep the plan's order. The plan itself is always checked.
    pub deadline: Option<Instant>,
    /// Set it from any thread to stop likewise.
    pub cancel: Option<Arc<AtomicBool>>,
}

impl Default for OrderOptions {
    fn default() -> Self {
        Self { required: 0.0, most_at_once: 2, max_states: 4096, deadline: None, cancel: None }
    }
}

impl OrderOptions {
    fn is_over(&self) -> bool {
        self.deadline.is_some_and(|deadline| Instant::now() >= deadline)
            || self.cancel.as_ref().is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }
}

/// Why an action waits for another; `T` is what a module hits.
#[derive(Clone, Debug, PartialEq)]
pub enum Because<T = Touched> {
    /// Both concern a module that one of them moves.
    SameModule,
    /// Without it the action, or one that comes before it in the plan, is not legal.
    NotLegal(Fault<T>),
    /// Both turn the same joint, or concern the same connection.
    SameJoint,
    /// In the other order the robot would end up connected in another way.
    OtherState,
    /// In the other order modules would end up elsewhere in the world.
    OtherPlaces,
    /// What the two move could hit each other, or something else, on their ways.
    WaysCross,
    /// One module moves along the other.
    HoldsTheOther,
    /// Each would carry a part of what the other moves or turns on, neither all of it.
    Entangled,
    /// The robot would fall apart.
    Disconnected,
    /// The margin would be too small.
    Unstable,
    /// What overlapping would allow was not checked: too many modules at once, too many states, or no time left.
    NotChecked,
}

impl<T: fmt::Display> fmt::Display for Because<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SameModule => f.write_str("same module"),
            Self::NotLegal(fault) => write!(f, "else {fault}"),
            Self::SameJoint => f.write_str("same joint or connection"),
            Self::OtherPlaces => f.write_str("else modules end up elsewhere"),
            Self::Entangled => f.write_str("each carries a part of what the other moves"),
            Self::OtherState => f.write_str("else the connections differ"),
            Self::WaysCross => f.write_str("their ways cross"),
            Self::HoldsTheOther => f.write_str("one moves along the other"),
            Self::Disconnected => f.write_str("else the robot falls apart"),
            Self::Unstable => f.write_str("else the margin is too small"),
            Self::NotChecked => f.write_str("not checked"),
        }
    }
}

/// What was gone through.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Checked {
    /// Sets of done actions that the order allows, runs of attaching or of detaching taken as one.
    pub states: u64,
    /// Sets of actions under way, in each such state, of which at least two are moves.
    pub overlaps: u64,
    /// States and sets under way that monotony leaves no need to ask about.
    pub by_monotony: u64,
    /// Structures that the oracle assessed.
    pub oracle_solves: u64,
}

/// Which actions of a plan have to wait for which others.
#[derive(Clone, Debug)]
pub struct PartialOrder<T = Touched> {
    /// Node i is action i of the plan. An arrow leads from an action to one that must wait until it has ended; arrows
    /// that follow from others are left out.
    pub graph: DiGraph<(), Because<T>>,
    /// Smallest margin over all states that were asked about.
    pub margin: Bracket,
    /// What was gone through.
    pub checked: Checked,
    /// Whether every action was looked at; `false` where a deadline or a cancellation left the plan's order.
    pub is_complete: bool,
}

/// Why a plan has no partial order.
#[derive(Clone, Debug, PartialEq)]
pub enum OrderError<T = Touched> {
    /// The oracle cannot assess the robot.
    Refused(Refusal),
    /// The plan does not even hold in its own order.
    Broken {
        /// The action; `None` for the start.
        action: Option<usize>,
        /// What is wrong.
        because: Because<T>,
    },
}

impl<T: fmt::Display> fmt::Display for OrderError<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(refusal) => refusal.fmt(f),
            Self::Broken { action: None, because } => write!(f, "the start does not hold: {because}"),
            Self::Broken { action: Some(action), because } => {
                write!(f, "action {} does not hold in the plan's own order: {because}", action + 1)
            }
        }
    }
}

impl<T: fmt::Debug + fmt::Display> std::error::Error for OrderError<T> {}

impl<T> From<Refusal> for OrderError<T> {
    fn from(refusal: Refusal) -> Self {
        Self::Refused(refusal)
    }
}

/// The partial order of a plan that leads somewhere from `start`, which must be sound.
///
/// # Guarantees
/// See the [module](self). The result does not depend on the number of threads, nor on time unless a deadline or a
/// cancellation ended the work early; what it allows is checked then as well.
///
/// # Errors
/// [`OrderError::Broken`] for a plan that does not hold in its own order.
pub fn partial_order(start: &Configuration, plan: &Plan, options: &OrderOptions) -> Result<PartialOrder, OrderError> {
    Growth::new(Lattice::new(start, least(options.required)), plan, options).grown()
}

impl<T> PartialOrder<T> {
    /// The actions that one waits for, ascending.
    pub fn waits_for(&self, action: usize) -> Vec<usize> {
        let mut before: Vec<usize> = self
            .graph
            .neighbors_directed(NodeIndex::new(action), petgraph::Direction::Incoming)
            .map(NodeIndex::index)
            .collect();
        before.sort_unstable();
        before
    }

    /// The actions in waves: each as early as the length of the longest chain of actions before it allows.
    pub fn waves(&self) -> Vec<Vec<usize>> {
        let mut waves: Vec<Vec<usize>> = Vec::new();
        let mut wave_of = Vec::with_capacity(self.graph.node_count());
        for action in 0..self.graph.node_count() {
            // Arrows lead from earlier actions of the plan to later ones.
            let wave = self.waits_for(action).iter().map(|&before: &usize| wave_of[before] + 1).max().unwrap_or(0);
            wave_of.push(wave);
            if wave == waves.len() {
                waves.push(Vec::new());
            }
            waves[wave].push(action);
        }
        waves
    }

    /// When each action runs if all begin as early as they may, by how long each one takes, in any unit, not negative.
    pub fn timetable(&self, duration: impl Fn(usize) -> f64) -> Timetable {
        Timetable::new(self.graph.node_count(), |action| self.waits_for(action), duration)
    }
}
