//! What is asked of the search engines, and what a report makes of their answers: the same for every
//! family of robots.
//!
//! Knows objectives, budgets and proofs; does not know what a state or an action is.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::hash::Hash;
use std::time::{Duration, Instant};

use planners::{Budget, Limit, PathOf, Progress, Search, Shortest, Space};

use super::herald::Herald;
use super::in_the_way::InTheWay;
use super::options::{Event, Options};
use super::plan::{Objective, Outcome, Plan, Proof, Report, Statistics};
use super::refusal::Impossible;

/// Two margins this close, relative to the larger of 1 and the margin, are
/// equally good: what the oracle's brackets are guaranteed to resolve.
pub const MARGIN_TOLERANCE: f64 = 1e-6;

/// Expansions that an explanation has at least.
const EXPLANATION: u64 = 2000;

/// Time that an explanation has at least, where there is a limit at all.
const SHORTEST_EXPLANATION: Duration = Duration::from_secs(1);

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

/// Which modules are where they were at the start in all of some states, where that can be told.
pub type Unmoved<'u, S> = &'u dyn Fn(&[&<S as Space>::State]) -> Option<Vec<usize>>;

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
        let answer = match self.options.objective {
            Objective::Margin | Objective::Moves => {
                self.ranked(&mut search, shortest, floor, translation, &mut on_path)
            }
            Objective::Pareto => Answer::of_front(search.pareto(floor, shortest, &mut on_path)),
        };
        let statistics = search.statistics();
        drop(search);
        let plans = answer.found.iter().enumerate().map(|(index, path)| match &told {
            // The best one was told before it was returned.
            Some((cost, width, plan)) if index == 0 && (*cost, *width) == (path.cost, path.width) => plan.clone(),
            _ => translation.plan(&actions::<S>(path)),
        });
        let mut plans: VecDeque<_> = plans.collect();
        let plan = plans.pop_front();
        let (ending, proof) = self.conclude(&answer, plan.is_some());
        Report {
            outcome: ending,
            objective: self.options.objective,
            required: self.required,
            plan,
            alternatives: plans.into(),
            alternatives_cut_by: answer.cut_by,
            in_the_way: None,
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
        let budget = budget(self.options, self.began);
        planners::Options { tolerance: MARGIN_TOLERANCE, budget, ..planners::Options::default() }
    }

    /// What is in the way of a plan, by a search that takes about as long again as the one before. `unmoved` says which
    /// modules are where they were at the start in all of some states.
    pub fn in_the_way<S: Space, T: Translation<S>>(
        &self,
        space: &S,
        translation: &T,
        report: &ReportOf<T, S>,
        unmoved: Unmoved<'_, S>,
    ) -> Option<InTheWay<T::Action, T::Connection>>
    where
        T::Connection: Copy + PartialEq,
    {
        let is_cancelled = matches!(report.outcome, Outcome::OutOfBudget(Limit::Cancelled));
        let is_asked = self.options.explain && report.plan.is_none() && !is_cancelled;
        let required = self.required.filter(|_| is_asked)?;
        let mut options = self.search_options();
        options.budget.deadline = self.options.time_limit.map(|_| {
            let so_far = self.began.elapsed();
            Instant::now() + (so_far / 4).max(SHORTEST_EXPLANATION)
        });
        options.budget.max_expansions = Some(report.statistics.expanded.saturating_mul(2).max(EXPLANATION));
        let mut search = Search::new(space, options);
        // With a path in hand early, whatever ends it.
        let shortest: Shortest<'_, S> = &|search, floor| search.shortest(floor);
        let widest = search.anytime_margin(f64::NEG_INFINITY, shortest, &mut |_| {});
        let plan = widest.best().map(|path| translation.plan(&actions::<S>(path)));
        let at_most = widest.proof().map_or(f64::NEG_INFINITY, |proof| proof.width_at_most);
        let mut found = InTheWay::new(plan, at_most, required);
        found.cut_by = widest.limit();
        // The goal is out of reach with the margin required: the search sees every state that is not.
        if matches!(search.shortest(required), planners::Outcome::Impossible) {
            found.never_move = unmoved(&search.reached(required));
        }
        Some(found)
    }

    /// The best path, and where more are wanted those that come next.
    fn ranked<S: Space, T: Translation<S>>(
        &self,
        search: &mut Search<'_, S>,
        shortest: Shortest<'_, S>,
        floor: f64,
        translation: &T,
        on_path: &mut dyn FnMut(&PathOf<S>),
    ) -> Answer<PathOf<S>> {
        let is_by_margin = self.options.objective == Objective::Margin;
        let outcome = match is_by_margin {
            true => search.anytime_margin(floor, shortest, on_path),
            false => search.anytime_shortest(floor, shortest, on_path),
        };
        let mut answer = Answer::of_best(outcome);
        if let (Ending::Solved, Some(best)) = (answer.ending, answer.found.first())
            && self.options.plans > 1
        {
            let key = |path: &[S::Action]| translation.key(path);
            let width = best.width.lower;
            let further = match is_by_margin {
                true => search.ranked(self.options.plans, floor, width, key),
                false => search.k_best(self.options.plans, floor, key),
            };
            for path in further.best().into_iter().flatten() {
                let is_new = |known: &PathOf<S>| key(&actions::<S>(known)) != key(&actions::<S>(path));
                if answer.found.len() < self.options.plans && answer.found.iter().all(is_new) {
                    answer.found.push(path.clone());
                }
            }
            if !is_by_margin {
                answer.found.sort_by(|a, b| a.cost.cmp(&b.cost).then(b.width.lower.total_cmp(&a.width.lower)));
            }
            answer.cut_by = further.limit().filter(|_| answer.found.len() < self.options.plans);
        }
        answer
    }

    fn conclude<P, C>(&self, answer: &Answer<P>, has_plan: bool) -> (Outcome<C>, Proof) {
        let optimal = |proof: &planners::Proof| match self.options.objective {
            Objective::Margin => proof.cost_optimal && (proof.width_optimal || self.required.is_none()),
            Objective::Moves => proof.cost_optimal,
            Objective::Pareto => answer.ending == Ending::Solved,
        };
        let ending = match answer.ending {
            Ending::Solved => Outcome::Solved,
            Ending::Impossible => {
                let required = self.required.unwrap_or(f64::NEG_INFINITY);
                Outcome::Impossible(Impossible::Exhausted { required })
            }
            Ending::OutOfBudget(limit) => Outcome::OutOfBudget(limit),
        };
        let proof = answer.proof.as_ref().map_or(Proof::NOTHING_TO_FIND, |proof| Proof {
            optimal: has_plan && optimal(proof),
            margin_at_most: proof.width_at_most,
            moves_at_least: proof.cost_at_least,
        });
        (ending, proof)
    }
}

/// How a search ended.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Ending {
    Solved,
    Impossible,
    OutOfBudget(Limit),
}

/// What the engines answer, whichever they are.
struct Answer<P> {
    ending: Ending,
    /// Best first.
    found: Vec<P>,
    proof: Option<planners::Proof>,
    /// What ended the search for further paths.
    cut_by: Option<Limit>,
}

impl<P> Answer<P> {
    fn of_best(outcome: planners::Outcome<P>) -> Self {
        let proof = outcome.proof().copied();
        let (ending, found) = match outcome {
            planners::Outcome::Solved { found, .. } => (Ending::Solved, Some(found)),
            planners::Outcome::Impossible => (Ending::Impossible, None),
            planners::Outcome::OutOfBudget { limit, best, .. } => (Ending::OutOfBudget(limit), best),
        };
        Self { ending, found: found.into_iter().collect(), proof, cut_by: None }
    }

    /// A front, the widest first.
    fn of_front(outcome: planners::Outcome<Vec<P>>) -> Self {
        let Answer { ending, found, proof, cut_by } = Answer::of_best(outcome);
        let mut found: Vec<P> = found.into_iter().flatten().collect();
        found.reverse();
        Self { ending, found, proof, cut_by }
    }
}

/// What may be spent on planning that began then.
pub fn budget(options: &Options, began: Instant) -> Budget {
    Budget {
        deadline: options.time_limit.and_then(|limit| began.checked_add(limit)),
        max_expansions: options.max_expansions,
        max_bytes: options.max_bytes,
        measure_bytes: options.measure_bytes,
        cancel: options.cancel.clone(),
    }
}

/// What a path does.
fn actions<S: Space>(path: &PathOf<S>) -> Vec<S::Action> {
    path.steps.iter().map(|step| step.action.clone()).collect()
}
