//! What the growth of an order has to know of a family of robots.

use std::fmt;
use std::hash::Hash;

use crate::reconfigure::refusal::Refusal;
use crate::statics::Bracket;

use super::Because;

/// What an action does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// It engages a connection.
    Attach,
    /// It releases a connection.
    Detach,
    /// It moves modules.
    Move,
}

/// Why an action of a robot waits for another.
pub type BecauseOf<F> = Because<<F as Family>::Touched>;

/// A robot whose actions are to be ordered.
pub trait Family: Sized {
    /// The robot at rest.
    type State: Clone;
    /// What it does.
    type Action: Copy;
    /// What plans name a connection by.
    type Held;
    /// What its modules can hit.
    type Touched: Clone + PartialEq + fmt::Display;
    /// An engaged connection.
    type Connection: Ord + Clone;
    /// All of a state but its engaged connections: while moves out of states of one place with the same moves under
    /// way, more connections are never worse.
    type Place: Clone + Eq + Hash;

    /// The start, its connections sorted.
    fn start(&self) -> Self::State;

    /// What an action does.
    fn kind(action: &Self::Action) -> Kind;

    /// Why two actions never change places nor overlap, whatever the state.
    fn bound(one: &Self::Action, other: &Self::Action) -> Option<BecauseOf<Self>>;

    /// Where a state has its modules.
    fn place(&self, state: &Self::State) -> Self::Place;

    /// The engaged connections of a state, sorted.
    fn connections(state: &Self::State) -> &[Self::Connection];

    /// What makes two states of the robot different ones; `None` where they are the same.
    fn difference(&self, one: &Self::State, other: &Self::State) -> Option<BecauseOf<Self>>;

    /// The state after an action: if it is legal by the definitions of the replay, and what it moves hits nothing.
    ///
    /// # Errors
    /// What is wrong with the action there.
    fn take(&self, state: &Self::State, action: &Self::Action) -> Result<Self::State, BecauseOf<Self>>;

    /// The worst margin while these moves, each of which may be taken in the state, are under way out of it, at all
    /// combinations of their phases; at rest without any. `Err` inside with what is wrong first.
    ///
    /// # Errors
    /// What the oracle refuses.
    fn worst(&self, state: &Self::State, moves: &[Self::Action]) -> Result<Result<Bracket, BecauseOf<Self>>, Refusal>;

    /// Structures that the oracle has assessed.
    fn solves(&self) -> u64;
}
