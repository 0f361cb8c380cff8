//! The widest path, and among those the cheapest: two passes.

use crate::budget::Limit;
use crate::graph::START;
use crate::outcome::Outcome;
use crate::progress::Pass;
use crate::search::{Bounds, PathOf, Search};
use crate::shortest::Task;
use crate::space::Space;

impl<S: Space> Search<'_, S> {
    /// The cheapest of the widest paths from the start to a goal, among those
    /// whose width is at least `floor` (`NEG_INFINITY` for any).
    ///
    /// The order "wider, then cheaper" is not isotone, so that one search with
    /// one label a state gets it wrong (see [`algebra`](crate::algebra)). The
    /// first pass finds the best width, the second the least cost of a path
    /// that is [as good](Search::tie); widths certified in the first serve the second.
    ///
    /// # Guarantees
    ///
    /// - `Solved`: no path is wider than `width_at_most`, the path's certified
    ///   width is within the tolerance of it, and no path whose true width is
    ///   at least the proof's `floor` costs less.
    /// - `Impossible`: as for [`Search::widest`].
    /// - `OutOfBudget`: `best` is the first pass's path as long as the second has no
    ///   better one; both bounds hold.
    pub fn margin(&mut self, floor: f64) -> Outcome<PathOf<S>> {
        self.begin();
        let first = self.run_widest(floor);
        let width_at_most = first.width_at_most;
        let widest = match (first.best.map(|arrows| self.path(&arrows)), first.limit) {
            (Some(path), None | Some(Limit::Precision)) => path,
            (best, limit) => {
                let cost_at_least = self.graph.remaining(START);
                return self.conclude(best, limit, floor, Bounds { width_at_most, cost_at_least });
            }
        };
        let floor = self.tie(width_at_most).min(widest.width.lower).max(floor);
        self.monitor.progress.pass = Pass::Shortest;
        self.monitor.progress.best_cost = Some(widest.cost);
        let second = self.run_shortest(&Task::whole(floor, widest.cost));
        let best = second.best.map_or(widest, |arrows| self.path(&arrows));
        self.monitor.progress.best_cost = Some(best.cost);
        self.monitor.report();
        let bounds = Bounds { width_at_most, cost_at_least: second.cost_at_least };
        self.conclude(Some(best), second.limit.or(first.limit), floor, bounds)
    }
}
