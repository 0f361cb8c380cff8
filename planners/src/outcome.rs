//! What a search answers. An approximate answer cannot be read as a proved one.

use crate::budget::Limit;
use crate::space::Width;

/// One transition of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Step<S, A> {
    /// What is done.
    pub action: A,
    /// The state that it leads to.
    pub to: S,
    /// Its cost.
    pub cost: u32,
    /// Its certified width.
    pub width: Width,
}

/// A path from the start to a goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Path<S, A> {
    /// Its transitions; none if the start is a goal.
    pub steps: Vec<Step<S, A>>,
    /// Sum of the costs.
    pub cost: u32,
    /// Smallest width of the transitions, [`Width::UNLIMITED`] without any.
    pub width: Width,
}

impl<S, A> Path<S, A> {
    pub(crate) fn new(steps: Vec<Step<S, A>>) -> Self {
        let cost = steps.iter().fold(0, |sum: u32, step| sum.saturating_add(step.cost));
        let width = steps.iter().fold(Width::UNLIMITED, |width, step| width.in_series(step.width));
        Path { steps, cost, width }
    }
}

/// What has been proved about **all** paths, found or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proof {
    /// No path is wider than this.
    pub width_at_most: f64,
    /// Whether the path found is as wide as any, within the tolerance.
    pub width_optimal: bool,
    /// The width that `cost_at_least` speaks of.
    pub floor: f64,
    /// No path whose width is at least `floor` costs less than this; for
    /// [`Search::k_best`](crate::Search::k_best), none except those found.
    pub cost_at_least: u32,
    /// Whether the path found costs as little as any whose width is at least
    /// `floor`; for [`Search::k_best`](crate::Search::k_best), whether
    /// those found are the first ones.
    pub cost_optimal: bool,
}

/// The answer of a search; `T` is a [`Path`] or a list of them.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome<T> {
    /// What was asked for, proved as the engine's guarantees say.
    Solved {
        /// The answer.
        found: T,
        /// What was proved.
        proof: Proof,
    },
    /// Proved by exhaustion: there is no path at least as wide as asked.
    Impossible,
    /// Neither found and proved, nor proved impossible.
    OutOfBudget {
        /// What ended the search.
        limit: Limit,
        /// The best found until then.
        best: Option<T>,
        /// What was proved until then.
        proof: Proof,
    },
}

impl<T> Outcome<T> {
    /// The answer if it is proved.
    pub fn solved(&self) -> Option<&T> {
        match self {
            Outcome::Solved { found, .. } => Some(found),
            Outcome::Impossible | Outcome::OutOfBudget { .. } => None,
        }
    }

    /// The best that was found, proved or not.
    pub fn best(&self) -> Option<&T> {
        match self {
            Outcome::Solved { found, .. } => Some(found),
            Outcome::Impossible => None,
            Outcome::OutOfBudget { best, .. } => best.as_ref(),
        }
    }

    /// What ended the search before it was done, if something did.
    pub fn limit(&self) -> Option<Limit> {
        match self {
            Outcome::OutOfBudget { limit, .. } => Some(*limit),
            Outcome::Solved { .. } | Outcome::Impossible => None,
        }
    }

    /// What was proved, unless that is impossibility.
    pub fn proof(&self) -> Option<&Proof> {
        match self {
            Outcome::Solved { proof, .. } | Outcome::OutOfBudget { proof, .. } => Some(proof),
            Outcome::Impossible => None,
        }
    }
}
