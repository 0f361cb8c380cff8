//! Explicit graphs as spaces, for tests, examples and comparisons.

use crate::space::{Reversible, Space, Transition, Width};

/// A transition of a [`Toy`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc<A> {
    /// What is done.
    pub action: A,
    /// The node that it leads to.
    pub to: usize,
    /// Its cost.
    pub cost: u32,
    /// What [`Space::transitions`] says about its width.
    pub width_at_most: f64,
    /// What [`Space::certify`] says about its width.
    pub width: Width,
}

/// A graph with everything written down. Nodes are numbers from 0.
#[derive(Clone, Debug)]
pub struct Toy<A> {
    /// Where searches begin.
    pub start: usize,
    /// Which nodes are goals.
    pub is_goal: Vec<bool>,
    /// Transitions out of each node.
    pub arcs: Vec<Vec<Arc<A>>>,
    /// The heuristic: what [`Space::remaining_cost`] says about each node.
    pub remaining: Vec<Option<u32>>,
    /// The heuristic from the other end: what [`Reversible::spent_cost`] says about each node.
    pub spent: Vec<Option<u32>>,
    /// What [`Space::width_at_most`] says.
    pub width_at_most: f64,
}

impl<A> Toy<A> {
    /// A graph without transitions, with a blind heuristic and no bounds.
    pub fn new(nodes: usize, start: usize, goals: &[usize]) -> Self {
        Toy {
            start,
            is_goal: (0..nodes).map(|node| goals.contains(&node)).collect(),
            arcs: (0..nodes).map(|_| Vec::new()).collect(),
            remaining: vec![Some(0); nodes],
            spent: vec![Some(0); nodes],
            width_at_most: f64::INFINITY,
        }
    }

    /// Adds a transition whose width is known exactly once it is certified, and
    /// unbounded until then.
    pub fn arc(mut self, from: usize, to: usize, action: A, cost: u32, width: f64) -> Self {
        let width = Width::exact(width);
        self.arcs[from].push(Arc { action, to, cost, width_at_most: f64::INFINITY, width });
        self
    }
}

impl<A: Clone + PartialEq + Send + Sync> Space for Toy<A> {
    type State = usize;
    type Action = A;

    fn start(&self) -> usize {
        self.start
    }

    fn is_goal(&self, &state: &usize) -> bool {
        self.is_goal[state]
    }

    fn transitions(&self, &from: &usize) -> Vec<Transition<usize, A>> {
        let transition = |arc: &Arc<A>| Transition {
            action: arc.action.clone(),
            to: arc.to,
            cost: arc.cost,
            width_at_most: arc.width_at_most,
        };
        self.arcs[from].iter().map(transition).collect()
    }

    /// Width of the first such transition. Below the floor it claims no more
    /// than that: its interval is `[-inf, a little less than the floor]`.
    fn certify(&self, &from: &usize, action: &A, &to: &usize, floor: f64) -> Width {
        let arc = self.arcs[from].iter().find(|arc| arc.action == *action && arc.to == to);
        let width = arc.expect("certified transitions exist").width;
        if width.upper < floor {
            Width { lower: f64::NEG_INFINITY, upper: (width.upper + floor.min(f64::MAX)) / 2.0 }
        } else {
            width
        }
    }

    /// Which side of the floor the width is on; above it, the interval is `[floor, inf]`.
    fn decide(&self, from: &usize, action: &A, to: &usize, floor: f64) -> Option<Width> {
        let width = self.certify(from, action, to, floor);
        let is_wide = width.lower > floor && floor > f64::NEG_INFINITY;
        Some(if is_wide { Width { lower: floor, upper: f64::INFINITY } } else { width })
    }

    /// Of every third transition what [`certify`](Space::certify) would say, of another third nothing; none of the others.
    fn glance(&self, from: &usize, action: &A, to: &usize, floor: f64) -> Option<f64> {
        match (from + to) % 3 {
            0 => None,
            1 => Some(f64::INFINITY),
            _ => Some(self.certify(from, action, to, floor).upper),
        }
    }

    fn remaining_cost(&self, &state: &usize) -> Option<u32> {
        self.remaining[state]
    }

    fn width_at_most(&self) -> f64 {
        self.width_at_most
    }
}

impl<A: Clone + PartialEq + Send + Sync> Reversible for Toy<A> {
    fn goals(&self) -> Vec<usize> {
        (0..self.is_goal.len()).filter(|&node| self.is_goal[node]).collect()
    }

    fn transitions_into(&self, &state: &usize) -> Vec<Transition<usize, A>> {
        let into = |from: usize| {
            let arcs = self.arcs[from].iter().filter(move |arc| arc.to == state);
            arcs.map(move |arc| Transition {
                action: arc.action.clone(),
                to: from,
                cost: arc.cost,
                width_at_most: arc.width_at_most,
            })
        };
        (0..self.arcs.len()).flat_map(into).collect()
    }

    fn spent_cost(&self, &state: &usize) -> Option<u32> {
        self.spent[state]
    }
}
