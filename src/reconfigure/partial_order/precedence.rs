//! Which groups wait for which, and why.
//!
//! Knows numbers only; does not know what the groups do.

use std::collections::BTreeMap;
use std::ops::Range;

use petgraph::graph::{DiGraph, NodeIndex};

/// A set of groups, one flag for each.
pub type Set = Vec<bool>;

/// An order of groups that are numbered as the plan has them; `B` is a reason.
#[derive(Clone, Debug)]
pub struct Precedence<B> {
    /// For each group all that must have ended before it.
    before: Vec<Set>,
    reasons: BTreeMap<(usize, usize), B>,
}

impl<B: Clone> Precedence<B> {
    /// So many groups, none of which waits for another.
    pub fn none(groups: usize) -> Self {
        Self { before: vec![vec![false; groups]; groups], reasons: BTreeMap::new() }
    }

    /// So many groups, each of which waits for all before it in the plan.
    pub fn one_by_one(groups: usize) -> Self {
        let before = (0..groups).map(|group| (0..groups).map(|other| other < group).collect()).collect();
        Self { before, reasons: BTreeMap::new() }
    }

    /// How many groups there are.
    pub fn len(&self) -> usize {
        self.before.len()
    }

    /// Whether a group waits for another, directly or not.
    pub fn waits(&self, group: usize, other: usize) -> bool {
        self.before[group][other]
    }

    /// Lets a group wait for an earlier one, and for all that this one waits for.
    pub fn wait(&mut self, group: usize, other: usize, because: B) {
        if self.before[group][other] {
            return;
        }
        for earlier in 0..other {
            self.before[group][earlier] |= self.before[other][earlier];
        }
        self.before[group][other] = true;
        self.reasons.insert((other, group), because);
    }

    /// The groups before one in the plan.
    pub fn prefix(&self, group: usize) -> Set {
        (0..self.len()).map(|other| other < group).collect()
    }

    /// Of the groups before `group` in the plan, those that may begin once `done` are.
    pub fn open(&self, group: usize, done: &Set) -> Vec<usize> {
        let may_begin = |&other: &usize| !done[other] && (0..other).all(|b| !self.before[other][b] || done[b]);
        (0..group).filter(may_begin).collect()
    }

    /// Whether a done group comes before no other one that is done.
    pub fn is_last(&self, group: usize, done: &Set) -> bool {
        done[group] && (group + 1..done.len()).all(|later| !done[later] || !self.before[later][group])
    }

    /// The arrows that do not follow from others, between the actions with these indices.
    pub fn graph(&self, actions: usize, indices: impl Fn(usize) -> Range<usize>) -> DiGraph<(), B> {
        let mut graph = DiGraph::with_capacity(actions, actions);
        for _ in 0..actions {
            graph.add_node(());
        }
        for (&(from, to), because) in &self.reasons {
            let follows = (from + 1..to).any(|between| self.before[to][between] && self.before[between][from]);
            if follows {
                continue;
            }
            for a in indices(from) {
                for b in indices(to) {
                    graph.add_edge(NodeIndex::new(a), NodeIndex::new(b), because.clone());
                }
            }
        }
        graph
    }
}
