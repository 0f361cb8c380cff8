//! A search over one space: what its engines share.

use crate::algebra::Additive;
use crate::apart::Classes;
use crate::budget::{Budget, Limit, Statistics};
use crate::graph::{Arrow, End, Graph, START};
use crate::outcome::{Outcome, Path, Proof, Step};
use crate::progress::{Monitor, Progress};
use crate::space::Space;
use crate::tree::Tree;

/// Expansions after which a proof first pauses for an attempt at something else.
pub(crate) const FIRST_SHARE: u64 = 128;

/// A path of a space.
pub type PathOf<S> = Path<<S as Space>::State, <S as Space>::Action>;

/// How to search.
#[derive(Clone, Debug)]
pub struct Options {
    /// Two widths `a >= b` are equally good if `a - b <= tolerance * max(1, |a|)`.
    /// It has to cover the intervals that certification leaves: where a bound
    /// cannot be brought that close, the outcome is [`Limit::Precision`].
    /// Below 1, 0 for exact widths.
    pub tolerance: f64,
    /// What may be spent, by all calls on one [`Search`] together.
    pub budget: Budget,
    /// A progress report is due after so many queue entries were decided.
    pub report_every: u64,
}

impl Default for Options {
    /// Unlimited, with a report every 32 decisions and a tolerance of 1e-6: no
    /// strength is known to more digits than that.
    fn default() -> Self {
        Options { tolerance: 1e-6, budget: Budget::default(), report_every: 32 }
    }
}

/// Search over one space.
///
/// Engines called on one `Search` share the explored graph and its certified
/// widths: nothing is generated twice, and certified twice only if an early
/// stop left it undecided. All are deterministic as long as no deadline or
/// cancellation ends them: ties go to what was generated first. A floor of NaN
/// is reached by no path.
pub struct Search<'a, S: Space> {
    pub(crate) graph: Graph<'a, S>,
    pub(crate) monitor: Monitor<'a>,
    /// Labels of the shortest-path engine, kept to reuse the memory.
    pub(crate) tree: Tree<Additive>,
    tolerance: f64,
    /// When so many states have been expanded, a search pauses, as if the budget had ended.
    pub(crate) pause_at: u64,
    /// Whether the last search did so.
    pub(crate) is_paused: bool,
    /// What progress reports say from the beginning.
    pub(crate) known: Known,
    /// Width of the widest path found so far.
    pub(crate) widest: Option<f64>,
    /// What is known of the classes of states, where a space has them.
    pub(crate) classes: Classes,
}

/// What is known before a search begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    /// That of the path in hand.
    pub width: Option<f64>,
    /// No path is wider.
    pub width_at_most: f64,
    /// No path that is as wide as the one in hand costs less; without one, any number.
    pub cost_at_least: u32,
}

impl Default for Known {
    fn default() -> Self {
        Known { width: None, width_at_most: f64::INFINITY, cost_at_least: u32::MAX }
    }
}

impl<'a, S: Space> Search<'a, S> {
    /// A search that has explored only the start.
    pub fn new(space: &'a S, options: Options) -> Self {
        Search {
            graph: Graph::new(space),
            monitor: Monitor::new(options.budget, options.report_every.max(1)),
            tree: Tree::new(),
            tolerance: options.tolerance,
            pause_at: u64::MAX,
            is_paused: false,
            known: Known::default(),
            widest: None,
            classes: Classes::default(),
        }
    }

    /// Has `callback` called with progress: at a fixed rate, and after every pass.
    pub fn on_progress(mut self, callback: &'a mut dyn FnMut(&Progress)) -> Self {
        self.monitor.on_progress(callback);
        self
    }

    /// What has been spent so far.
    pub fn statistics(&self) -> Statistics {
        self.monitor.progress.statistics
    }

    /// The smallest width that counts as equal to `width`, by [`Options::tolerance`].
    pub fn tie(&self, width: f64) -> f64 {
        if width.is_finite() { width - self.tolerance * width.abs().max(1.0) } else { width }
    }

    /// The states that certified transitions at least as wide as `floor` lead to from the start, nearest first: after a
    /// [search](Search::shortest) with this floor that proved its goals out of reach, all that there are.
    pub fn reached(&self, floor: f64) -> Vec<&S::State> {
        let mut seen = vec![false; self.graph.states()];
        let mut reached = vec![START];
        seen[START as usize] = true;
        let mut next = 0;
        while let Some(&state) = reached.get(next) {
            next += 1;
            for edge in self.graph.known_successors(state) {
                if is_wide_enough(edge.width.lower, floor) && !std::mem::replace(&mut seen[edge.to as usize], true) {
                    reached.push(edge.to);
                }
            }
        }
        reached.into_iter().map(|id| self.graph.state(id)).collect()
    }

    /// Books what has been done, with the memory of queues and labels.
    pub(crate) fn book(&mut self, open_bytes: usize) {
        let held_bytes = open_bytes + self.classes.bytes();
        let counted = || self.graph.bytes() + held_bytes + self.graph.space().memory_bytes();
        let bytes = self.monitor.measured().unwrap_or_else(counted);
        let statistics = &mut self.monitor.progress.statistics;
        statistics.generated = self.graph.generated;
        statistics.certified = self.graph.certified;
        statistics.states = self.graph.states();
        statistics.bytes = statistics.bytes.max(bytes);
    }

    /// Books one more decision, and reports if it is time; says which limit is exceeded, or that the search has used up
    /// its share.
    pub(crate) fn tick(&mut self, open_bytes: usize) -> Option<Limit> {
        self.book(open_bytes);
        let limit = self.monitor.tick();
        self.is_paused = limit.is_none() && self.monitor.progress.statistics.expanded >= self.pause_at;
        limit.or(self.is_paused.then_some(Limit::Expansions))
    }

    /// Does some work with so many expansions, and says whether it was these that ended it. Within the share of other
    /// work it gets no more than is left of that.
    pub(crate) fn sharing<T>(&mut self, share: u64, work: impl FnOnce(&mut Self) -> T) -> (T, bool) {
        let outer = self.pause_at;
        self.pause_at = self.statistics().expanded.saturating_add(share).min(outer);
        self.is_paused = false;
        let done = work(self);
        let is_paused = self.is_paused;
        self.pause_at = outer;
        self.is_paused = is_paused && self.statistics().expanded >= outer;
        (done, is_paused)
    }

    /// Starts the books of a new question.
    pub(crate) fn begin(&mut self) {
        let Known { width, width_at_most, cost_at_least } = self.known;
        self.monitor.begin(self.graph.cap().min(width_at_most), self.graph.remaining(START), cost_at_least);
        self.monitor.progress.best_width = width;
    }

    /// The path that a sequence of transitions makes, its widths as tight as they can be.
    pub(crate) fn path(&mut self, arrows: &[Arrow]) -> PathOf<S> {
        let path = Path::new(arrows.iter().map(|&arrow| self.step(End::Start, arrow)).collect());
        self.found(path)
    }

    /// Books a path.
    pub(crate) fn found(&mut self, path: PathOf<S>) -> PathOf<S> {
        let width = path.width.lower;
        self.widest = Some(self.widest.map_or(width, |known| known.max(width)));
        path
    }

    /// A transition of a path, its width as tight as it can be.
    pub(crate) fn step(&mut self, end: End, arrow: Arrow) -> Step<S::State, S::Action> {
        let width = self.graph.tighten(end, arrow);
        let edge = self.graph.edge_seen_from(end, arrow);
        let to = if end == End::Start { edge.to } else { arrow.from };
        Step { action: edge.action.clone(), to: self.graph.state(to).clone(), cost: edge.cost, width }
    }

    /// What the bounds prove about a path, or about nothing found.
    pub(crate) fn proof(&self, found: Option<&PathOf<S>>, floor: f64, bounds: Bounds) -> Proof {
        let Bounds { width_at_most, cost_at_least } = bounds;
        Proof {
            width_at_most,
            width_optimal: found.is_some_and(|path| path.width.lower >= self.tie(width_at_most)),
            floor,
            cost_at_least,
            cost_optimal: found.is_some_and(|path| path.cost <= cost_at_least),
        }
    }

    /// Reads how a search ended: without a limit it proved what it found, or
    /// that there is nothing to find.
    pub(crate) fn conclude(
        &self,
        best: Option<PathOf<S>>,
        limit: Option<Limit>,
        floor: f64,
        bounds: Bounds,
    ) -> Outcome<PathOf<S>> {
        let proof = self.proof(best.as_ref(), floor, bounds);
        match (best, limit) {
            (best, Some(limit)) => Outcome::OutOfBudget { limit, best, proof },
            (Some(found), None) => Outcome::Solved { found, proof },
            (None, None) => Outcome::Impossible,
        }
    }
}

/// What holds for all paths.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub width_at_most: f64,
    pub cost_at_least: u32,
}

/// `NEG_INFINITY` is never wide enough: such a transition is impossible.
pub(crate) fn is_wide_enough(width: f64, floor: f64) -> bool {
    width >= floor && width > f64::NEG_INFINITY
}
