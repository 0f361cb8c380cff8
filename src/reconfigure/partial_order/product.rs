//! The product of the phases of several moves: how it is sampled, and refined around the worst sample.
//!
//! Knows phases and margins; knows no robots.

use rayon::prelude::*;

use crate::reconfigure::refusal::Refusal;
use crate::reconfigure::worst::Sampling;
use crate::statics::Bracket;

/// How many samples are asked about at once. The same whatever the number of threads, as are then the numbers of
/// samples where one of them ends the work.
const TOGETHER: usize = 8;

/// A sample: the phase of each move, and the margin there.
type Sample = (Vec<f64>, Bracket);

/// The worst margin over all combinations of the phases of moves that are sampled like this; `Err` inside with what
/// is wrong first.
///
/// # Errors
/// What the oracle refuses.
pub fn worst<B: Send>(
    samplings: &[Sampling],
    ask: impl Fn(&[f64]) -> Result<Result<Bracket, B>, Refusal> + Sync,
) -> Result<Result<Bracket, B>, Refusal> {
    let mut samples: Vec<Sample> = Vec::new();
    let mut next = grid(samplings);
    while !next.is_empty() {
        for together in next.chunks(TOGETHER) {
            let asked: Vec<_> = together.par_iter().map(|phases| ask(phases)).collect();
            for (phases, answer) in together.iter().zip(asked) {
                match answer? {
                    Err(because) => return Ok(Err(because)),
                    Ok(margin) => samples.push((phases.clone(), margin)),
                }
            }
        }
        next = refined(samplings, &samples);
    }
    Ok(Ok(samples.iter().map(|(_, margin)| *margin).reduce(Bracket::min).expect("a grid has samples")))
}

/// The product of the phases of all paths before refinement.
fn grid(samplings: &[Sampling]) -> Vec<Vec<f64>> {
    samplings.iter().fold(vec![Vec::new()], |grid, &Sampling { steps, .. }| {
        let extended = |phases: &Vec<f64>| -> Vec<Vec<f64>> {
            let phase = |i: u32| phases.iter().copied().chain([f64::from(i) / f64::from(steps)]).collect();
            (0..=steps).map(phase).collect()
        };
        grid.iter().flat_map(extended).collect()
    })
}

/// What to ask next around the worst sample: half-way to the next samples along the phase of each path, where
/// those are farther than the resolution.
fn refined(samplings: &[Sampling], samples: &[Sample]) -> Vec<Vec<f64>> {
    let worst = samples.iter().min_by(|a, b| a.1.lower.total_cmp(&b.1.lower));
    let Some((worst, _)) = worst else { return Vec::new() };
    let mut next = Vec::new();
    for (along, &Sampling { resolution, .. }) in samplings.iter().enumerate() {
        let in_line = samples
            .iter()
            .map(|(phases, _)| phases)
            .filter(|phases| phases.iter().zip(worst).enumerate().all(|(i, (a, b))| i == along || a == b));
        let at = |phases: &Vec<f64>| phases[along];
        let here = worst[along];
        let below = in_line.clone().map(at).filter(|&phase| phase < here).fold(f64::NEG_INFINITY, f64::max);
        let above = in_line.map(at).filter(|&phase| phase > here).fold(f64::INFINITY, f64::min);
        for other in [below, above] {
            if other.is_finite() && (other - here).abs() >= resolution {
                let mut middle = worst.clone();
                middle[along] = f64::midpoint(here, other);
                next.push(middle);
            }
        }
    }
    next
}
