//! The second method's opinion on a structure, where it can be sure of it.

use steadfast::statics::{Assessment, Bracket, Structure, Verdict};

use super::paper::{self, Answer};

/// Tolerances that it is asked at. It is sure where all of them give one answer:
/// one status alone is not to be believed.
const TOLERANCES: [f64; 3] = [1e-6, 1e-8, 1e-9];

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

/// Asks the second method about `structure`.
pub fn opinion(structure: &Structure) -> Opinion {
    let answers = TOLERANCES.map(|tolerance| paper::solve(structure, tolerance));
    let mut last = None;
    for answer in answers {
        match (answer, last) {
            (Answer::GaveUp(_), _) => return Opinion::None,
            (Answer::Utilisation(t), Some(Answer::Utilisation(before))) => {
                if !((t - before).abs() <= SAME * t.max(1.0)) {
                    return Opinion::None;
                }
            }
            (_, None) | (Answer::Infeasible, Some(Answer::Infeasible)) => {}
            _ => return Opinion::None,
        }
        last = Some(answer);
    }
    match last {
        Some(Answer::Utilisation(t)) => Opinion::Utilisation(t),
        Some(Answer::Infeasible) => Opinion::Infeasible,
        Some(Answer::GaveUp(_)) | None => Opinion::None,
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
