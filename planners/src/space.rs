//! What a search needs from its domain.

use std::hash::Hash;

/// An interval that holds a transition's width, both ends included.
/// `NEG_INFINITY` means the transition is impossible at any demand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Width {
    /// Proved lower bound.
    pub lower: f64,
    /// Proved upper bound.
    pub upper: f64,
}

/// A transition out of a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition<S, A> {
    /// What is done.
    pub action: A,
    /// The state that it leads to.
    pub to: S,
    /// Its cost; transitions of cost 0 are allowed.
    pub cost: u32,
    /// Cheap upper bound on its width, `INFINITY` when nothing is known.
    pub width_at_most: f64,
}

/// An implicit weighted graph with expensive widths.
///
/// All methods must be pure: the same arguments give the same answer, in the
/// same order, on every thread.
pub trait Space: Sync {
    /// A node. Equal states are the same node.
    type State: Clone + Eq + Hash + Send + Sync;
    /// What a transition does, for the plan.
    type Action: Clone + Send + Sync;

    /// Where the search begins.
    fn start(&self) -> Self::State;

    /// Whether a state is a goal.
    fn is_goal(&self, state: &Self::State) -> bool;

    /// Transitions out of a state, in a fixed order.
    fn transitions(&self, from: &Self::State) -> Vec<Transition<Self::State, Self::Action>>;

    /// Certifies the width of a transition. Below `floor` it may stop as soon
    /// as `upper < floor` is proved; at or above it the interval is as tight as
    /// the domain can make it.
    fn certify(&self, from: &Self::State, action: &Self::Action, to: &Self::State, floor: f64) -> Width;

    /// Admissible lower bound on the cost from `state` to a goal; `None` when
    /// it is proved that no goal can be reached from it.
    fn remaining_cost(&self, state: &Self::State) -> Option<u32>;

    /// Proved upper bound on the width of any path from start to goal.
    fn width_at_most(&self) -> f64 {
        f64::INFINITY
    }
}
