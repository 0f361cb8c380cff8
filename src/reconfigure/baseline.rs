//! The cheapest planners that one could think of, for comparison: what lazy evaluation and estimates save.
//!
//! Knows no robots: each takes something from a search space.

use planners::{Space, Transition, Width};

/// A planner that goes without something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Baseline {
    /// Every successor is evaluated when it is generated, by cold solves for the margins of all its transient states, and
    /// nothing is remembered of the answers. The search comes from the start only, and is after the best plan at once.
    Eager,
    /// Nothing is known of how far it is to the goal. The search comes from the start only, and is after the best plan at once.
    Blind,
}

/// A space whose transitions are all certified when they are generated.
pub struct Eager<'s, S>(pub &'s S);

impl<S: Space> Space for Eager<'_, S> {
    type State = S::State;
    /// With the width that it was found to have.
    type Action = (S::Action, [f64; 2]);

    fn start(&self) -> S::State {
        self.0.start()
    }

    fn is_goal(&self, state: &S::State) -> bool {
        self.0.is_goal(state)
    }

    fn transitions(&self, from: &S::State) -> Vec<Transition<S::State, Self::Action>> {
        let certified = |transition: Transition<S::State, S::Action>| {
            let Transition { action, to, cost, width_at_most } = transition;
            let Width { lower, upper } = self.0.certify(from, &action, &to, f64::NEG_INFINITY);
            let upper = upper.min(width_at_most);
            Transition { action: (action, [lower.min(upper), upper]), to, cost, width_at_most: upper }
        };
        self.0.transitions(from).into_iter().map(certified).collect()
    }

    fn certify(&self, _: &S::State, action: &Self::Action, _: &S::State, _: f64) -> Width {
        let (_, [lower, upper]) = *action;
        Width { lower, upper }
    }

    fn remaining_cost(&self, state: &S::State) -> Option<u32> {
        self.0.remaining_cost(state)
    }

    fn width_at_most(&self) -> f64 {
        self.0.width_at_most()
    }

    fn heap_bytes(&self, state: &S::State) -> usize {
        self.0.heap_bytes(state)
    }

    fn memory_bytes(&self) -> usize {
        self.0.memory_bytes()
    }
}

/// A space without estimates.
pub struct Blind<'s, S>(pub &'s S);

impl<S: Space> Space for Blind<'_, S> {
    type State = S::State;
    type Action = S::Action;

    fn start(&self) -> S::State {
        self.0.start()
    }

    fn is_goal(&self, state: &S::State) -> bool {
        self.0.is_goal(state)
    }

    fn transitions(&self, from: &S::State) -> Vec<Transition<S::State, S::Action>> {
        self.0.transitions(from)
    }

    fn certify(&self, from: &S::State, action: &S::Action, to: &S::State, floor: f64) -> Width {
        self.0.certify(from, action, to, floor)
    }

    fn decide(&self, from: &S::State, action: &S::Action, to: &S::State, floor: f64) -> Option<Width> {
        self.0.decide(from, action, to, floor)
    }

    fn remaining_cost(&self, _: &S::State) -> Option<u32> {
        Some(0)
    }

    fn width_at_most(&self) -> f64 {
        self.0.width_at_most()
    }

    fn heap_bytes(&self, state: &S::State) -> usize {
        self.0.heap_bytes(state)
    }

    fn memory_bytes(&self) -> usize {
        self.0.memory_bytes()
    }
}
