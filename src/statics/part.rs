//! The answer for one block.

use crate::spatial::{Twist, Wrench};

use super::assessment::{Bracket, Question};
use super::rung::Rung;

/// What was found out about one block.
pub(super) enum Part {
    /// It can stand if its connections are strong enough, or that is not excluded.
    Stands {
        utilisation: Bracket,
        /// Wrench per link of the block, in its frame.
        wrenches: Vec<Wrench>,
        /// Utilisation that each of those wrenches demands.
        demands: Vec<f64>,
        /// Twist per body of the block that proves the lower bound.
        mechanism: Vec<Twist>,
        /// Share of each link in the mechanism's dissipation.
        shares: Vec<f64>,
        /// Why the bracket is wider than asked for.
        undecided_because: Option<String>,
        /// What the answer took.
        decided_by: Rung,
        /// Where the solver was stopped early: its fields, which prove only what
        /// was asked for but may be near what would prove the rest.
        unproved: Option<(Vec<Wrench>, Vec<Twist>)>,
    },
    /// No strength helps: the motion per body of the block that proves it.
    Collapses {
        mechanism: Vec<Twist>,
        /// What the answer took.
        decided_by: Rung,
    },
}

impl Part {
    /// Whether this is as much as `question` wants to know about the block when others
    /// need `elsewhere` at least.
    pub(super) fn answers(&self, question: Question, elsewhere: f64) -> bool {
        match self {
            Self::Stands { utilisation, .. } => utilisation.upper <= elsewhere || question.is_answered_by(utilisation),
            Self::Collapses { .. } => true,
        }
    }

    /// Whether this answers `question` for the whole structure, whatever its other blocks do.
    pub(super) fn settles(&self, question: Question) -> bool {
        match (self, question) {
            (Self::Collapses { .. }, _) => true,
            (Self::Stands { utilisation, .. }, Question::Decide(threshold)) => utilisation.lower > threshold,
            (Self::Stands { .. }, Question::ToGap(_) | Question::Full) => false,
        }
    }
}
