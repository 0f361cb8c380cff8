//! A path in hand early, then better ones, while the bounds on all paths close in.

use crate::budget::Limit;
use crate::graph::{DEAD_END, START};
use crate::outcome::{Outcome, Path, Proof};
use crate::progress::Pass;
use crate::search::{Bounds, FIRST_SHARE, Known, PathOf, Search};
use crate::shortest::{ShortestRun, Task};
use crate::space::Space;

/// How much the bound on the remaining cost counts in a hurry.
const GREED: u32 = 4;

/// Expansions within which the cheapest path is looked for before a greedy one: where they do, nothing is looked for twice.
const FIRST_LOOK: u64 = 64;

/// An engine that finds a cheapest path at least as wide as its floor, like [`Search::shortest`].
pub type Shortest<'e, S> = &'e dyn for<'s> Fn(&mut Search<'s, S>, f64) -> Outcome<PathOf<S>>;

impl<S: Space> Search<'_, S> {
    /// The cheapest path of a width of at least `floor`, by `shortest`, with another path in hand before.
    ///
    /// Every path that is better than those before it goes to `on_path`: where the cheapest is not found at once, first one that
    /// a greedy search finds soon, if the space has bounds on remaining costs to be greedy by. Both take turns as long as neither
    /// has found anything, so that where `shortest` soon proves that there is nothing, no more is looked for.
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
        match self.first(floor, shortest) {
            First::Answer(outcome) => told(outcome, None, on_path),
            First::Early(path) => {
                on_path(&path);
                told(shortest(self, floor), Some(path), on_path)
            }
        }
    }

    /// The first that comes: the answer of `shortest`, or some path that a greedy search finds.
    fn first(&mut self, floor: f64, shortest: Shortest<'_, S>) -> First<PathOf<S>> {
        if matches!(self.graph.remaining(START), 0 | DEAD_END) {
            return First::Answer(shortest(self, floor));
        }
        let (outcome, is_paused) = self.sharing(FIRST_LOOK, |search| shortest(search, floor));
        if !is_paused {
            return First::Answer(outcome);
        }
        let mut share = FIRST_SHARE;
        loop {
            self.begin();
            self.monitor.progress.pass = Pass::Greedy;
            let ShortestRun { best, limit, .. } = self.sharing(share, |search| search.hurry(floor)).0;
            if let Some(arrows) = best {
                return First::Early(self.path(&arrows));
            } else if limit.is_none() {
                return First::Answer(Outcome::Impossible);
            }
            let (outcome, paused) = self.sharing(share, |search| shortest(search, floor));
            if !paused {
                return First::Answer(outcome);
            }
            share = share.saturating_mul(2);
        }
    }

    /// The cheapest of the widest paths among those of a width of at least `floor`, like [`Search::margin`], with
    /// other paths in hand before.
    ///
    /// A search for the least cost is guided by the bounds on remaining costs, and asks of a transition only whether it is
    /// wide enough ([`Space::decide`]); one for the largest width can do neither. So some path comes first, as in
    /// [`Search::anytime_shortest`], and then the question is only whether a path is wider *by more than the tolerance
    /// admits*, again and again, each by `shortest` with a higher floor. Searched from both ends, the
    /// last of them ends as soon as either end is exhausted. While that takes long, other shares of the work
    /// go to higher floors, first the bound itself, then half-way between what is known to be possible and the bound: each finds a
    /// wider path, at least greedily, lowers the bound, or is given up. What is left is the cheapest path of the best width, unless the last search has found that.
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
        let mut ascent = match self.first(floor, shortest) {
            First::Early(path) => {
                on_path(&path);
                let bounds = Bounds { width_at_most: self.graph.cap(), cost_at_least: self.graph.remaining(START) };
                let proof = self.proof(Some(&path), floor, bounds);
                Ascent { found: path, proof, at_most: self.graph.cap(), is_by_cost: false }
            }
            First::Answer(outcome) => match told(outcome, None, on_path) {
                Outcome::Solved { found, proof }
                | Outcome::OutOfBudget { limit: Limit::Precision, best: Some(found), proof } => {
                    let at_most = proof.width_at_most.min(self.graph.cap());
                    Ascent { found, proof, at_most, is_by_cost: true }
                }
                unsolved => return unsolved,
            },
        };
        let limit = ascent.climb(self, shortest, on_path);
        let Ascent { found, proof, at_most, is_by_cost } = ascent;
        let width_at_most = at_most.max(found.width.lower);
        let as_good = self.tie(width_at_most).min(found.width.lower).max(floor);
        if limit.is_some() || (is_by_cost && proof.floor <= as_good) {
            let limit = limit.or((!proof.cost_optimal).then_some(Limit::Precision));
            let bounds = Bounds { width_at_most, cost_at_least: proof.cost_at_least };
            return self.conclude(Some(found), limit, proof.floor, bounds);
        }
        // It was found in a hurry, or the floor of the last search was above the least width that is as good: there may be a cheaper
        // path.
        let answer = shortest(self, as_good);
        let limit = if matches!(answer, Outcome::Impossible) { Some(Limit::Precision) } else { answer.limit() };
        let cost_at_least = answer.proof().map_or(0, |proof| proof.cost_at_least);
        let cheaper = answer.best().filter(|path| path.cost < found.cost).cloned();
        if let Some(path) = &cheaper {
            on_path(path);
        }
        self.conclude(Some(cheaper.unwrap_or(found)), limit, as_good, Bounds { width_at_most, cost_at_least })
    }

    /// Some path of a width of at least `floor`, found greedily; without a limit or a path there is none.
    fn hurry(&mut self, floor: f64) -> ShortestRun {
        self.run_shortest(&Task { greed: GREED, is_trusting: true, ..Task::whole(floor, u32::MAX) })
    }

    /// The least width that counts as more than `width`: half the tolerance above it, so that finding none as wide
    /// proves `width` to be as good as any even where certified intervals are as wide as the other half.
    pub fn wider(&self, width: f64) -> f64 {
        f64::midpoint(width, width + (width - self.tie(width))).max(width.next_up())
    }
}

/// The answer of an engine, with an early path where that is as cheap. What is new goes to `on_path`.
fn told<S, A>(
    outcome: Outcome<Path<S, A>>,
    early: Option<Path<S, A>>,
    on_path: &mut dyn FnMut(&Path<S, A>),
) -> Outcome<Path<S, A>> {
    let mut cheaper = |found: Option<Path<S, A>>, early: Option<Path<S, A>>| match (found, early) {
        (Some(found), Some(early)) if early.cost <= found.cost => Some(early),
        (Some(found), _) => {
            on_path(&found);
            Some(found)
        }
        (None, early) => early,
    };
    match outcome {
        Outcome::Solved { found, proof } => match cheaper(Some(found), early) {
            Some(found) => Outcome::Solved { found, proof },
            None => Outcome::Impossible,
        },
        Outcome::OutOfBudget { limit, best, proof } => {
            let best = cheaper(best, early);
            let cost_optimal = best.as_ref().is_some_and(|path| path.cost <= proof.cost_at_least);
            Outcome::OutOfBudget { limit, best, proof: Proof { cost_optimal, ..proof } }
        }
        Outcome::Impossible => Outcome::Impossible,
    }
}

/// What a search in a hurry and one for the least cost come to, in turns.
enum First<P> {
    /// The one for the least cost ended first.
    Answer(Outcome<P>),
    /// The one in a hurry found a path.
    Early(P),
}

/// The widest path so far, on the way to wider ones.
struct Ascent<P> {
    found: P,
    /// What the search that found it proved.
    proof: Proof,
    /// No path is wider.
    at_most: f64,
    /// Whether that was a search for the least cost.
    is_by_cost: bool,
}

/// How a search with a floor ended.
enum Attempt {
    /// With a wider path.
    Wider,
    /// Nothing is wider than the path in hand.
    Widest,
    /// There is nothing as wide as the floor, but there may be something wider than the path in hand.
    Narrower,
    /// Its share was used up.
    Paused,
    /// A limit ended it.
    Ended(Limit),
}

impl<S, A> Ascent<Path<S, A>>
where
    Path<S, A>: Clone,
{
    /// Climbs until nothing is wider; says what ended it before that was proved.
    fn climb<D: Space<State = S, Action = A>>(
        &mut self,
        search: &mut Search<'_, D>,
        shortest: Shortest<'_, D>,
        on_path: &mut dyn FnMut(&Path<S, A>),
    ) -> Option<Limit> {
        let mut share = FIRST_SHARE;
        if self.is_widest(search) {
            return None;
        }
        loop {
            match self.attempt(search, self.possible(search), share, shortest, on_path) {
                Attempt::Wider => continue,
                Attempt::Widest => return None,
                // Intervals hold the floor.
                Attempt::Narrower => return Some(Limit::Precision),
                Attempt::Ended(limit) => return Some(limit),
                Attempt::Paused => {}
            }
            // Many a bound is attained, since it is that of an end or of a transition that all paths share.
            let mut floor = search.tie(self.at_most);
            loop {
                if !(floor > search.wider(self.possible(search)) && floor.is_finite()) {
                    break;
                }
                match self.attempt(search, floor, share, shortest, on_path) {
                    Attempt::Wider | Attempt::Narrower => {}
                    Attempt::Widest => return None,
                    Attempt::Ended(Limit::Precision) | Attempt::Paused if floor < search.tie(self.at_most) => break,
                    Attempt::Ended(Limit::Precision) | Attempt::Paused => {}
                    Attempt::Ended(limit) => return Some(limit),
                }
                floor = f64::midpoint(self.possible(search), self.at_most);
            }
            share = share.saturating_mul(2);
        }
    }

    /// Looks for a path as wide as `floor`.
    fn attempt<D: Space<State = S, Action = A>>(
        &mut self,
        search: &mut Search<'_, D>,
        floor: f64,
        share: u64,
        shortest: Shortest<'_, D>,
        on_path: &mut dyn FnMut(&Path<S, A>),
    ) -> Attempt {
        search.known = Known {
            width: Some(self.found.width.lower),
            width_at_most: self.at_most,
            cost_at_least: self.proof.cost_at_least,
        };
        let (outcome, is_paused) = search.sharing(share, |search| shortest(search, floor));
        search.known = Known::default();
        self.at_most = self.at_most.min(match &outcome {
            Outcome::Impossible => floor.next_down(),
            Outcome::Solved { proof, .. } | Outcome::OutOfBudget { proof, .. } => proof.width_at_most,
        });
        self.at_most = self.at_most.min(search.classes.width_at_most());
        let mut wider = outcome.best().filter(|path| path.width.lower > self.found.width.lower).cloned();
        let mut is_by_cost = true;
        if wider.is_none() && is_paused {
            (wider, is_by_cost) = (self.hurried(search, floor, share), false);
        }
        let is_wider = wider.is_some();
        if let (Some(path), Some(proof)) = (wider, outcome.proof()) {
            on_path(&path);
            (self.found, self.proof, self.is_by_cost) = (path, *proof, is_by_cost);
        }
        match outcome.limit() {
            _ if self.is_widest(search) => Attempt::Widest,
            _ if is_wider => Attempt::Wider,
            _ if is_paused => Attempt::Paused,
            Some(limit) => Attempt::Ended(limit),
            None => Attempt::Narrower,
        }
    }

    /// A path as wide as `floor` that a greedy search finds, if it does within its share and the space has bounds on remaining
    /// costs to be greedy by.
    fn hurried<D: Space<State = S, Action = A>>(
        &self,
        search: &mut Search<'_, D>,
        floor: f64,
        share: u64,
    ) -> Option<Path<S, A>> {
        if search.graph.remaining(START) == 0 {
            return None;
        }
        let (run, _) = search.sharing(share, |search| search.hurry(floor));
        let path = search.path(&run.best?);
        (path.width.lower > self.found.width.lower).then_some(path)
    }

    /// The least width that a wider path has, or a larger one that some path is known to have.
    fn possible<D: Space>(&self, search: &Search<'_, D>) -> f64 {
        let wider = search.wider(self.found.width.lower);
        search.classes.joined.map_or(wider, |joined| joined.max(wider))
    }

    fn is_widest<D: Space>(&self, search: &Search<'_, D>) -> bool {
        self.found.width.lower >= search.tie(self.at_most)
    }
}
