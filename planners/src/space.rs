//! What a search needs from its domain. It does not know what a state is.

use std::hash::Hash;

use crate::lattice::Displacement;

/// An interval that holds a transition's width, both ends included.
///
/// `NEG_INFINITY` at the upper end means that the transition is impossible at
/// any demand. Searches rank by `lower` and prove with `upper`. What a domain
/// returns is made safe before use: a NaN end becomes the infinite end that
/// claims nothing, crossed ends are swapped, and both are cut to the
/// transition's [`width_at_most`](Transition::width_at_most).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Width {
    /// Proved lower bound.
    pub lower: f64,
    /// Proved upper bound.
    pub upper: f64,
}

impl Width {
    /// A width that is known exactly.
    pub fn exact(width: f64) -> Self {
        Width { lower: width, upper: width }
    }

    /// Width of the path of no transitions: nothing narrows it.
    pub const UNLIMITED: Width = Width { lower: f64::INFINITY, upper: f64::INFINITY };

    /// Width of this and `next` in series: the smaller of each end.
    pub fn in_series(self, next: Width) -> Width {
        Width { lower: self.lower.min(next.lower), upper: self.upper.min(next.upper) }
    }
}

/// A transition out of a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Transition<S, A> {
    /// What is done.
    pub action: A,
    /// The state that it leads to.
    pub to: S,
    /// Its cost; transitions of cost 0 are allowed. The cost of a whole path
    /// must stay below `u32::MAX`, where sums saturate.
    pub cost: u32,
    /// Cheap upper bound on its width, `INFINITY` when nothing is known.
    /// The tighter it is, the fewer transitions are certified.
    pub width_at_most: f64,
}

/// An implicit weighted graph with expensive widths.
///
/// All methods must be pure: the same arguments give the same answer, in the
/// same order, on every thread. The engines call them from one thread; a domain
/// that wants parallelism uses threads inside [`certify`](Space::certify).
///
/// An engine keeps the transitions of every state that it expands, and their
/// certified widths, so a domain needs no cache against repeated calls: for one
/// state `transitions` is called at most once, and `certify` or `decide` is called again
/// for one transition only if an early stop left it undecided at another `floor`.
pub trait Space: Sync {
    /// A node. Equal states are the same node.
    type State: Clone + Eq + Hash + Send + Sync;
    /// What a transition does, for the plan.
    type Action: Clone + Send + Sync;

    /// Where the search begins. Whether it is admissible is the caller's
    /// concern: the path of no transitions has infinite width.
    fn start(&self) -> Self::State;

    /// Whether a state is a goal. Paths end at the first goal that they meet.
    fn is_goal(&self, state: &Self::State) -> bool;

    /// Transitions out of a state, in a fixed order, which breaks ties.
    fn transitions(&self, from: &Self::State) -> Vec<Transition<Self::State, Self::Action>>;

    /// Certifies the width of a transition. Below `floor` it may stop as soon
    /// as `upper < floor` is proved; at or above it the interval is as tight as
    /// the domain can make it. `floor` is `NEG_INFINITY` when any width is of use.
    fn certify(&self, from: &Self::State, action: &Self::Action, to: &Self::State, floor: f64) -> Width;

    /// Whether the width of a transition is at least `floor`: like [`certify`](Space::certify), but at or above the floor
    /// too it may stop as soon as that is proved. What can be decided neither way is as tight as the domain can
    /// make it. `None` where that would be no cheaper than to certify. No search orders by what it returns.
    fn decide(&self, from: &Self::State, action: &Self::Action, to: &Self::State, floor: f64) -> Option<Width> {
        let _ = (from, action, to, floor);
        None
    }

    /// Upper bound on the width of a transition by a look that takes much less than to decide it, `INFINITY` where that shows
    /// nothing. It is of use where it is below `floor`. `None` where nothing is that much cheaper. Searches take a transition for wide enough
    /// that a glance does not rule out, until something depends on it.
    fn glance(&self, from: &Self::State, action: &Self::Action, to: &Self::State, floor: f64) -> Option<f64> {
        let _ = (from, action, to, floor);
        None
    }

    /// Admissible lower bound on the cost from `state` to a goal; `None` when
    /// it is proved that no goal can be reached from it. It may be
    /// inconsistent. At a goal it is taken to be 0 without asking.
    fn remaining_cost(&self, state: &Self::State) -> Option<u32>;

    /// Proved upper bound on the width of any path from start to goal.
    fn width_at_most(&self) -> f64 {
        f64::INFINITY
    }

    /// Approximate heap memory that `state` owns beyond its `size_of`, in
    /// bytes, for the memory limit.
    fn heap_bytes(&self, state: &Self::State) -> usize {
        let _ = state;
        0
    }

    /// Approximate memory of what the space remembers of earlier answers, in bytes, for the memory limit.
    fn memory_bytes(&self) -> usize {
        0
    }
}

/// A space that can be searched from its goals as well: they are known, and so are the transitions into a state.
pub trait Reversible: Space {
    /// Every goal that may be reached, in a fixed order, each once.
    fn goals(&self) -> Vec<Self::State>;

    /// Transitions into a state, in a fixed order: those that [`Space::transitions`] gives for the state that each
    /// of them names in `to`, which here is where it comes **from**. The action is what leads from there to
    /// `state`, and is certified as such; it may be another value for the same transition than `transitions` gives.
    fn transitions_into(&self, state: &Self::State) -> Vec<Transition<Self::State, Self::Action>>;

    /// Admissible lower bound on the cost from the start to `state`; `None` when it is proved that it cannot be
    /// reached. It may be inconsistent.
    fn spent_cost(&self, state: &Self::State) -> Option<u32> {
        let _ = state;
        Some(0)
    }
}

/// A space that looks the same from many states, up to a displacement: the ground on which something moves is flat and endless,
/// say, and only the goal is somewhere.
///
/// Let the transitions of the space be those between states that are no goals. If `class(s)` is `(r, d)`, then `r` is no
/// goal, `class(r)` is `(r, 0)`, and to every transition between `s` and a state of class `(r', d')` belongs one between
/// `r` and a state of class `(r', d' - d)`, in the same direction and of the same width. And every transition between two
/// of these states can be taken back by one of the same width.
pub trait Periodic: Reversible {
    /// The state that represents a state's class, and the displacement from it. The state is no goal.
    fn class(&self, state: &Self::State) -> (Self::State, Displacement);

    /// Like the state that [`class`](Periodic::class) gives, of classes that may be larger: those of states that symmetries other than
    /// displacements exchange. What is said there about transitions holds without the displacements.
    fn kind(&self, state: &Self::State) -> Self::State {
        self.class(state).0
    }
}
