//! The cheapest simple paths of a required width, one after the other.

use std::collections::HashSet;
use std::hash::Hash;

use crate::algebra::Additive;
use crate::budget::Limit;
use crate::graph::{Arrow, START};
use crate::outcome::{Outcome, Proof};
use crate::progress::Pass;
use crate::queue::Queue;
use crate::search::{PathOf, Search};
use crate::shortest::Task;
use crate::space::Space;

/// The cheapest path of a cell: of the simple paths that begin with the first
/// `fixed` transitions of `way` and do not go on with one of `forbidden`.
struct Candidate {
    way: Vec<Arrow>,
    fixed: usize,
    forbidden: Vec<Arrow>,
}

/// Cells that are still to be searched through.
struct Cells {
    floor: f64,
    open: Queue<Additive, Candidate>,
    /// Memory of the candidates' transitions.
    bytes: usize,
    /// Least cost at which an interval too wide to decide may hide a path.
    undecided: u32,
}

impl<S: Space> Search<'_, S> {
    /// The `k` cheapest simple paths from the start to a goal whose width is at
    /// least `floor`, cheapest first, ties in order of generation; `k` counts
    /// as at least 1. Of paths whose actions have the same `same_plan` key only
    /// the first is kept: the sorted actions as key drop plans that differ only
    /// in order. A path visits no state twice and ends at its first goal.
    ///
    /// After [`Search::margin`], the `floor` of its proof gives the alternatives
    /// to its path.
    ///
    /// Method: J. Y. Yen, "Finding the k shortest loopless paths in a network",
    /// Management Science 17(11), 1971, in E. L. Lawler's form (Management
    /// Science 18(7), 1972), which splits the paths left into cells that do not
    /// overlap. Each cell is searched by the lazy A* of [`Search::shortest`].
    /// Paths that `same_plan` drops are gone through one by one, and `n`
    /// independent actions have `n!` orders: give a budget.
    ///
    /// # Guarantees
    ///
    /// - `Solved`: every path found is certified, and no path with a key that is
    ///   not among those found costs less than the last. Fewer than `k` are
    ///   all that there are; then `cost_at_least` is `u32::MAX`.
    /// - `Impossible`: as for [`Search::shortest`].
    /// - `OutOfBudget`: those found come in order; no path with another key
    ///   whose true width is at least `floor` costs less than `cost_at_least`.
    pub fn k_best<K: Eq + Hash>(
        &mut self,
        k: usize,
        floor: f64,
        same_plan: impl Fn(&[S::Action]) -> K,
    ) -> Outcome<Vec<PathOf<S>>> {
        self.begin();
        self.monitor.progress.pass = Pass::KBest;
        let mut cells = Cells { floor, open: Queue::new(), bytes: 0, undecided: u32::MAX };
        let (mut found, mut keys) = (Vec::new(), HashSet::new());

        if let Err((limit, cost_at_least)) = self.search_cell(&mut cells, &[], Vec::new()) {
            return self.conclude_list(found, Some(limit), floor, cost_at_least.min(cells.undecided));
        }
        while let Some(head) = cells.open.pop() {
            let (Additive(cost), candidate) = (head.priority, head.item);
            cells.bytes -= candidate.bytes();
            self.monitor.progress.cost_at_least = cost.min(cells.undecided);
            let path = self.path(&candidate.way);
            let actions: Vec<S::Action> = path.steps.iter().map(|step| step.action.clone()).collect();
            if keys.insert(same_plan(&actions)) {
                self.monitor.progress.best_cost.get_or_insert(cost);
                found.push(path);
                if found.len() >= k {
                    let limit = (cells.undecided < cost).then_some(Limit::Precision);
                    return self.conclude_list(found, limit, floor, cost.min(cells.undecided));
                }
            }
            if let Err(limit) = self.split(&mut cells, candidate) {
                return self.conclude_list(found, Some(limit), floor, cost.min(cells.undecided));
            }
        }
        let limit = (cells.undecided < u32::MAX).then_some(Limit::Precision);
        self.conclude_list(found, limit, floor, cells.undecided)
    }

    /// Splits what is left of a cell without its cheapest path into cells by
    /// the place where a path leaves that one.
    fn split(&mut self, cells: &mut Cells, candidate: Candidate) -> Result<(), Limit> {
        let Candidate { way, fixed, mut forbidden } = candidate;
        for at in fixed..way.len() {
            forbidden.push(way[at]);
            self.search_cell(cells, &way[..at], std::mem::take(&mut forbidden)).map_err(|(limit, _)| limit)?;
        }
        Ok(())
    }

    /// Finds the cheapest path of a cell, if it has one. Out of budget it says
    /// what no path of the cell can cost less than.
    fn search_cell(&mut self, cells: &mut Cells, prefix: &[Arrow], forbidden: Vec<Arrow>) -> Result<(), (Limit, u32)> {
        let mut visited = vec![START];
        visited.extend(prefix.iter().map(|&arrow| self.graph.edge(arrow).to));
        let task = Task {
            from: visited.pop().expect("the start at least"),
            spent: self.cost(prefix),
            avoid: &visited,
            forbid: &forbidden,
            held_bytes: cells.bytes + cells.open.bytes(),
            ..Task::whole(cells.floor, u32::MAX)
        };
        let run = self.run_shortest(&task);
        match run.limit {
            Some(Limit::Precision) => cells.undecided = cells.undecided.min(run.cost_at_least),
            Some(limit) => return Err((limit, run.cost_at_least)),
            None => {}
        }
        if let Some(rest) = run.best {
            let candidate = Candidate { way: [prefix, &rest].concat(), fixed: prefix.len(), forbidden };
            cells.bytes += candidate.bytes();
            cells.open.push(Additive(self.cost(&candidate.way)), candidate);
        }
        Ok(())
    }

    fn cost(&self, way: &[Arrow]) -> u32 {
        way.iter().fold(0, |sum: u32, &arrow| sum.saturating_add(self.graph.edge(arrow).cost))
    }

    /// Reads how the search ended. `cost_at_least` is for paths not found.
    fn conclude_list(
        &mut self,
        found: Vec<PathOf<S>>,
        limit: Option<Limit>,
        floor: f64,
        cost_at_least: u32,
    ) -> Outcome<Vec<PathOf<S>>> {
        self.monitor.progress.cost_at_least = cost_at_least;
        self.monitor.report();
        let narrowest = found.iter().map(|path| path.width.lower).reduce(f64::min);
        let proof = Proof {
            width_at_most: self.graph.cap().max(narrowest.unwrap_or(f64::NEG_INFINITY)),
            width_optimal: narrowest.is_some_and(|width| width >= self.tie(self.graph.cap())),
            floor,
            cost_at_least,
            cost_optimal: found.last().is_some_and(|path| path.cost <= cost_at_least),
        };
        match limit {
            Some(limit) => Outcome::OutOfBudget { limit, best: (!found.is_empty()).then_some(found), proof },
            None if found.is_empty() => Outcome::Impossible,
            None => Outcome::Solved { found, proof },
        }
    }
}

impl Candidate {
    fn bytes(&self) -> usize {
        (self.way.len() + self.forbidden.len()) * size_of::<Arrow>()
    }
}
