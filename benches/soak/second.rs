//! The second method's opinion on a structure, where it can be sure of it, and that of
//! the same solver with twice the digits.

use steadfast::statics::{Assessment, Bracket, Structure, Verdict};

use super::paper::{self, Answer};
use super::reference::{Missing, Reference, estimated};

/// Tolerances that it is asked at. Where the first does not agree with the oracle, it
/// is sure if all of them give one answer: one status alone is not to be believed.
const TOLERANCES: [f64; 3] = [1e-8, 1e-6, 1e-9];

/// Relative distance between two of its values that still count as one.
const SAME: f64 = 1e-4;

/// What the second method is sure of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Opinion {
    /// The utilisation, up to [`SAME`] of the larger of it and 1.
    Utilisation(f64),
    /// No strength suffices.
    Infeasible,
    /// It contradicts itself or gave up.
    None,
}

/// Asks the second method about `structure`, once if it agrees with `answer` at
/// once, and otherwise until it is sure.
pub fn opinion(structure: &Structure, answer: &Assessment) -> Opinion {
    let mut sure = None;
    for (asked, tolerance) in TOLERANCES.into_iter().enumerate() {
        let opinion = match (paper::solve(structure, tolerance), sure) {
            (Answer::Utilisation(t), Some(Opinion::Utilisation(before))) => {
                if !((t - before).abs() <= SAME * t.max(1.0)) {
                    return Opinion::None;
                }
                Opinion::Utilisation(t)
            }
            (Answer::Utilisation(t), None) => Opinion::Utilisation(t),
            (Answer::Infeasible, None | Some(Opinion::Infeasible)) => Opinion::Infeasible,
            _ => return Opinion::None,
        };
        if asked == 0 && opinion.contradiction(answer).is_none() {
            return opinion;
        }
        sure = Some(opinion);
    }
    sure.unwrap_or(Opinion::None)
}

/// Whether the standard form in double-double arithmetic is sure of `answer`: that some
/// value in its bracket, up to `width`, is the utilisation, or that no strength suffices.
pub fn twice_the_digits_agree(structure: &Structure, answer: &Assessment, width: f64) -> bool {
    let Bracket { lower, upper } = answer.utilisation;
    match estimated(structure) {
        Ok(Reference { value, uncertainty }) => {
            let room = width * value.max(1.0);
            let close = lower - room <= value && value <= upper + room;
            close && upper.is_finite() && uncertainty <= SAME * value.max(1.0)
        }
        Err(Missing::Infeasible) => answer.verdict == Verdict::WholeBodyUnstable,
        Err(Missing::Vague(_)) => false,
    }
}

impl Opinion {
    /// In which words it contradicts the oracle's answer; what the oracle leaves
    /// open it cannot contradict.
    pub fn contradiction(&self, answer: &Assessment) -> Option<String> {
        let Bracket { lower, upper } = answer.utilisation;
        let agrees = match *self {
            Self::None => true,
            Self::Infeasible => upper.is_infinite(),
            Self::Utilisation(t) => {
                let room = 2.0 * SAME * t.max(1.0);
                answer.verdict != Verdict::WholeBodyUnstable && lower - room <= t && t <= upper + room
            }
        };
        (!agrees).then(|| format!("{:?} [{lower}, {upper}], but the second method says {self:?}", answer.verdict))
    }
}
