//! The worst of some states, and how the phases of a move are sampled to find it.
//!
//! Knows margins and phases; knows neither robots nor the oracle.

use std::sync::atomic::{AtomicU64, Ordering};

use rayon::prelude::*;

use crate::statics::Bracket;

/// When a margin is attained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instant {
    /// At this phase of a move, from 0 to 1.
    Phase(f64),
    /// In a state at rest.
    Rest,
}

impl Instant {
    /// Phase of the move that it is of; at rest, the end.
    pub const fn phase(self) -> f64 {
        match self {
            Self::Phase(phase) => phase,
            Self::Rest => 1.0,
        }
    }
}

/// The worst of some states; `C` names a connection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst<C> {
    /// Smallest margin.
    pub margin: Bracket,
    /// When.
    pub instant: Instant,
    /// The connection that is weakest then, if any holds at all.
    pub weakest: Option<C>,
}

impl<C> Worst<C> {
    /// The worse of two; of equals the first.
    #[must_use]
    pub fn or_worse(self, other: Self) -> Self {
        let margin = self.margin.min(other.margin);
        if other.margin.lower < self.margin.lower { Self { margin, ..other } } else { Self { margin, ..self } }
    }

    /// What is known when other states were not asked about.
    #[must_use]
    pub fn cut_short(self) -> Self {
        Self { margin: Bracket::new(f64::NEG_INFINITY, self.margin.upper), ..self }
    }

    /// Whether no more need be known of what this is a part of.
    pub fn is_out(&self, floor: f64) -> bool {
        self.margin.upper < floor || self.margin.upper == f64::NEG_INFINITY
    }
}

/// At which phases a move is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sampling {
    /// In how many equal steps before refinement.
    pub steps: u32,
    /// The distance in phase below which samples around the worst are not refined further.
    pub resolution: f64,
}

impl Sampling {
    /// The phases before refinement: the middle and the ends first, which are out most often.
    pub fn initial_phases(self) -> impl Iterator<Item = f64> {
        let steps = self.steps;
        let mut first = vec![steps / 2, steps, 0];
        first.dedup();
        let others: Vec<u32> = (1..steps).filter(|i| !first.contains(i)).collect();
        first.into_iter().chain(others).map(move |i| f64::from(i) / f64::from(steps))
    }

    /// The phases at which samples, sorted, are refined around the worst: half-way to its neighbours, if they are far.
    pub fn around<C>(self, samples: &[(f64, Worst<C>)], worst: usize) -> Vec<f64> {
        let around = [worst.checked_sub(1).map(|before| [before, worst]), Some([worst, worst + 1])];
        let gaps = around.into_iter().flatten().filter(|&[_, high]| high < samples.len());
        let gaps = gaps.map(|[a, b]| [samples[a].0, samples[b].0]);
        let wide = gaps.filter(|[low, high]| high - low >= self.resolution);
        wide.map(|[low, high]| f64::midpoint(low, high)).collect()
    }
}

/// The worst sample of a move, refined; `Err` with the first that is out at `floor`. The result, and the number of
/// samples that it adds to `asked`, does not depend on the number of threads.
pub fn of_course<C: Copy + Send>(
    sampling: Sampling,
    ask: &(impl Fn(f64) -> Worst<C> + Sync),
    floor: f64,
    asked: &AtomicU64,
) -> Result<Worst<C>, Worst<C>> {
    let initial: Vec<f64> = sampling.initial_phases().collect();
    let mut samples = sample(ask, &initial, floor, asked)?;
    loop {
        samples.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let worst = (0..samples.len())
            .min_by(|&a, &b| samples[a].1.margin.lower.total_cmp(&samples[b].1.margin.lower))
            .expect("a move has samples");
        let middles = sampling.around(&samples, worst);
        if middles.is_empty() {
            let margin = samples.iter().map(|(_, w)| w.margin).reduce(Bracket::min);
            return Ok(Worst { margin: margin.expect("a move has samples"), ..samples[worst].1 });
        }
        samples.extend(sample(ask, &middles, floor, asked)?);
    }
}

/// Margins at these phases, in this order; `Err` with the first that is out.
fn sample<C: Copy + Send>(
    ask: &(impl Fn(f64) -> Worst<C> + Sync),
    phases: &[f64],
    floor: f64,
    asked: &AtomicU64,
) -> Result<Vec<(f64, Worst<C>)>, Worst<C>> {
    let mut samples = Vec::with_capacity(phases.len());
    for together in phases.chunks(rayon::current_num_threads().max(1)) {
        let worsts: Vec<Worst<C>> = match together {
            [phase] => vec![ask(*phase)],
            _ => together.par_iter().map(|&phase| ask(phase)).collect(),
        };
        for (&phase, worst) in together.iter().zip(worsts) {
            asked.fetch_add(1, Ordering::Relaxed);
            if worst.is_out(floor) {
                return Err(worst);
            }
            samples.push((phase, worst));
        }
    }
    Ok(samples)
}
