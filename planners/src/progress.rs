//! What a caller sees of a running search.

use crate::budget::{Budget, Limit, Statistics};

/// What a search is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Pass {
    /// Looking for some path that is wide enough, soon.
    Greedy,
    /// Looking for the widest path.
    Widest,
    /// Looking for the cheapest path that is wide enough.
    Shortest,
    /// Looking for the next cheapest paths.
    KBest,
}

/// A report from a running search. Bounds hold for all paths, as in [`Proof`](crate::Proof).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done.
    pub pass: Pass,
    /// What has been spent, all passes together.
    pub statistics: Statistics,
    /// Certified width of the widest path so far.
    pub best_width: Option<f64>,
    /// No path is wider.
    pub width_at_most: f64,
    /// Cost of the cheapest path that is wide enough so far.
    pub best_cost: Option<u32>,
    /// No path that is wide enough costs less (after [`Pass::KBest`] has begun: none but those found).
    pub cost_at_least: u32,
}

/// Keeps the books of a search: limits and reports.
pub(crate) struct Monitor<'a> {
    budget: Budget,
    report_every: u64,
    on_progress: Option<&'a mut dyn FnMut(&Progress)>,
    decisions: u64,
    /// Reports claim no more of costs: what is searched is only a part of the paths that they are about.
    cost_claimed: u32,
    pub progress: Progress,
}

impl<'a> Monitor<'a> {
    pub fn new(budget: Budget, report_every: u64) -> Self {
        let progress = Progress {
            pass: Pass::Widest,
            statistics: Statistics::default(),
            best_width: None,
            width_at_most: f64::INFINITY,
            best_cost: None,
            cost_at_least: 0,
        };
        Monitor { budget, report_every, on_progress: None, decisions: 0, cost_claimed: u32::MAX, progress }
    }

    pub fn on_progress(&mut self, callback: &'a mut dyn FnMut(&Progress)) {
        self.on_progress = Some(callback);
    }

    /// Forgets what earlier searches found, not what they spent. Whatever this one finds of costs, its reports claim no
    /// more than `cost_claimed`.
    pub fn begin(&mut self, width_at_most: f64, cost_at_least: u32, cost_claimed: u32) {
        self.cost_claimed = cost_claimed;
        let (pass, statistics) = (self.progress.pass, self.progress.statistics);
        self.progress = Progress { pass, statistics, best_width: None, width_at_most, best_cost: None, cost_at_least };
    }

    /// Counts one decision of the search. Reports at every so many of them; says
    /// which limit is exceeded.
    pub fn tick(&mut self) -> Option<Limit> {
        self.decisions += 1;
        if self.decisions.is_multiple_of(self.report_every) {
            self.report();
        }
        self.budget.exceeded(&self.progress.statistics)
    }

    /// The memory in use, where the caller measures it.
    pub fn measured(&self) -> Option<usize> {
        self.budget.measure_bytes.and_then(|measure| measure())
    }

    pub fn report(&mut self) {
        if let Some(callback) = &mut self.on_progress {
            let cost_at_least = self.progress.cost_at_least.min(self.cost_claimed);
            callback(&Progress { cost_at_least, ..self.progress });
        }
    }
}
