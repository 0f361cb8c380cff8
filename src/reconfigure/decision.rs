//! Whether a move has a margin of at least so much, with as few values as that takes.
//!
//! The margin of a move is that of its worst sample, around which more are taken (see [`worst`](super::worst)). Only
//! the worst has to be known for that; of every other sample it is enough that it is no worse. So samples are
//! compared with the worst so far, by decisions, and a value is asked for only where a sample is worse.
//!
//! Knows margins and phases; knows neither robots nor the oracle.

use rayon::prelude::*;

use crate::statics::Bracket;

use super::worst::{Sampling, Worst};

/// Samples closer than this to the worst, relative to the larger of 1 and its margin, need not be told from it:
/// as much as a value leaves open.
const AS_BAD: f64 = 1e-7;

/// Samples that are compared with the same worst one, whether threads look at them together or not: so the
/// result does not depend on their number.
const TOGETHER: usize = 4;

/// What is asked about the margin of a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// Whether it is at least this.
    AtLeast(f64),
    /// What it is.
    Value,
}

/// The worst sample of a move of which the `first` is known in value. `Err` with the first sample that is
/// proved to be below `floor`.
pub fn of_course<C: Copy + Send + Sync>(
    sampling: Sampling,
    first: (f64, Worst<C>),
    floor: f64,
    ask: &(impl Fn(f64, Wanted) -> Worst<C> + Sync),
) -> Result<Worst<C>, Worst<C>> {
    let initial: Vec<f64> = sampling.initial_phases().filter(|&phase| phase != first.0).collect();
    let mut samples = Samples { floor, worst: first.0, taken: vec![first] };
    samples.take(&initial, ask)?;
    loop {
        samples.taken.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let middles = sampling.around(&samples.taken, samples.worst_index());
        if middles.is_empty() {
            let margin = samples.taken.iter().map(|(_, sample)| sample.margin).reduce(Bracket::min);
            let margin = margin.expect("a move has samples");
            return Ok(Worst { margin, ..samples.taken[samples.worst_index()].1 });
        }
        samples.take(&middles, ask)?;
    }
}

/// Samples of a move.
struct Samples<C> {
    floor: f64,
    /// Phase of the worst, whose value is known.
    worst: f64,
    taken: Vec<(f64, Worst<C>)>,
}

impl<C: Copy + Send + Sync> Samples<C> {
    fn worst_index(&self) -> usize {
        self.taken.iter().position(|(phase, _)| *phase == self.worst).expect("the worst is one of those taken")
    }

    /// The margin that shows that a sample is no worse than the worst, and not out if that one is not.
    fn no_worse(&self) -> f64 {
        let worst = self.taken[self.worst_index()].1.margin.lower;
        let slightly_worse = worst - AS_BAD * worst.abs().max(1.0);
        if self.floor <= worst { slightly_worse.max(self.floor) } else { slightly_worse }
    }

    /// Takes samples at these phases; `Err` with the first that is out.
    fn take(&mut self, phases: &[f64], ask: &(impl Fn(f64, Wanted) -> Worst<C> + Sync)) -> Result<(), Worst<C>> {
        for together in phases.chunks(TOGETHER) {
            let (floor, enough) = (self.floor, self.no_worse());
            let sample = |&phase: &f64| {
                let compared = ask(phase, Wanted::AtLeast(enough));
                let is_known = compared.margin.lower >= enough || compared.is_out(floor);
                if is_known { (compared, false) } else { (ask(phase, Wanted::Value), true) }
            };
            let samples: Vec<(Worst<C>, bool)> = together.par_iter().map(sample).collect();
            for (&phase, (sample, is_value)) in together.iter().zip(samples) {
                if sample.is_out(floor) {
                    return Err(sample);
                }
                self.taken.push((phase, sample));
                if is_value && sample.margin.lower < self.taken[self.worst_index()].1.margin.lower {
                    self.worst = phase;
                }
            }
        }
        Ok(())
    }
}
