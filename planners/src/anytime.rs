//! A path in hand early, then better ones, while the bounds on all paths close in.

use crate::budget::Limit;
use crate::graph::START;
use crate::outcome::{Outcome, Proof};
use crate::progress::Pass;
use crate::search::{PathOf, Search};
use crate::shortest::{ShortestRun, Task};
use crate::space::Space;
use crate::widest::Widest;

/// How much the bound on the remaining cost counts in a hurry.
const GREED: u32 = 4;

/// Expansions after which the proof first pauses for an attempt at a better path.
const FIRST_PAUSE: u64 = 128;

/// An engine that finds a cheapest path at least as wide as its floor, like [`Search::shortest`].
pub type Shortest<'e, S> = &'e dyn for<'s> Fn(&mut Search<'s, S>, f64) -> Outcome<PathOf<S>>;

impl<S: Space> Search<'_, S> {
    /// The cheapest path of a width of at least `floor`, by `shortest`, with another path in hand before.
    ///
    /// Every path that is better than those before it goes to `on_path`: first one that a greedy search finds, where the
    /// space has bounds on remaining costs to be greedy by, and then the cheapest.
    ///
    /// # Guarantees
    ///
    /// Those of `shortest`; if it runs out of budget, `best` is the cheapest path so far.
    pub fn anytime_shortest(
        &mut self,
        floor: f64,
        shortest: Shortest<'_, S>,
        on_path: &mut dyn FnMut(&PathOf<S>),
    ) -> Outcome<PathOf<S>> {
        let has_bounds = !matches!(self.graph.remaining(START), 0 | crate::graph::DEAD_END);
        let early = has_bounds.then(|| {
            self.begin();
            self.monitor.progress.pass = Pass::Greedy;
            self.hurry(floor, u64::MAX, 0).best
        });
        let early = early.flatten().map(|arrows| self.path(&arrows));
        if let Some(path) = &early {
            on_path(path);
        }
        match shortest(self, floor) {
            Outcome::Solved { found, proof } => match early {
                Some(early) if early.cost <= found.cost => Outcome::Solved { found: early, proof },
                _ => {
                    on_path(&found);
                    Outcome::Solved { found, proof }
                }
            },
            Outcome::OutOfBudget { limit, best, proof } => {
                if let Some(found) = best.as_ref().filter(|found| early.as_ref().is_none_or(|e| found.cost < e.cost)) {
                    on_path(found);
                }
                let cheaper = |a: PathOf<S>, b: PathOf<S>| if b.cost < a.cost { b } else { a };
                let best = early.into_iter().chain(best).reduce(cheaper);
                let cost_optimal = best.as_ref().is_some_and(|path| path.cost <= proof.cost_at_least);
                Outcome::OutOfBudget { limit, best, proof: Proof { cost_optimal, ..proof } }
            }
            Outcome::Impossible => Outcome::Impossible,
        }
    }

    /// The cheapest of the widest paths among those of a width of at least `floor`, like [`Search::margin`], with
    /// other paths in hand before.
    ///
    /// A search for the least cost is guided by the bounds on remaining costs, one for the
    /// largest width is not. So cheap paths come first ([`Search::anytime_shortest`]), and then the
    /// question is only whether a path is wider *by more than the tolerance*, which far
    /// fewer transitions are open to. If none is, the cheapest path is also the cheapest of the widest. While that takes
    /// long, every other share of the work goes into greedy searches half-way between the widest path so far and
    /// the bound: each finds a wider path, lowers the bound, or is given up.
    ///
    /// Every path that is better than those before it (wider, or as wide and cheaper) goes to `on_path`.
    ///
    /// # Guarantees
    ///
    /// Those of [`Search::margin`].
    pub fn anytime_margin(
        &mut self,
        floor: f64,
        shortest: Shortest<'_, S>,
        on_path: &mut dyn FnMut(&PathOf<S>),
    ) -> Outcome<PathOf<S>> {
        let cheapest = self.anytime_shortest(floor, shortest, on_path);
        let Outcome::Solved { found, proof } = cheapest else { return cheapest };
        if found.width.lower >= self.tie(proof.width_at_most) {
            return Outcome::Solved { found, proof: Proof { width_optimal: true, ..proof } };
        }
        let wider = self.wider(found.width.lower);
        let Widened { best, limit, width_at_most } = self.widen(found.width.lower, on_path);
        let (best, limit) = match (best, limit) {
            (None, None) => {
                let proof = Proof { width_at_most: wider, width_optimal: true, ..proof };
                return Outcome::Solved { found, proof };
            }
            // Brackets straddle the edge of the tolerance: the engine's own passes tell what they allow.
            (best, Some(Limit::Precision)) => {
                let best = best.unwrap_or(found);
                let again = self.margin(floor);
                return self.retold(again, best, on_path);
            }
            (best, Some(limit)) => {
                let best = best.unwrap_or(found);
                let proof = Proof { width_at_most, width_optimal: false, cost_optimal: false, ..proof };
                return Outcome::OutOfBudget { limit, best: Some(best), proof };
            }
            (Some(best), limit) => (best, limit),
        };
        let as_wide = self.tie(width_at_most).min(best.width.lower).max(floor);
        let widest = Proof { width_at_most, width_optimal: true, floor: as_wide, ..proof };
        match shortest(self, as_wide) {
            Outcome::Solved { found, proof } => {
                if found.cost < best.cost {
                    on_path(&found);
                }
                let found = if found.cost < best.cost { found } else { best };
                let Proof { cost_at_least, cost_optimal, .. } = proof;
                Outcome::Solved { found, proof: Proof { cost_at_least, cost_optimal, ..widest } }
            }
            Outcome::OutOfBudget { limit, best: other, proof } => {
                let best = other.filter(|other| other.cost < best.cost).unwrap_or(best);
                let cost_at_least = proof.cost_at_least;
                let cost_optimal = best.cost <= cost_at_least;
                let proof = Proof { cost_at_least, cost_optimal, ..widest };
                Outcome::OutOfBudget { limit, best: Some(best), proof }
            }
            // Rounding alone can lose the path in hand: what is proved about widths stays.
            Outcome::Impossible => {
                let limit = limit.unwrap_or(Limit::Precision);
                Outcome::OutOfBudget { limit, best: Some(best), proof: Proof { cost_optimal: false, ..widest } }
            }
        }
    }

    /// The answer of another engine, with the path that was told last unless the other one is better.
    fn retold(
        &self,
        outcome: Outcome<PathOf<S>>,
        told: PathOf<S>,
        on_path: &mut dyn FnMut(&PathOf<S>),
    ) -> Outcome<PathOf<S>> {
        let mut better = |other: PathOf<S>| {
            let is_wider = other.width.lower >= self.wider(told.width.lower);
            let is_cheaper = other.width.lower >= self.tie(told.width.lower) && other.cost < told.cost;
            if is_wider || is_cheaper {
                on_path(&other);
                other
            } else {
                told.clone()
            }
        };
        match outcome {
            Outcome::Solved { found, proof } => Outcome::Solved { found: better(found), proof },
            Outcome::OutOfBudget { limit, best: Some(other), proof } => {
                Outcome::OutOfBudget { limit, best: Some(better(other)), proof }
            }
            Outcome::OutOfBudget { limit, best: None, proof } => {
                Outcome::OutOfBudget { limit, best: Some(told), proof }
            }
            Outcome::Impossible => Outcome::Impossible,
        }
    }

    /// The widest of the paths that are wider than `width` by more than the tolerance.
    fn widen(&mut self, width: f64, on_path: &mut dyn FnMut(&PathOf<S>)) -> Widened<PathOf<S>> {
        self.begin();
        self.monitor.progress.pass = Pass::Widest;
        let mut best: Option<PathOf<S>> = None;
        let mut at_most = self.graph.cap();
        let mut prover = Widest::new(self.wider(width), at_most);
        let mut share = FIRST_PAUSE;
        loop {
            let pause_at = self.statistics().expanded.saturating_add(share);
            self.monitor.progress.pass = Pass::Widest;
            if let Some(run) = prover.run(self, pause_at) {
                self.book(prover.bytes());
                self.monitor.progress.width_at_most = run.width_at_most.min(at_most);
                self.monitor.report();
                if let Some(arrows) = run.best {
                    let path = self.path(&arrows);
                    if best.as_ref().is_none_or(|best| path.width.lower > best.width.lower) {
                        on_path(&path);
                        best = Some(path);
                    }
                }
                return Widened { best, limit: run.limit, width_at_most: run.width_at_most.min(at_most) };
            }
            at_most = at_most.min(self.monitor.progress.width_at_most);
            let pause_at = self.statistics().expanded.saturating_add(share);
            self.monitor.progress.pass = Pass::Greedy;
            while self.statistics().expanded < pause_at {
                let aim = f64::midpoint(best.as_ref().map_or(width, |best| best.width.lower), at_most);
                if !(aim >= prover.floor() && aim.is_finite()) {
                    break;
                }
                match self.hurry(aim, pause_at, prover.bytes()) {
                    ShortestRun { best: Some(arrows), .. } => {
                        let path = self.path(&arrows);
                        prover.raise(self.wider(path.width.lower));
                        self.monitor.progress.best_width = Some(path.width.lower);
                        on_path(&path);
                        best = Some(path);
                    }
                    ShortestRun { limit: None, .. } => {
                        at_most = aim.next_down();
                        self.monitor.progress.width_at_most = at_most;
                    }
                    ShortestRun { limit: Some(_), .. } => break,
                }
            }
            share = share.saturating_mul(2);
        }
    }

    /// Some path of a width of at least `floor`, found greedily; without a limit or a path there is none.
    fn hurry(&mut self, floor: f64, pause_at: u64, held_bytes: usize) -> ShortestRun {
        self.run_shortest(&Task { greed: GREED, pause_at, held_bytes, ..Task::whole(floor, u32::MAX) })
    }

    /// The least width that counts as more than `width`.
    pub fn wider(&self, width: f64) -> f64 {
        (width + (width - self.tie(width))).max(width.next_up())
    }
}

/// How the search for a wider path ended.
struct Widened<P> {
    best: Option<P>,
    limit: Option<Limit>,
    width_at_most: f64,
}
