//! The actions of a plan in groups: a move by itself, and what is attached or detached in one go.
//!
//! Within a group any order and any overlap will do, since no state on the way is worse than one of its two ends.

use std::ops::Range;

use crate::reconfigure::action::Action;
use crate::reconfigure::plan::Plan;

/// What the actions of a group do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// They engage connections.
    Attach,
    /// They release connections.
    Detach,
    /// The one action moves a module.
    Move {
        /// The module.
        module: usize,
    },
}

/// Consecutive actions of one kind.
#[derive(Clone, Debug)]
pub struct Group {
    /// What they do.
    pub kind: Kind,
    /// Their indices in the plan.
    pub indices: Range<usize>,
    /// The actions.
    pub actions: Vec<Action>,
}

impl Group {
    /// The groups of a plan, in its order.
    pub fn of(plan: &Plan) -> Vec<Self> {
        let mut groups: Vec<Self> = Vec::new();
        for (index, action) in plan.actions.iter().map(|planned| planned.action).enumerate() {
            let kind = match action {
                Action::Attach(_) => Kind::Attach,
                Action::Detach(_) => Kind::Detach,
                Action::Move { module, .. } => Kind::Move { module },
            };
            match groups.last_mut() {
                Some(last) if last.kind == kind && last.moving().is_none() => {
                    last.actions.push(action);
                    last.indices.end = index + 1;
                }
                _ => groups.push(Self { kind, indices: index..index + 1, actions: vec![action] }),
            }
        }
        groups
    }

    /// The module that it moves.
    pub fn moving(&self) -> Option<usize> {
        match self.kind {
            Kind::Move { module } => Some(module),
            Kind::Attach | Kind::Detach => None,
        }
    }

    /// Whether one of the two moves a module that the other names.
    pub fn shares_module(&self, other: &Self) -> bool {
        let moves = |a: &Self, b: &Self| a.moving().is_some_and(|module| b.names(module));
        moves(self, other) || moves(other, self)
    }

    fn names(&self, module: usize) -> bool {
        self.actions.iter().any(|action| match *action {
            Action::Attach(connection) | Action::Detach(connection) => connection.modules().contains(&module),
            Action::Move { module: own, support, .. } => own == module || support == Some(module),
        })
    }
}
