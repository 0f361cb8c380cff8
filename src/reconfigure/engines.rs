//! What is asked of the search engines, and what a report makes of their answers: the same for every
//! family of robots.
//!
//! Knows objectives, budgets and proofs; does not know what a state or an action is.

use std::cell::RefCell;
use std::hash::Hash;
use std::time::Instant;

use planners::{Budget, PathOf, Progress, Search, Shortest, Space};

use super::herald::Herald;
use super::options::{Event, Options};
use super::plan::{Objective, Outcome, Plan, Proof, Report, Statistics};
use super::refusal::Impossible;

/// Two margins this close, relative to the larger of 1 and the margin, are
/// equally good: what the oracle's brackets are guaranteed to resolve.
pub const MARGIN_TOLERANCE: f64 = 1e-6;

/// How paths of a space become plans of a robot.
pub trait Translation<S: Space> {
    /// What the plans do.
    type Action: Clone;
    /// What names a connection of the robot.
    type Connection: Clone;
    /// What plans that differ in no more than the order of independent moves have in common.
    type Key: Hash + Eq;

    /// The key of a path from the start, by its actions.
    fn key(&self, path: &[S::Action]) -> Self::Key;

    /// The plan that follows a path from the start, by its actions.
    fn plan(&self, path: &[S::Action]) -> Plan<Self::Action, Self::Connection>;
}

/// What a translation's searches tell.
pub type EventOf<T, S> = Event<<T as Translation<S>>::Action, <T as Translation<S>>::Connection>;

/// The plans that a translation makes.
pub type ReportOf<T, S> = Report<<T as Translation<S>>::Action, <T as Translation<S>>::Connection>;

/// One search.
pub struct Task<'a> {
    /// What is wanted.
    pub options: &'a Options,
    /// Margin that every transient state must have; `None` where plans are made by geometry alone.
    pub required: Option<f64>,
    /// When planning began.
    pub began: Instant,
    /// How many structures the oracle has assessed.
    pub solves: &'a dyn Fn() -> u64,
}

impl Task<'_> {
    /// Searches a space by best-first search alone.
    pub fn run<S: Space, T: Translation<S>>(
        &self,
        space: &S,
        translation: &T,
        on_event: &mut dyn FnMut(&EventOf<T, S>),
    ) -> ReportOf<T, S> {
        self.run_with(space, translation, &|search, floor| search.shortest(floor), on_event)
    }

    /// Searches a space whose shortest paths are found by `shortest`, given the least width.
    pub fn run_with<S: Space, T: Translation<S>>(
        &self,
        space: &S,
        translation: &T,
        shortest: Shortest<'_, S>,
        on_event: &mut dyn FnMut(&EventOf<T, S>),
    ) -> ReportOf<T, S> {
        let floor = self.required.unwrap_or(f64::NEG_INFINITY);
        let herald = RefCell::new(Herald::new(on_event));
        let mut on_progress = |progress: &Progress| herald.borrow_mut().progress(progress, (self.solves)());
        let mut told = None;
        let mut on_path = |path: &PathOf<S>| {
            let plan = translation.plan(&actions::<S>(path));
            told = Some((path.cost, path.width, plan.clone()));
            herald.borrow_mut().plan(plan, (self.solves)());
        };
        let mut search = Search::new(space, self.search_options()).on_progress(&mut on_progress);
        let outcome = match self.options.objective {
            Objective::Margin => search.anytime_margin(floor, shortest, &mut on_path),
            Objective::Moves => search.anytime_shortest(floor, shortest, &mut on_path),
        };
        let mut found: Vec<Vec<S::Action>> = outcome.best().map(actions::<S>).into_iter().collect();
        let mut cut_by = outcome.limit();
        if let planners::Outcome::Solved { found: best, .. } = &outcome
            && self.options.plans > 1
        {
            let as_good = match self.options.objective {
                Objective::Margin => search.tie(best.width.lower).max(floor),
                Objective::Moves => floor,
            };
            let key = |path: &[S::Action]| translation.key(path);
            let further = search.k_best(self.options.plans, as_good, key);
            further_plans(&mut found, further.best().into_iter().flatten().map(actions::<S>), key);
            found.truncate(self.options.plans);
            cut_by = further.limit();
        }
        let wants_more = self.options.plans > 1 && found.len() < self.options.plans;
        let statistics = search.statistics();
        drop(search);
        // The best one was told before it was returned.
        let plan = outcome.best().map(|best| match told {
            Some((cost, width, plan)) if (cost, width) == (best.cost, best.width) => plan,
            _ => translation.plan(&actions::<S>(best)),
        });
        let plans = found.iter().skip(1).map(|path| translation.plan(path));
        let (ending, proof) = self.conclude(&outcome, plan.is_some());
        Report {
            outcome: ending,
            objective: self.options.objective,
            required: self.required,
            plan,
            alternatives: plans.collect(),
            alternatives_cut_by: cut_by.filter(|_| wants_more),
            proof,
            statistics: Statistics {
                expanded: statistics.expanded,
                states: statistics.states as u64,
                generated: statistics.generated,
                certified: statistics.certified,
                bytes: statistics.bytes as u64,
                ..Statistics::default()
            },
        }
    }

    fn search_options(&self) -> planners::Options {
        let budget = Budget {
            deadline: self.options.time_limit.and_then(|limit| self.began.checked_add(limit)),
            max_expansions: self.options.max_expansions,
            max_bytes: self.options.max_bytes,
            measure_bytes: self.options.measure_bytes,
            cancel: self.options.cancel.clone(),
        };
        planners::Options { tolerance: MARGIN_TOLERANCE, budget, ..planners::Options::default() }
    }

    fn conclude<P, C>(&self, outcome: &planners::Outcome<P>, has_plan: bool) -> (Outcome<C>, Proof) {
        let optimal = |proof: &planners::Proof| match self.options.objective {
            Objective::Margin => proof.cost_optimal && (proof.width_optimal || self.required.is_none()),
            Objective::Moves => proof.cost_optimal,
        };
        let ending = match outcome {
            planners::Outcome::Solved { .. } => Outcome::Solved,
            planners::Outcome::Impossible => {
                let required = self.required.unwrap_or(f64::NEG_INFINITY);
                Outcome::Impossible(Impossible::Exhausted { required })
            }
            planners::Outcome::OutOfBudget { limit, .. } => Outcome::OutOfBudget(*limit),
        };
        let proof = outcome.proof().map_or(Proof::NOTHING_TO_FIND, |proof| Proof {
            optimal: has_plan && optimal(proof),
            margin_at_most: proof.width_at_most,
            moves_at_least: proof.cost_at_least,
        });
        (ending, proof)
    }
}

/// What a path does.
fn actions<S: Space>(path: &PathOf<S>) -> Vec<S::Action> {
    path.steps.iter().map(|step| step.action.clone()).collect()
}

/// Adds the paths that are not among those found by their key.
fn further_plans<A, K: Eq>(found: &mut Vec<Vec<A>>, further: impl Iterator<Item = Vec<A>>, key: impl Fn(&[A]) -> K) {
    for path in further {
        if found.iter().all(|known| key(known) != key(&path)) {
            found.push(path);
        }
    }
}
