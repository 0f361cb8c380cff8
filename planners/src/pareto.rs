//! Every trade between width and cost that no other path beats.

use crate::anytime::Shortest;
use crate::budget::Limit;
use crate::graph::START;
use crate::outcome::{Outcome, Path, Proof};
use crate::search::{PathOf, Search};
use crate::space::Space;

impl<S: Space> Search<'_, S> {
    /// The front of width against cost among paths of a width of at least `floor`: for every path that is left out, one
    /// of those found is at least as wide, within the tolerance, and costs no more. Cheapest and narrowest first.
    ///
    /// The cheapest path of a width, by `shortest`, and then again and again the cheapest that is wider by more than the
    /// tolerance: where it costs no more, it takes the place of the last. Every found path goes to `on_path`.
    ///
    /// # Guarantees
    ///
    /// - `Solved`: the front is complete.
    /// - `Impossible`: as for [`Search::shortest`].
    /// - `OutOfBudget`: the paths found but the last are on the front. What those found do not match costs at least
    ///   `cost_at_least` and is no wider than `width_at_most`.
    pub fn pareto(
        &mut self,
        floor: f64,
        shortest: Shortest<'_, S>,
        on_path: &mut dyn FnMut(&PathOf<S>),
    ) -> Outcome<Vec<PathOf<S>>> {
        let mut front: Vec<PathOf<S>> = Vec::new();
        let mut proof = Proof {
            width_at_most: self.graph.cap(),
            width_optimal: false,
            floor,
            cost_at_least: self.graph.remaining(START),
            cost_optimal: false,
        };
        let mut cut = None;
        loop {
            let outcome = match front.is_empty() {
                true => self.anytime_shortest(proof.floor, shortest, on_path),
                false => shortest(self, proof.floor),
            };
            if let Some(at_least) = outcome.proof().map(|proof| proof.cost_at_least) {
                proof.cost_at_least = proof.cost_at_least.max(at_least);
            }
            let is_last = match outcome {
                Outcome::Impossible => true,
                Outcome::Solved { found, .. } => {
                    let is_widest = found.width.lower >= self.tie(proof.width_at_most);
                    proof.floor = self.wider(found.width.lower);
                    on_path(&found);
                    add(&mut front, found);
                    is_widest
                }
                Outcome::OutOfBudget { limit, best, .. } => {
                    let goes_on = limit == Limit::Precision && best.is_some();
                    cut = cut.or(Some(limit));
                    if let Some(found) = best {
                        proof.floor = self.wider(found.width.lower);
                        on_path(&found);
                        add(&mut front, found);
                    }
                    !goes_on
                }
            };
            if is_last {
                break;
            }
        }
        match cut {
            Some(limit) => Outcome::OutOfBudget { limit, best: (!front.is_empty()).then_some(front), proof },
            None if front.is_empty() => Outcome::Impossible,
            None => {
                let width_at_most =
                    front.last().map_or(proof.width_at_most, |widest| proof.floor.max(widest.width.lower));
                let proof = Proof { width_at_most, width_optimal: true, cost_optimal: true, ..proof };
                Outcome::Solved { found: front, proof }
            }
        }
    }
}

/// Adds a path that is wider than all others, and costs no less than all but the last.
fn add<S, A>(front: &mut Vec<Path<S, A>>, found: Path<S, A>) {
    if front.last().is_some_and(|last| last.cost >= found.cost) {
        front.pop();
    }
    front.push(found);
}
