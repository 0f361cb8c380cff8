//! Which rung of the oracle's ladder an answer came from, and how often each did.

use super::assessment::Assessment;

/// What it took to answer, from the cheapest to the dearest.
///
/// A structure falls into blocks; its answer counts as what its dearest block took.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Rung {
    /// Balance alone: nothing was optimised.
    ClosedForm,
    /// The fields of a neighbouring state, carried over, see [`assess_near`](super::assess_near).
    CarriedOver,
    /// The iteration, stopped as soon as its bounds answered.
    StoppedEarly,
    /// The iteration to its end.
    Solved,
    /// The general solver, after the iteration had not been enough.
    SolvedGenerally,
}

impl Rung {
    /// Every rung, from the cheapest to the dearest.
    pub const ALL: [Self; 5] =
        [Self::ClosedForm, Self::CarriedOver, Self::StoppedEarly, Self::Solved, Self::SolvedGenerally];

    /// Whether nothing was solved.
    pub fn is_without_solve(self) -> bool {
        self <= Self::CarriedOver
    }
}

/// How many answers each rung gave.
///
/// ```
/// use steadfast::statics::{Question, Rung, Structure, Tally, assess};
///
/// let mut tally = Tally::default();
/// tally.count(&assess(&Structure::default(), Question::VALUE).unwrap());
/// assert_eq!((tally.of(Rung::ClosedForm), tally.total()), (1, 1));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    counts: [u64; Rung::ALL.len()],
}

impl Tally {
    /// Counts one answer.
    pub fn count(&mut self, answer: &Assessment) {
        self.add(answer.decided_by, 1);
    }

    /// Counts so many answers of one rung.
    pub fn add(&mut self, rung: Rung, times: u64) {
        self.counts[rung as usize] += times;
    }

    /// Adds what was counted elsewhere, e.g. by another thread.
    pub fn merge(&mut self, other: &Self) {
        Rung::ALL.into_iter().for_each(|rung| self.add(rung, other.of(rung)));
    }

    /// Answers of one rung.
    pub fn of(&self, rung: Rung) -> u64 {
        self.counts[rung as usize]
    }

    /// All answers.
    pub fn total(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Share of the answers that no solver was asked for; 1 when there are none.
    pub fn share_without_solve(&self) -> f64 {
        let without: u64 = Rung::ALL.iter().filter(|rung| rung.is_without_solve()).map(|&rung| self.of(rung)).sum();
        if self.total() == 0 { 1.0 } else { without as f64 / self.total() as f64 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statics::{Question, Structure, assess};

    #[test]
    fn rungs_are_numbered_as_listed() {
        assert!(Rung::ALL.iter().enumerate().all(|(number, rung)| *rung as usize == number));
        assert!(Rung::ALL.is_sorted());
    }

    #[test]
    fn tallies_add_up() {
        let mut answer = assess(&Structure::default(), Question::VALUE).expect("nothing is sound");
        let (mut one, mut other) = (Tally::default(), Tally::default());
        for rung in Rung::ALL {
            answer.decided_by = rung;
            one.count(&answer);
            other.count(&answer);
        }
        other.count(&answer);
        one.merge(&other);
        assert_eq!((one.total(), one.of(Rung::Solved), one.of(Rung::SolvedGenerally)), (11, 2, 3));
        assert!((one.share_without_solve() - 4.0 / 11.0).abs() < 1e-15);
    }
}
