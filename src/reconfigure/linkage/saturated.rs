//! The default search space of linkages: arrangements with every possible connection engaged.
//!
//! As for lattices, more connections never lower the margin, so between moves it is never worse to have all engaged. A
//! transition is one move with the detachments that it needs before it and all attachments after it; of the
//! detachments only the last state can be the worst, which is the move's first phase, and of the attachments none is
//! worse than the move's last. The goal's own connections are reached by a last transition without cost.
//!
//! Every move can be taken back through the same states.

use planners::{Reversible, Space, Transition, Width};

use super::arrangement::Arrangement;
use super::domain::{Domain, framed, width};

/// An arrangement, all connections engaged; or the goal with its own connections.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State {
    /// Where the modules are.
    pub arrangement: Arrangement,
    arrived: bool,
}

/// A transition.
#[derive(Clone, Debug, PartialEq)]
pub struct Action {
    /// The state that it leads to.
    pub to: State,
    way: Way,
}

impl Action {
    /// Whether it leads to the goal's own connections and moves nothing.
    pub fn is_arrival(&self) -> bool {
        self.way == Way::Finish
    }
}

#[derive(Clone, Debug, PartialEq)]
enum Way {
    /// A move out of the state that the transition starts from.
    Forwards(usize),
    /// A move out of the state that it leads to, taken back.
    Backwards(usize),
    /// The attachments and detachments that lead to the goal's own connections.
    Finish,
}

/// The space of a domain.
pub struct Saturated<'a> {
    domain: &'a Domain<'a>,
    start: Arrangement,
    /// Margin of the start with its own connections: no path is wider.
    width: Width,
    /// No path is wider.
    at_most: f64,
}

impl<'a> Saturated<'a> {
    /// The space of a domain whose start has this margin and whose paths are no wider than `at_most`.
    pub fn new(domain: &'a Domain<'a>, width: Width, at_most: f64) -> Self {
        let start = domain.arrangements.of(&domain.problem.described(&domain.problem.start)).arrangement;
        Self { domain, start, width, at_most }
    }

    /// The state of an arrangement on the way.
    pub fn state(arrangement: Arrangement) -> State {
        State { arrangement, arrived: false }
    }

    fn finish(&self) -> Transition<State, Action> {
        let to = State { arrangement: self.domain.goal.arrangement.clone(), arrived: true };
        Transition { action: Action { to: to.clone(), way: Way::Finish }, to, cost: 0, width_at_most: self.at_most }
    }

    /// The moves out of an arrangement, each with the number of its step and what it leads to.
    fn neighbours(&self, from: &Arrangement) -> impl Iterator<Item = (usize, Arrangement)> {
        let moves = self.domain.moves(from);
        let from = from.clone();
        (0..moves.steps.len()).filter_map(move |index| {
            let after = moves.view.after(&moves.steps[index]);
            let to = self.domain.arrangements.of(&after).arrangement;
            (to != from).then_some((index, to))
        })
    }

    /// Width of a move out of `from` with the detachments before it.
    fn of_move(&self, from: &Arrangement, index: usize, to: &Arrangement, floor: f64) -> Width {
        let impossible = Width::exact(f64::NEG_INFINITY);
        let moves = self.domain.moves(from);
        let (view, step) = (&moves.view, &moves.steps[index]);
        if !self.domain.is_free(view, step) {
            return impossible;
        }
        if !self.domain.stability {
            return Width::UNLIMITED;
        }
        if floor > f64::NEG_INFINITY {
            // With less engaged, as the move begins and ends, margins are no larger.
            for end in [from, to] {
                let settled = self.domain.settled(end);
                if settled.upper < floor {
                    return Width { lower: f64::NEG_INFINITY, upper: settled.upper };
                }
            }
        }
        width(self.domain.of_move(view, step, floor).margin)
    }
}

impl Space for Saturated<'_> {
    type State = State;
    type Action = Action;

    fn start(&self) -> State {
        Self::state(self.start.clone())
    }

    fn is_goal(&self, state: &State) -> bool {
        state.arrived
    }

    fn transitions(&self, from: &State) -> Vec<Transition<State, Action>> {
        if from.arrived {
            return Vec::new();
        }
        let finish = (from.arrangement == self.domain.goal.arrangement).then(|| self.finish());
        let moves = self.neighbours(&from.arrangement).map(|(index, to)| {
            let to = Self::state(to);
            let action = Action { to: to.clone(), way: Way::Forwards(index) };
            Transition { action, to, cost: 1, width_at_most: self.at_most }
        });
        finish.into_iter().chain(moves).collect()
    }

    fn certify(&self, from: &State, action: &Action, to: &State, floor: f64) -> Width {
        let found = match action.way {
            Way::Forwards(index) => self.of_move(&from.arrangement, index, &to.arrangement, floor),
            Way::Backwards(index) => self.of_move(&to.arrangement, index, &from.arrangement, floor),
            Way::Finish if !self.domain.stability => Width::UNLIMITED,
            Way::Finish => {
                let view = self.domain.saturated(&from.arrangement);
                match self.domain.goal.connections(&view, &framed(&from.arrangement)) {
                    Some(engaged) => width(self.domain.of_state(&view, &engaged).margin),
                    None => Width::exact(f64::NEG_INFINITY),
                }
            }
        };
        found.in_series(self.width)
    }

    fn remaining_cost(&self, _: &State) -> Option<u32> {
        Some(0)
    }

    fn width_at_most(&self) -> f64 {
        self.at_most
    }

    fn heap_bytes(&self, state: &State) -> usize {
        size_of_val(&*state.arrangement.0)
    }

    fn memory_bytes(&self) -> usize {
        self.domain.memory_bytes()
    }
}

impl Reversible for Saturated<'_> {
    fn goals(&self) -> Vec<State> {
        vec![self.finish().to]
    }

    fn transitions_into(&self, to: &State) -> Vec<Transition<State, Action>> {
        if to.arrived {
            let from = Self::state(to.arrangement.clone());
            return vec![Transition { to: from, ..self.finish() }];
        }
        let moves = self.neighbours(&to.arrangement).map(|(index, from)| {
            let action = Action { to: to.clone(), way: Way::Backwards(index) };
            Transition { action, to: Self::state(from), cost: 1, width_at_most: self.at_most }
        });
        moves.collect()
    }
}
