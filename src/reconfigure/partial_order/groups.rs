//! The actions of a plan in groups: a move by itself, and what is attached or detached in one go.
//!
//! Within a group any order and any overlap will do, since no state on the way is worse than one of its two ends.

use std::ops::Range;

use crate::reconfigure::plan::Plan;

use super::family::{BecauseOf, Family, Kind};

/// Consecutive actions of one kind.
#[derive(Clone, Debug)]
pub struct Group<A> {
    /// What they do.
    pub kind: Kind,
    /// Their indices in the plan.
    pub indices: Range<usize>,
    /// The actions.
    pub actions: Vec<A>,
}

impl<A: Copy> Group<A> {
    /// The groups of a plan, in its order.
    pub fn of<F: Family<Action = A>>(plan: &Plan<A, F::Held>) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for (index, action) in plan.actions.iter().map(|planned| planned.action).enumerate() {
            let kind = F::kind(&action);
            match groups.last_mut() {
                Some(last) if last.kind == kind && !last.is_move() => {
                    last.actions.push(action);
                    last.indices.end = index + 1;
                }
                _ => groups.push(Self { kind, indices: index..index + 1, actions: vec![action] }),
            }
        }
        groups
    }

    /// Whether it is a move.
    pub fn is_move(&self) -> bool {
        self.kind == Kind::Move
    }

    /// Why the two never change places nor overlap.
    pub fn bound<F: Family<Action = A>>(&self, other: &Self) -> Option<BecauseOf<F>> {
        self.actions.iter().find_map(|one| other.actions.iter().find_map(|two| F::bound(one, two)))
    }
}
