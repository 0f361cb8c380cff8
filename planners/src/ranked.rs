//! The best paths by width, and of equally wide ones by cost.

use std::hash::Hash;

use crate::budget::Limit;
use crate::outcome::{Outcome, Proof};
use crate::search::{PathOf, Search, is_wide_enough};
use crate::space::Space;

impl<S: Space> Search<'_, S> {
    /// The `k` best simple paths of a width of at least `floor`: the widest first, of equally wide ones the cheapest.
    /// `width` is that of the widest path, as [`Search::margin`] finds it. Keys are as in [`Search::k_best`].
    ///
    /// In layers: all paths as wide as the widest are ranked by cost; if there are fewer than `k`, then all paths
    /// as wide as the widest of the transitions that were too narrow so far; and so on.
    ///
    /// # Guarantees
    ///
    /// Those of [`Search::k_best`] in the order of this ranking, where widths count as equal by the
    /// tolerance; `floor` of the proof is the width of the last layer, and `cost_at_least` speaks of that one.
    pub fn ranked<K: Eq + Hash>(
        &mut self,
        k: usize,
        floor: f64,
        width: f64,
        same_plan: impl Fn(&[S::Action]) -> K,
    ) -> Outcome<Vec<PathOf<S>>> {
        let key = |path: &PathOf<S>| {
            let actions: Vec<S::Action> = path.steps.iter().map(|step| step.action.clone()).collect();
            same_plan(&actions)
        };
        let mut ranked: Vec<PathOf<S>> = Vec::new();
        let mut layer = self.tie(width).max(floor);
        loop {
            let outcome = self.k_best(k, layer, &same_plan);
            for path in outcome.best().into_iter().flatten() {
                if ranked.len() < k.max(1) && ranked.iter().all(|known| key(known) != key(path)) {
                    ranked.push(path.clone());
                }
            }
            let (limit, proof) = match outcome {
                Outcome::Impossible => (None, None),
                Outcome::Solved { proof, .. } => (None, Some(proof)),
                Outcome::OutOfBudget { limit, proof, .. } => (Some(limit), Some(proof)),
            };
            let next = self.next_layer(layer, floor);
            let is_done = ranked.len() >= k || next.is_none();
            // An interval too wide to decide leaves the order open, and so all that follows.
            if limit.is_none() && !is_done {
                layer = next.unwrap_or(layer);
                continue;
            }
            let nothing = Proof {
                width_at_most: f64::NEG_INFINITY,
                width_optimal: false,
                floor: layer,
                cost_at_least: u32::MAX,
                cost_optimal: false,
            };
            let proof = Proof { width_at_most: width, ..proof.unwrap_or(nothing) };
            return match limit {
                Some(Limit::Precision) if ranked.len() >= k && proof.cost_optimal => {
                    Outcome::Solved { found: ranked, proof }
                }
                Some(limit) => Outcome::OutOfBudget { limit, best: (!ranked.is_empty()).then_some(ranked), proof },
                None if ranked.is_empty() => Outcome::Impossible,
                None => Outcome::Solved { found: ranked, proof },
            };
        }
    }

    /// The width of the widest known transition that is too narrow for a layer and wide enough for `floor`, a tolerance
    /// wide: a path that is not of the layer leaves what the layer reaches by such a transition.
    fn next_layer(&self, layer: f64, floor: f64) -> Option<f64> {
        let widths = self.graph.known_widths().filter(|&upper| upper < layer && is_wide_enough(upper, floor));
        widths.reduce(f64::max).map(|width| self.tie(width).min(layer.next_down()).max(floor))
    }
}
