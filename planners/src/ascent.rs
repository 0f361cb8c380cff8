//! The widest path by ever higher floors: each search only decides, and is guided by estimates of the cost.

use crate::budget::Limit;
use crate::outcome::Outcome;
use crate::search::{Bounds, PathOf, Search};
use crate::space::Space;

/// An engine that finds a cheapest path at least as wide as its floor, like [`Search::shortest`].
pub type Cheapest<'e, 's, S> = &'e dyn Fn(&mut Search<'s, S>, f64) -> Outcome<PathOf<S>>;

impl<'s, S: Space> Search<'s, S> {
    /// The cheapest of the widest paths from the start to a goal, among those whose width is at least `floor`, like
    /// [`Search::margin`], by one search for a cheapest path after the other, each with the least floor that
    /// the path before does not reach.
    ///
    /// A search with a floor asks of a transition only whether it is wide enough, which is cheaper to prove than how wide
    /// it is ([`Space::decide`]), goes straight to a goal where there are estimates, and, from both ends, proves that
    /// there is nothing better as soon as one end is exhausted. Every path
    /// that is wider than the one before it goes to `on_path`.
    ///
    /// # Guarantees
    ///
    /// Those of [`Search::margin`]; out of budget, `best` is the widest path so far, and no path with at least the width
    /// of the proof's `floor` costs less than `cost_at_least`.
    pub fn ascending(
        &mut self,
        floor: f64,
        cheapest: Cheapest<'_, 's, S>,
        on_path: &mut dyn FnMut(&PathOf<S>),
    ) -> Outcome<PathOf<S>> {
        let (mut found, mut proof) = match cheapest(self, floor) {
            Outcome::Solved { found, proof } => (found, proof),
            Outcome::OutOfBudget { limit: Limit::Precision, best: Some(found), proof } => (found, proof),
            unsolved => return unsolved,
        };
        let mut width_at_most = proof.width_at_most.min(self.graph.cap());
        on_path(&found);
        let limit = loop {
            self.monitor.progress.best_width = Some(found.width.lower);
            if found.width.lower >= self.tie(width_at_most) {
                break None;
            }
            let wider = self.wider(found.width.lower);
            let answer = cheapest(self, wider);
            let is_exhausted = matches!(answer.limit(), None | Some(Limit::Precision));
            width_at_most = width_at_most.min(match &answer {
                Outcome::Impossible => wider.next_down(),
                Outcome::Solved { proof, .. } | Outcome::OutOfBudget { proof, .. } => proof.width_at_most,
            });
            let better = answer.best().zip(answer.proof()).filter(|(path, _)| path.width.lower > found.width.lower);
            if let Some((path, of_path)) = better {
                on_path(path);
                (found, proof) = (path.clone(), *of_path);
                if is_exhausted {
                    continue;
                }
            }
            let is_widest = found.width.lower >= self.tie(width_at_most);
            break (!is_widest).then(|| answer.limit().unwrap_or(Limit::Precision));
        };
        let width_at_most = width_at_most.max(found.width.lower);
        let as_good = self.tie(width_at_most).min(found.width.lower).max(floor);
        if limit.is_some() || proof.floor <= as_good {
            let limit = limit.or((!proof.cost_optimal).then_some(Limit::Precision));
            let bounds = Bounds { width_at_most, cost_at_least: proof.cost_at_least };
            return self.conclude(Some(found), limit, proof.floor, bounds);
        }
        // The floor of the last search was above the least width that is as good: a cheaper path may be between.
        let answer = cheapest(self, as_good);
        let limit = if matches!(answer, Outcome::Impossible) { Some(Limit::Precision) } else { answer.limit() };
        let cost_at_least = answer.proof().map_or(0, |proof| proof.cost_at_least);
        let cheaper = answer.best().filter(|path| path.cost < found.cost).cloned();
        self.conclude(Some(cheaper.unwrap_or(found)), limit, as_good, Bounds { width_at_most, cost_at_least })
    }

    /// The floor of a search for a path that is wider than `width`: half the tolerance above it, so that finding none
    /// proves `width` to be as good as any even where certified intervals hold the floor.
    fn wider(&self, width: f64) -> f64 {
        f64::midpoint(width, width + (width - self.tie(width))).max(width.next_up())
    }
}
