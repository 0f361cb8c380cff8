//! The part of the implicit graph that has been explored: states, transitions
//! of the expanded ones, and certified widths. It does not know any search.

use crate::registry::{Registry, StateId};
use crate::search::is_wide_enough;
use crate::space::{Reversible, Space, Transition, Width};

/// Number of the start.
pub(crate) const START: StateId = 0;

/// Cost to a goal of a state that cannot reach one.
pub(crate) const DEAD_END: u32 = u32::MAX;

/// From which end of a path states are looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// From the start, along transitions.
    Start,
    /// From the goals, against transitions.
    Goal,
}

/// A transition, by its source and its place among the source's transitions; looked at from the goals, by its
/// target and its place among the transitions into that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Arrow {
    pub from: StateId,
    pub index: u32,
}

/// What is known of a transition.
pub(crate) struct Edge<A> {
    pub action: A,
    /// Where it leads to; from where it comes, looked at from the goals.
    pub to: StateId,
    pub cost: u32,
    /// Holds the width; before certification `[-inf, cheap bound]`.
    pub width: Width,
    /// The interval is as tight as the domain can make it.
    tight: bool,
    /// The largest floor at which a glance did not rule it out.
    glanced: f64,
}

/// What a glance at a transition tells of it, for some floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Glance {
    /// It is wide enough.
    Wide,
    /// It is not.
    Narrow,
    /// It has not been asked, but it may be.
    Presumed,
    /// It has been asked, and cannot be told from the floor.
    Undecided,
}

impl<A> Edge<A> {
    fn new(action: A, to: StateId, cost: u32, width_at_most: f64) -> Self {
        let width = Width { lower: f64::NEG_INFINITY, upper: upper_or_unknown(width_at_most) };
        Edge { action, to, cost, width, tight: false, glanced: f64::NEG_INFINITY }
    }

    /// Whether nothing is left to certify at `floor`.
    fn is_certified(&self, floor: f64) -> bool {
        self.tight || self.width.upper < floor
    }

    /// Whether it is known to be wide enough, or not, or all that can be known.
    fn is_decided(&self, floor: f64) -> bool {
        self.is_certified(floor) || is_wide_enough(self.width.lower, floor)
    }

    /// Books an answer to a question about `floor`.
    fn learn(&mut self, answer: Width, floor: f64, is_decision: bool) {
        let Width { lower, upper } = trusted(answer, self.width.upper);
        // What was proved before stays.
        self.width = Width { lower: lower.max(self.width.lower).min(upper), upper };
        let is_wide = is_decision && is_wide_enough(self.width.lower, floor);
        let stopped = upper < floor || (is_wide && self.width.lower < upper);
        self.tight = !stopped;
    }
}

/// Transitions out of a state, or into it, once it is expanded.
type Edges<A> = Option<Box<[Edge<A>]>>;

/// The explored part of a space.
pub(crate) struct Graph<'a, S: Space> {
    space: &'a S,
    registry: Registry<S::State>,
    is_goal: Vec<bool>,
    remaining: Vec<u32>,
    edges: Vec<Edges<S::Action>>,
    /// Transitions into states; empty unless the search is from both ends.
    edges_into: Vec<Edges<S::Action>>,
    heap_bytes: usize,
    pub generated: u64,
    pub certified: u64,
}

impl<'a, S: Space> Graph<'a, S> {
    pub fn new(space: &'a S) -> Self {
        let mut graph = Graph {
            space,
            registry: Registry::new(),
            is_goal: Vec::new(),
            remaining: Vec::new(),
            edges: Vec::new(),
            edges_into: Vec::new(),
            heap_bytes: 0,
            generated: 0,
            certified: 0,
        };
        graph.intern(space.start());
        graph
    }

    pub fn space(&self) -> &'a S {
        self.space
    }

    pub fn state(&self, id: StateId) -> &S::State {
        self.registry.state(id)
    }

    pub fn is_goal(&self, id: StateId) -> bool {
        self.is_goal[id as usize]
    }

    /// Admissible lower bound on the cost to a goal, or [`DEAD_END`].
    pub fn remaining(&self, id: StateId) -> u32 {
        self.remaining[id as usize]
    }

    /// Upper bound on the width of any path, `INFINITY` when nothing is known.
    pub fn cap(&self) -> f64 {
        upper_or_unknown(self.space.width_at_most())
    }

    pub fn edge(&self, arrow: Arrow) -> &Edge<S::Action> {
        self.edge_seen_from(End::Start, arrow)
    }

    pub fn edge_seen_from(&self, end: End, arrow: Arrow) -> &Edge<S::Action> {
        &self.seen_from(end, arrow.from)[arrow.index as usize]
    }

    /// Transitions out of a state that has been expanded, or into it.
    pub fn seen_from(&self, end: End, id: StateId) -> &[Edge<S::Action>] {
        let edges = if end == End::Start { &self.edges } else { &self.edges_into };
        edges[id as usize].as_ref().expect("arrows leave expanded states")
    }

    /// Transitions out of a state that has been expanded.
    pub fn successors(&self, from: StateId) -> &[Edge<S::Action>] {
        self.seen_from(End::Start, from)
    }

    /// Transitions out of a state, none if it has not been expanded.
    pub fn known_successors(&self, from: StateId) -> &[Edge<S::Action>] {
        self.edges[from as usize].as_deref().unwrap_or_default()
    }

    /// Upper bounds on the widths of all transitions that are known.
    pub fn known_widths(&self) -> impl Iterator<Item = f64> {
        self.edges.iter().flatten().flatten().map(|edge| edge.width.upper)
    }

    /// Generates the transitions out of a state, once.
    pub fn expand(&mut self, from: StateId) {
        if self.edges[from as usize].is_none() {
            let transitions = self.space.transitions(self.registry.state(from));
            let edges = self.interned(transitions);
            self.edges[from as usize] = Some(edges);
        }
    }

    fn interned(&mut self, transitions: Vec<Transition<S::State, S::Action>>) -> Box<[Edge<S::Action>]> {
        let intern = |transition: Transition<S::State, S::Action>| {
            let Transition { action, to, cost, width_at_most } = transition;
            Edge::new(action, self.intern(to), cost, width_at_most)
        };
        let edges: Box<[_]> = transitions.into_iter().map(intern).collect();
        self.generated += edges.len() as u64;
        self.heap_bytes += size_of_val(&*edges);
        edges
    }

    /// Width of a transition, good enough to compare with `floor`.
    pub fn certify(&mut self, arrow: Arrow, floor: f64) -> Width {
        self.ask(End::Start, arrow, floor, false)
    }

    /// Bounds on the width of a transition, on one side of `floor` if that can be told.
    pub fn decide(&mut self, end: End, arrow: Arrow, floor: f64) -> Width {
        self.ask(end, arrow, floor, true)
    }

    /// Whether a transition may be wide enough, by no more than a glance where the domain is quicker with that.
    pub fn glance(&mut self, end: End, arrow: Arrow, floor: f64) -> Glance {
        let edge = self.edge_seen_from(end, arrow);
        if !edge.is_decided(floor) && edge.glanced < floor {
            let (from, to) = self.between(end, arrow.from, edge.to);
            match self.space.glance(from, &edge.action, to, floor) {
                Some(upper) => {
                    let edge = self.edge_mut(end, arrow);
                    edge.glanced = floor;
                    edge.width.upper = edge.width.upper.min(upper_or_unknown(upper));
                    edge.width.lower = edge.width.lower.min(edge.width.upper);
                }
                None => {
                    self.decide(end, arrow, floor);
                }
            }
        }
        let edge = self.edge_seen_from(end, arrow);
        if is_wide_enough(edge.width.lower, floor) {
            Glance::Wide
        } else if !is_wide_enough(edge.width.upper, floor) {
            Glance::Narrow
        } else if edge.is_decided(floor) {
            Glance::Undecided
        } else {
            Glance::Presumed
        }
    }

    /// Width of a transition, as tight as it can be.
    pub fn tighten(&mut self, end: End, arrow: Arrow) -> Width {
        self.ask(end, arrow, f64::NEG_INFINITY, false)
    }

    fn ask(&mut self, end: End, arrow: Arrow, floor: f64, has_decided_only: bool) -> Width {
        let edge = self.edge_seen_from(end, arrow);
        let is_known = if has_decided_only { edge.is_decided(floor) } else { edge.is_certified(floor) };
        if is_known {
            return edge.width;
        }
        let (from, to) = self.between(end, arrow.from, edge.to);
        let decided = if has_decided_only { self.space.decide(from, &edge.action, to, floor) } else { None };
        let is_decision = decided.is_some();
        let answer = decided.unwrap_or_else(|| self.space.certify(from, &edge.action, to, floor));
        self.certified += 1;
        let edge = self.edge_mut(end, arrow);
        edge.learn(answer, floor, is_decision);
        edge.width
    }

    /// Where a transition comes from and where it leads to, by the ends of its arrow seen from an end.
    fn between(&self, end: End, near: StateId, far: StateId) -> (&S::State, &S::State) {
        let [near, far] = [near, far].map(|id| self.registry.state(id));
        if end == End::Start { (near, far) } else { (far, near) }
    }

    fn edge_mut(&mut self, end: End, arrow: Arrow) -> &mut Edge<S::Action> {
        let edges = if end == End::Start { &mut self.edges } else { &mut self.edges_into };
        let edges = edges[arrow.from as usize].as_mut().expect("arrows leave expanded states");
        &mut edges[arrow.index as usize]
    }

    /// Whether the transitions seen from a state are known.
    pub fn is_expanded(&self, end: End, id: StateId) -> bool {
        let edges = if end == End::Start { &self.edges } else { &self.edges_into };
        edges.get(id as usize).is_some_and(Option::is_some)
    }

    pub fn states(&self) -> usize {
        self.registry.len()
    }

    /// Approximate memory, in bytes.
    pub fn bytes(&self) -> usize {
        let columns = size_of::<bool>() + size_of::<u32>() + size_of::<Edges<S::Action>>();
        let into = self.edges_into.len() * size_of::<Edges<S::Action>>();
        self.heap_bytes + into + self.states() * (Registry::<S::State>::bytes_per_state() + columns)
    }

    /// The number of a state, new or not.
    pub fn intern(&mut self, state: S::State) -> StateId {
        let (id, is_new) = self.registry.insert(state);
        if is_new {
            let state = self.registry.state(id);
            let is_goal = self.space.is_goal(state);
            let remaining = if is_goal { 0 } else { self.space.remaining_cost(state).unwrap_or(DEAD_END) };
            self.heap_bytes += self.space.heap_bytes(state);
            self.is_goal.push(is_goal);
            self.remaining.push(remaining);
            self.edges.push(None);
        }
        id
    }
}

impl<S: Reversible> Graph<'_, S> {
    /// Generates the transitions into a state, once.
    pub fn expand_into(&mut self, to: StateId) {
        self.edges_into.resize_with(self.edges.len(), || None);
        if self.edges_into[to as usize].is_none() {
            let transitions = self.space.transitions_into(self.registry.state(to));
            let edges = self.interned(transitions);
            self.edges_into.resize_with(self.edges.len(), || None);
            self.edges_into[to as usize] = Some(edges);
        }
    }

    /// Admissible lower bound on the cost from the start, or [`DEAD_END`].
    pub fn spent(&self, id: StateId) -> u32 {
        if id == START { 0 } else { self.space.spent_cost(self.state(id)).unwrap_or(DEAD_END) }
    }
}

/// An upper bound, where NaN claims nothing.
fn upper_or_unknown(width: f64) -> f64 {
    if width.is_nan() { f64::INFINITY } else { width }
}

/// An interval whose ends are in order, numbers, and at most `bound`.
///
/// Rounding may cross the ends or lift them over an earlier bound. The smaller
/// end then counts as the lower one: a search may lose a path to rounding, but
/// must never promise a width that was not proved.
pub(crate) fn trusted(width: Width, bound: f64) -> Width {
    let lower = if width.lower.is_nan() { f64::NEG_INFINITY } else { width.lower };
    let upper = upper_or_unknown(width.upper);
    Width { lower: lower.min(upper).min(bound), upper: upper.max(lower).min(bound) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_made_safe() {
        let infinity = f64::INFINITY;
        let width = |lower, upper| Width { lower, upper };
        assert_eq!(trusted(width(1.0, 2.0), infinity), width(1.0, 2.0));
        assert_eq!(trusted(width(2.0, 1.0), infinity), width(1.0, 2.0), "crossed");
        assert_eq!(trusted(width(1.0, 3.0), 2.0), width(1.0, 2.0), "cut");
        assert_eq!(trusted(width(2.5, 3.0), 2.0), width(2.0, 2.0), "cut on both sides");
        assert_eq!(trusted(width(f64::NAN, 3.0), infinity), width(-infinity, 3.0));
        assert_eq!(trusted(width(1.0, f64::NAN), infinity), width(1.0, infinity));
    }
}
