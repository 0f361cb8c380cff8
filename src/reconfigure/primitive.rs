//! The reference search space: placements and engaged connections, with attach,
//! detach and move as transitions of their own.
//!
//! It takes nothing from monotony, and so is what the saturated space is
//! tested against. Its states grow with 2 to the power of the touching faces.

use std::sync::Arc;

use planners::{Space, Transition, Width};

use super::domain::{Domain, bonds_after, width};
use super::layout::{Bond, Layout};
use super::step::Step;

/// Placements and engaged connections, ascending.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State {
    layout: Layout,
    bonds: Arc<[Bond]>,
}

/// The space of a domain.
pub struct Primitive<'a> {
    domain: &'a Domain<'a>,
    start: Width,
    at_most: f64,
}

impl<'a> Primitive<'a> {
    /// The space of a domain whose start has this margin and whose paths are no
    /// wider than `at_most`.
    pub fn new(domain: &'a Domain<'a>, start: Width, at_most: f64) -> Self {
        Self { domain, start, at_most }
    }

    /// The transition of a step, if the robot stays connected.
    fn transition(&self, from: &State, step: Step) -> Option<Transition<State, Step>> {
        let State { layout, bonds } = from;
        let others = |left_out| bonds.iter().copied().filter(move |&bond| bond != left_out);
        let (layout, bonds, cost): (_, Vec<Bond>, _) = match step {
            Step::Attach(bond) => {
                let mut bonds: Vec<Bond> = others(bond).chain([bond]).collect();
                bonds.sort_unstable();
                (layout.clone(), bonds, 0)
            }
            Step::Detach(bond) => (layout.clone(), others(bond).collect(), 0),
            Step::Move(step) => (self.domain.after(layout, step), bonds_after(layout, bonds, step), 1),
        };
        let connected = match step {
            Step::Attach(_) => true,
            Step::Detach(_) => self.domain.is_connected(&layout, &bonds),
            Step::Move(step) => self.domain.stays_connected(&from.layout, &from.bonds, step),
        };
        let to = State { layout, bonds: bonds.into() };
        let width_at_most = match step {
            Step::Move(step) if connected => self.at_most.min(self.domain.at_most(&from.layout, step)),
            _ => self.at_most,
        };
        connected.then_some(Transition { action: step, to, cost, width_at_most })
    }
}

impl Space for Primitive<'_> {
    type State = State;
    type Action = Step;

    fn start(&self) -> State {
        let problem = self.domain.problem;
        State { layout: problem.start_layout().clone(), bonds: problem.start_bonds().into() }
    }

    fn is_goal(&self, state: &State) -> bool {
        let goal = self.domain.problem.goal();
        goal.arrival(&state.layout).is_some_and(|arrival| *goal.bonds(arrival) == *state.bonds)
    }

    fn transitions(&self, from: &State) -> Vec<Transition<State, Step>> {
        let missing = from.layout.touching().into_iter().filter(|bond| from.bonds.binary_search(bond).is_err());
        let attach = missing.map(Step::Attach);
        let detach = from.bonds.iter().map(|&bond| Step::Detach(bond));
        let moves = self.domain.moves(&from.layout).into_iter();
        let moves = moves.filter(|&step| self.domain.allows(&from.layout, &from.bonds, step)).map(Step::Move);
        attach.chain(detach).chain(moves).filter_map(|step| self.transition(from, step)).collect()
    }

    fn certify(&self, from: &State, action: &Step, to: &State, floor: f64) -> Width {
        if !self.domain.stability {
            return Width::UNLIMITED;
        }
        let found = match *action {
            Step::Attach(_) | Step::Detach(_) => width(self.domain.of_state(&to.layout, &to.bonds).margin),
            Step::Move(step) => width(self.domain.of_move(&from.layout, &from.bonds, step, floor).margin),
        };
        found.in_series(self.start)
    }

    fn remaining_cost(&self, state: &State) -> Option<u32> {
        self.domain.problem.goal().fewest_moves(&state.layout)
    }

    fn width_at_most(&self) -> f64 {
        self.at_most
    }

    fn heap_bytes(&self, state: &State) -> usize {
        size_of_val(state.layout.placed()) + size_of_val(&*state.bonds)
    }

    fn memory_bytes(&self) -> usize {
        self.domain.memory_bytes()
    }
}
