//! The saturated space where displacements change nothing: states by class, and every margin asked for once for all moves
//! that are images of each other.
//!
//! Knows which questions are the same; does not know their answers.

use planners::{Displacement, Periodic, Reversible, Space, Transition, Width};

use super::domain::{Domain, width};
use super::layout::{Layout, Placed};
use super::local::Memo;
use super::moves::Move;
use super::saturated::{Action, Saturated, State};
use super::symmetry::Symmetry;

/// The saturated space of a problem with these symmetries.
pub struct OpenGround<'a> {
    domain: &'a Domain<'a>,
    space: Saturated<'a>,
    symmetry: Symmetry,
    /// Bounds on the widths of moves, by the least of their images.
    known: Memo<(Layout, Move), Known>,
}

/// What is known of the width of a move.
#[derive(Clone, Copy, Debug)]
struct Known {
    width: Width,
    /// Whether no more can be known.
    is_tight: bool,
}

/// What is asked of the width of a move.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Wanted {
    /// What it is, unless it is below the floor.
    Value,
    /// Whether it is at least the floor.
    Side,
}

impl Known {
    /// Whether it answers a question about a floor.
    fn answers(&self, wanted: Wanted, floor: f64) -> bool {
        let Width { lower, upper } = self.width;
        self.is_tight || upper < floor || (wanted == Wanted::Side && lower >= floor)
    }
}

impl<'a> OpenGround<'a> {
    /// The saturated space of a domain with these symmetries.
    pub fn new(domain: &'a Domain<'a>, space: Saturated<'a>, symmetry: Symmetry) -> Self {
        Self { domain, space, symmetry, known: Memo::new() }
    }

    /// The width of a move if it is known, or else by `ask` of the least of its images. `None` where `ask` has no answer.
    fn width(
        &self,
        from: &State,
        step: Move,
        (wanted, floor): (Wanted, f64),
        ask: impl FnOnce(&State, &Action, &State) -> Option<Width>,
    ) -> Option<Width> {
        let key = self.symmetry.kind_of_move(from.layout(), step);
        let before = self.known.known(&key);
        if let Some(known) = before.filter(|known| known.answers(wanted, floor)) {
            return Some(known.width);
        }
        let (layout, step) = &key;
        let to = State::of(self.domain.after(layout, *step));
        let Width { lower, upper } = ask(&State::of(layout.clone()), &Action::Move(*step), &to)?;
        let [least, most] =
            before.map_or([f64::NEG_INFINITY, f64::INFINITY], |Known { width, .. }| [width.lower, width.upper]);
        let upper = upper.min(most);
        let width = Width { lower: lower.max(least).min(upper), upper };
        let found = Known { width, is_tight: false };
        self.known.set(key, Known { is_tight: !found.answers(wanted, floor), ..found });
        Some(width)
    }

    /// A state's margin with everything engaged, if that alone rules out every move into it: asked for once for all states that
    /// are images of each other.
    fn settled_out(&self, to: &State, floor: f64) -> Option<Width> {
        let kind = self.symmetry.kind(to.layout());
        let settled = self.domain.decides_settled(&kind, &kind, floor);
        settled.is_out(floor).then(|| width(settled.cut_short().margin))
    }
}

impl Space for OpenGround<'_> {
    type State = State;
    type Action = Action;

    fn start(&self) -> State {
        self.space.start()
    }

    fn is_goal(&self, state: &State) -> bool {
        self.space.is_goal(state)
    }

    fn transitions(&self, from: &State) -> Vec<Transition<State, Action>> {
        self.space.transitions(from)
    }

    fn certify(&self, from: &State, action: &Action, to: &State, floor: f64) -> Width {
        match *action {
            Action::Move(step) if self.domain.stability => {
                let ask = |from: &State, action: &Action, to: &State| Some(self.space.certify(from, action, to, floor));
                self.width(from, step, (Wanted::Value, floor), ask).expect("there is an answer to every question")
            }
            _ => self.space.certify(from, action, to, floor),
        }
    }

    fn decide(&self, from: &State, action: &Action, to: &State, floor: f64) -> Option<Width> {
        let Action::Move(step) = *action else { return None };
        if !self.domain.stability || floor == f64::NEG_INFINITY {
            return None;
        }
        let ask = |from: &State, action: &Action, next: &State| {
            self.settled_out(to, floor).or_else(|| self.space.decide(from, action, next, floor))
        };
        self.width(from, step, (Wanted::Side, floor), ask)
    }

    fn glance(&self, from: &State, action: &Action, to: &State, floor: f64) -> Option<f64> {
        let Action::Move(step) = *action else { return None };
        if !self.domain.stability || floor == f64::NEG_INFINITY {
            return None;
        }
        let (layout, step) = self.symmetry.kind_of_move(from.layout(), step);
        let own = self.domain.own_at_most(&layout, step);
        if own < floor {
            return Some(own);
        }
        let settled = self.settled_out(to, floor);
        Some(settled.map_or(f64::INFINITY, |out| out.upper))
    }

    fn remaining_cost(&self, state: &State) -> Option<u32> {
        self.space.remaining_cost(state)
    }

    fn width_at_most(&self) -> f64 {
        self.space.width_at_most()
    }

    fn heap_bytes(&self, state: &State) -> usize {
        self.space.heap_bytes(state)
    }

    fn memory_bytes(&self) -> usize {
        let modules = self.domain.problem.start().modules.len();
        self.space.memory_bytes() + self.known.bytes(modules * size_of::<Placed>())
    }
}

impl Reversible for OpenGround<'_> {
    fn goals(&self) -> Vec<State> {
        self.space.goals()
    }

    fn transitions_into(&self, to: &State) -> Vec<Transition<State, Action>> {
        self.space.transitions_into(to)
    }

    fn spent_cost(&self, state: &State) -> Option<u32> {
        self.space.spent_cost(state)
    }
}

impl Periodic for OpenGround<'_> {
    fn class(&self, state: &State) -> (State, Displacement) {
        let (layout, by) = self.symmetry.class(state.layout());
        (State::of(layout), by.map(i64::from))
    }

    fn kind(&self, state: &State) -> State {
        State::of(self.symmetry.kind(state.layout()))
    }
}
