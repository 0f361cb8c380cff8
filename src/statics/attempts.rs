//! Asks the general solver where the block's own method did not prove enough.
//!
//! Knows in which ways to ask, nothing of what becomes of the answers.

use super::assessment::Question;
use super::best::Best;
use super::bracket::Problem;
use super::conic::{self, Attempt};
use super::program::Program;

/// Ways of asking the general solver where that was not enough, tried in turn
/// until the bracket is tight enough.
/// Each bound keeps the best that any of them proved.
/// A positive inset suits structures that cannot clamp themselves; a negative one
/// those that can, since it keeps their self-stress bounded.
pub(super) const ATTEMPTS: [Attempt; 6] = [
    Attempt { tolerance: 1e-9, inset: 1e-8, regularization: 1e-8 },
    Attempt { tolerance: 1e-9, inset: -1e-8, regularization: 1e-8 },
    Attempt { tolerance: 1e-11, inset: 1e-9, regularization: 1e-9 },
    Attempt { tolerance: 1e-11, inset: -1e-9, regularization: 1e-9 },
    Attempt { tolerance: 1e-7, inset: -1e-6, regularization: 1e-7 },
    Attempt { tolerance: 1e-12, inset: 0.0, regularization: 1e-10 },
];

impl Best {
    /// Asks the general solver, in every way there is.
    pub(super) fn ask_generally(&mut self, problem: &Problem<'_>, even: &Program, first: usize, question: Question) {
        self.lower_strengths(problem, ATTEMPTS[first].inset, question);
        for attempt in ATTEMPTS[first..].iter().chain(&ATTEMPTS[..first]) {
            if self.answers(question) {
                return;
            }
            if let Some(iterate) = conic::solve(problem.program, attempt) {
                self.improve(problem, &iterate, question);
            }
        }
        for attempt in &ATTEMPTS[..2] {
            if self.answers(question) {
                return;
            }
            if let Some(iterate) = conic::solve(even, attempt) {
                self.improve(problem, &iterate.measured(even, problem.program), question);
            }
        }
    }
}
