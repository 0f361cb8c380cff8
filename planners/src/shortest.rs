//! Shortest path of a required width: lazy A*.

use crate::algebra::{Additive, PathValue};
use crate::budget::Limit;
use crate::graph::{Arrow, DEAD_END, End, Glance, START};
use crate::outcome::Outcome;
use crate::progress::Pass;
use crate::queue::Queue;
use crate::registry::StateId;
use crate::search::{Bounds, PathOf, Search, is_wide_enough};
use crate::space::Space;

/// Paths that turn out not to stand, before nothing is taken for wide enough any more at a glance.
pub(crate) const MISTAKES: u32 = 16;

/// Estimated cost of the whole path, then (later is better) the cost so far.
type Priority = (Additive, u32);

/// A way to a state whose last transition may not be certified.
#[derive(Clone, Copy)]
struct Way {
    arrow: Arrow,
    to: StateId,
}

/// Which paths A* looks among.
pub(crate) struct Task<'t> {
    /// Where the rest of the path begins.
    pub from: StateId,
    /// What the path has cost until there.
    pub spent: u32,
    /// Least certified width of a transition.
    pub floor: f64,
    /// Only paths that cost less are of use.
    pub below: u32,
    /// How much the bound on the remaining cost counts, at least 1. Above 1 a path is found after fewer
    /// expansions and costs at most so many times the least.
    pub greed: u32,
    /// Whether transitions that a glance does not rule out are taken for wide enough until a path leads through them.
    pub is_trusting: bool,
    /// States that the rest may not visit.
    pub avoid: &'t [StateId],
    /// Transitions out of `from` that the rest may not begin with.
    pub forbid: &'t [Arrow],
    /// Memory that the caller holds meanwhile.
    pub held_bytes: usize,
}

impl Task<'_> {
    /// All paths from the start.
    pub fn whole(floor: f64, below: u32) -> Self {
        Task {
            from: START,
            spent: 0,
            floor,
            below,
            greed: 1,
            is_trusting: false,
            avoid: &[],
            forbid: &[],
            held_bytes: 0,
        }
    }

    fn is_whole(&self) -> bool {
        self.from == START && self.forbid.is_empty()
    }
}

/// How A* ended.
pub(crate) struct ShortestRun {
    /// The rest of the cheapest path, if one was found.
    pub best: Option<Vec<Arrow>>,
    /// What ended the search before a proof.
    pub limit: Option<Limit>,
    /// No path wide enough costs less, whether certification could tell or not.
    pub cost_at_least: u32,
    /// The least estimate of a way that was left for costing too much; `u32::MAX` if none was.
    pub beyond: u32,
}

impl<S: Space> Search<'_, S> {
    /// The cheapest path from the start to a goal whose width is at least
    /// `floor` (`NEG_INFINITY` for any).
    ///
    /// # Guarantees
    ///
    /// - `Solved`: every transition's certified width is at least `floor`, and
    ///   no path whose true width is at least `floor` costs less. Admissible
    ///   estimates suffice: states are opened again where they are inconsistent.
    /// - `Impossible`: every path from the start to a goal has a transition
    ///   whose width is proved to be less than `floor`, or `NEG_INFINITY`.
    /// - `OutOfBudget`: no path whose true width is at least `floor` costs less than
    ///   `cost_at_least`. With [`Limit::Precision`], `best` is the cheapest whose
    ///   certified width reaches the floor, but a cheaper one may lead through a
    ///   transition whose interval holds the floor.
    /// - A transition is certified only when its target is taken from the queue,
    ///   that is, if no estimate that is still open is lower.
    pub fn shortest(&mut self, floor: f64) -> Outcome<PathOf<S>> {
        self.begin();
        self.monitor.progress.pass = Pass::Shortest;
        let run = self.run_shortest(&Task::whole(floor, u32::MAX));
        let best = run.best.map(|arrows| self.path(&arrows));
        self.monitor.progress.best_cost = best.as_ref().map(|path| path.cost);
        self.monitor.report();
        let width_at_most = best.as_ref().map_or(f64::NEG_INFINITY, |path| path.width.lower).max(self.graph.cap());
        self.conclude(best, run.limit, floor, Bounds { width_at_most, cost_at_least: run.cost_at_least })
    }

    /// The search; finding nothing without a limit is a proof that there is nothing.
    pub(crate) fn run_shortest(&mut self, task: &Task<'_>) -> ShortestRun {
        let mut mistakes = 0;
        loop {
            let run = self.a_star(task, task.is_trusting && mistakes < MISTAKES);
            self.book(self.tree.bytes() + task.held_bytes);
            // What was presumed or decided has to stand when it is looked at closely.
            let arrows = run.best.as_deref().unwrap_or_default();
            let way = arrows.iter().map(|&arrow| (End::Start, arrow)).collect::<Vec<_>>();
            if self.are_decided(&way, task.floor) && self.all_stand(End::Start, arrows, task.floor) {
                return run;
            }
            mistakes += 1;
        }
    }

    /// Whether all transitions of a way are decided to be wide enough. All of them are asked, so that none that is not is
    /// presumed again.
    pub(crate) fn are_decided(&mut self, way: &[(End, Arrow)], floor: f64) -> bool {
        way.iter()
            .fold(true, |all, &(end, arrow)| is_wide_enough(self.graph.decide(end, arrow, floor).lower, floor) && all)
    }

    /// Whether transitions that were decided to be wide enough are so when they are as tight as they can be.
    pub(crate) fn all_stand(&mut self, end: End, arrows: &[Arrow], floor: f64) -> bool {
        arrows.iter().all(|&arrow| is_wide_enough(self.graph.tighten(end, arrow).lower, floor))
    }

    fn a_star(&mut self, task: &Task<'_>, is_trusting: bool) -> ShortestRun {
        self.tree.clear();
        self.tree.settle(task.from, Additive(task.spent), None);
        if self.graph.is_goal(task.from) {
            return ShortestRun { best: Some(Vec::new()), limit: None, cost_at_least: task.spent, beyond: u32::MAX };
        }
        let mut open = Queue::new();
        let (mut cost_at_least, mut beyond) = (0, u32::MAX);
        // The least estimate at which an interval too wide to decide cut a path off.
        let mut undecided = task.below;
        if self.graph.remaining(task.from) != DEAD_END {
            beyond = self.open_successors(task, task.from, &mut open);
        }

        while let Some(head) = open.pop() {
            let (Additive(estimate), cost) = head.priority;
            let Way { arrow, to } = head.item;
            if self.tree.value(to).is_some_and(|best| best >= Additive(cost)) {
                continue;
            }
            // With inconsistent estimates the head may fall; what was proved stays.
            // A way open with this estimate, greed included, costs at least its share without it.
            let estimate = estimate.div_ceil(task.greed);
            cost_at_least = cost_at_least.max(estimate.min(undecided));
            if task.is_whole() {
                self.monitor.progress.cost_at_least = cost_at_least;
            }
            if let Some(limit) = self.tick(open.bytes() + self.tree.bytes() + task.held_bytes) {
                return ShortestRun { best: None, limit: Some(limit), cost_at_least, beyond };
            }
            if !is_trusting {
                self.graph.decide(End::Start, arrow, task.floor);
            }
            match self.graph.glance(End::Start, arrow, task.floor) {
                Glance::Wide | Glance::Presumed => {}
                Glance::Undecided => {
                    undecided = undecided.min(estimate);
                    continue;
                }
                Glance::Narrow => continue,
            }
            self.tree.settle(to, Additive(cost), Some(arrow));
            if self.graph.is_goal(to) {
                let limit = (cost_at_least < cost).then_some(Limit::Precision);
                return ShortestRun { best: Some(self.tree.way_to(to)), limit, cost_at_least, beyond };
            }
            beyond = beyond.min(self.open_successors(task, to, &mut open));
        }
        let limit = (undecided < task.below).then_some(Limit::Precision);
        ShortestRun { best: None, limit, cost_at_least: cost_at_least.max(undecided), beyond }
    }

    /// Opens all ways on from a state whose label has improved. Returns the least estimate of those that cost too much.
    fn open_successors(&mut self, task: &Task<'_>, from: StateId, open: &mut Queue<Priority, Way>) -> u32 {
        self.monitor.progress.statistics.expanded += 1;
        self.graph.expand(from);
        let value = self.tree.value(from).expect("expanded states are settled");
        let mut beyond = u32::MAX;
        for (index, edge) in self.graph.successors(from).iter().enumerate() {
            let (arrow, to) = (Arrow { from, index: index as u32 }, edge.to);
            let cost = value.then(Additive(edge.cost));
            let remaining = self.graph.remaining(to);
            let estimate = cost.then(Additive(remaining.saturating_mul(task.greed)));
            let least = cost.then(Additive(remaining));
            let is_open = remaining != DEAD_END
                && is_wide_enough(edge.width.upper, task.floor)
                && self.tree.value(to).is_none_or(|best| cost > best)
                && !task.avoid.contains(&to)
                && !task.forbid.contains(&arrow);
            match is_open {
                true if least.0 < task.below => open.push((estimate, cost.0), Way { arrow, to }),
                true => beyond = beyond.min(least.0),
                false => {}
            }
        }
        beyond
    }
}
