//! The default search space: placements with every possible connection engaged.
//!
//! More connections never lower the margin (statics: monotony), so between moves
//! it is never worse to have all engaged. A transition is one move with the
//! detachments that it needs before it and all attachments after it; of the
//! detachments only the last state can be the worst, and of the attachments none
//! is worse than the end of the move. So this space has a path of at least the width
//! and at most the moves of every plan of primitive actions, and every path
//! of it is such a plan.
//!
//! The goal's own connections are reached by a last transition without cost.

use std::sync::{Mutex, MutexGuard};

use planners::{Reversible, Space, Transition, Width};

use crate::robot::{Cell, Motion};

use super::carried::Carried;
use super::domain::{Domain, width};
use super::goal::Arrival;
use super::heuristic::Targets;
use super::layout::{Bond, Layout};
use super::moves::Move;
use super::oracle::Worst;
use super::pieces::Pieces;

/// Placements, all connections engaged; or the goal with its own connections.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct State {
    layout: Layout,
    arrived: bool,
}

impl State {
    /// A placement that is not the goal yet.
    pub fn of(layout: Layout) -> Self {
        Self { layout, arrived: false }
    }

    /// Where the modules are.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }
}

/// A transition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// A move, with the detachments before it and the attachments after it.
    Move(Move),
    /// The detachments that lead to the goal's own connections.
    Finish(Arrival),
}

/// The space of a domain.
pub struct Saturated<'a> {
    domain: &'a Domain<'a>,
    /// Margin of the start with its own connections: no path is wider.
    start: Width,
    /// No path is wider.
    at_most: f64,
    /// The start as a goal, for what has been spent.
    from_start: Targets,
    carried: Mutex<Carried<'a>>,
}

/// The connections of a saturated layout that a move keeps until it begins, ascending.
pub fn kept(layout: &Layout, step: Move) -> Vec<Bond> {
    let mut bonds = layout.touching();
    bonds.retain(|&bond| !bond.touches(step.from) || step.may_keep(bond));
    bonds
}

/// Margin of a move out of a state with everything engaged, with the detachments before it.
pub fn of_move(domain: &Domain, layout: &Layout, step: Move, floor: f64) -> Worst {
    let bonds = kept(layout, step);
    let released = match step.motion {
        // When a translation begins, the module is held as after the detachments.
        Motion::Translation { .. } => None,
        Motion::Rotation { .. } => Some(domain.of_state(layout, &bonds)),
    };
    if let Some(released) = released.filter(|released| released.is_out(floor)) {
        return released.cut_short();
    }
    let worst = domain.of_move(layout, &bonds, step, floor);
    match released {
        Some(released) if !worst.is_out(floor) => released.or_worse(worst),
        _ => worst,
    }
}

impl<'a> Saturated<'a> {
    /// The space of a domain whose start has this margin and whose paths are no
    /// wider than `at_most`.
    pub fn new(domain: &'a Domain<'a>, start: Width, at_most: f64) -> Self {
        let from_start = domain.problem.targets(domain.problem.start_layout());
        Self { domain, start, at_most, from_start, carried: Mutex::new(Carried::new(domain)) }
    }

    fn carried(&self) -> MutexGuard<'_, Carried<'a>> {
        self.carried.lock().expect("no thread panics while it asks what is carried")
    }

    /// The moves out of a layout through which the robot holds together, in a fixed order.
    fn moves(&self, layout: &Layout) -> Vec<Move> {
        let mut moves = self.domain.moves(layout);
        if !self.domain.problem.must_stay_connected() {
            return moves;
        }
        let bonds = layout.touching();
        let mut others: Option<(Cell, Pieces)> = None;
        moves.retain(|&step| {
            // The moves of a module follow each other.
            if others.as_ref().is_none_or(|(cell, _)| *cell != step.from) {
                others = Some((step.from, Pieces::new(layout, &bonds, step.from)));
            }
            let Some((_, pieces)) = &others else { return false };
            let before = bonds.iter().filter(|bond| bond.touches(step.from) && step.may_keep(**bond));
            let before = before.flat_map(|bond| bond.cells()).collect();
            let mut moments = std::iter::once(before).chain(step.holders(layout));
            moments.all(|holders: Vec<Cell>| pieces.are_joined_by(layout, holders))
        });
        moves
    }

    /// The last transition, seen from either of its ends.
    fn finish(&self, arrival: Arrival, to: State) -> Transition<State, Action> {
        Transition { action: Action::Finish(arrival), to, cost: 0, width_at_most: self.at_most }
    }

    /// A state's margin with everything engaged, if that alone rules out every
    /// move into it: with less engaged, as a move ends, it is no larger.
    fn settled_out(&self, to: &Layout, floor: f64) -> Option<Worst> {
        if floor == f64::NEG_INFINITY {
            return None;
        }
        let settled = self.domain.of_state(to, &to.touching());
        settled.is_out(floor).then(|| settled.cut_short())
    }
}

impl Space for Saturated<'_> {
    type State = State;
    type Action = Action;

    fn start(&self) -> State {
        State { layout: self.domain.problem.start_layout().clone(), arrived: false }
    }

    fn is_goal(&self, state: &State) -> bool {
        state.arrived
    }

    fn transitions(&self, from: &State) -> Vec<Transition<State, Action>> {
        if from.arrived {
            return Vec::new();
        }
        let layout = &from.layout;
        let arrival = self.domain.problem.goal().arrival(layout);
        let finish = arrival.map(|arrival| self.finish(arrival, State { layout: layout.clone(), arrived: true }));
        let moves = self.moves(layout).into_iter().map(|step| Transition {
            action: Action::Move(step),
            to: State { layout: self.domain.after(layout, step), arrived: false },
            cost: 1,
            width_at_most: self.at_most.min(self.domain.at_most(layout, step)),
        });
        finish.into_iter().chain(moves).collect()
    }

    fn certify(&self, from: &State, action: &Action, to: &State, floor: f64) -> Width {
        if !self.domain.stability {
            return Width::UNLIMITED;
        }
        let worst = match *action {
            Action::Move(step) => match self.settled_out(&to.layout, floor) {
                Some(out) => out,
                None => of_move(self.domain, &from.layout, step, floor),
            },
            Action::Finish(arrival) => self.domain.of_state(&from.layout, &self.domain.problem.goal().bonds(arrival)),
        };
        width(worst.margin).in_series(self.start)
    }

    fn decide(&self, from: &State, action: &Action, to: &State, floor: f64) -> Option<Width> {
        let Action::Move(step) = *action else { return None };
        if !self.domain.stability || floor == f64::NEG_INFINITY {
            return None;
        }
        let own = self.domain.own_at_most(&from.layout, step);
        if own < floor {
            return Some(Width { lower: f64::NEG_INFINITY, upper: own });
        }
        if let Some(margin) = self.carried().margin(&from.layout, step, floor) {
            return Some(Width { lower: margin, upper: f64::INFINITY }.in_series(self.start));
        }
        let worst = self.domain.decides(&from.layout, &kept(&from.layout, step), step, &to.layout, floor);
        // What is left open there is asked for itself.
        let is_decided = worst.margin.lower >= floor || worst.is_out(floor);
        is_decided.then(|| width(worst.margin).in_series(self.start))
    }

    fn glance(&self, from: &State, action: &Action, to: &State, floor: f64) -> Option<f64> {
        let Action::Move(step) = *action else { return None };
        if !self.domain.stability || floor == f64::NEG_INFINITY {
            return None;
        }
        let own = self.domain.own_at_most(&from.layout, step);
        Some(if own < floor { own } else { self.domain.decides_settled(&to.layout, &from.layout, floor).margin.upper })
    }

    fn remaining_cost(&self, state: &State) -> Option<u32> {
        self.domain.problem.goal().fewest_moves(&state.layout)
    }

    fn width_at_most(&self) -> f64 {
        self.at_most
    }

    fn heap_bytes(&self, state: &State) -> usize {
        size_of_val(state.layout.placed())
    }

    fn memory_bytes(&self) -> usize {
        self.domain.memory_bytes() + self.carried().bytes()
    }
}

impl Reversible for Saturated<'_> {
    /// The goal as it is written, and so none where it leaves open where it is or how modules are turned.
    fn goals(&self) -> Vec<State> {
        let goal = self.domain.problem.goal();
        let is_known = !goal.is_free() && !self.domain.problem.turns();
        is_known.then(|| State { layout: goal.layout().clone(), arrived: true }).into_iter().collect()
    }

    fn transitions_into(&self, to: &State) -> Vec<Transition<State, Action>> {
        let layout = &to.layout;
        if to.arrived {
            let arrival = self.domain.problem.goal().arrival(layout).expect("only goals are arrived at");
            return vec![self.finish(arrival, State { layout: layout.clone(), arrived: false })];
        }
        // Every move can be taken back through the same states.
        let moves = self.moves(layout).into_iter().map(|back| {
            let from = self.domain.after(layout, back);
            Transition {
                action: Action::Move(back.inverse()),
                width_at_most: self.at_most.min(self.domain.at_most(layout, back)),
                to: State { layout: from, arrived: false },
                cost: 1,
            }
        });
        moves.collect()
    }

    fn spent_cost(&self, state: &State) -> Option<u32> {
        self.from_start.fewest_moves(&state.layout, [0; 3])
    }
}
