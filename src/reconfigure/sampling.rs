//! At which phases of a move the oracle is asked. The only place for these numbers.

use super::moves::{Motion, Move, Turn};
use super::worst::Sampling;

/// Steps of a slide before refinement: every eighth of a cell.
const SLIDE_STEPS: u32 = 8;

/// Steps of a quarter pivot before refinement: every 15 degrees.
const QUARTER_STEPS: u32 = 6;

/// Around the worst sample, a slide is refined until samples are closer than this phase.
const SLIDE_RESOLUTION: f64 = 1.0 / 64.0;

/// Around the worst sample, a pivot is refined until samples are closer than this, in degrees.
const PIVOT_RESOLUTION_DEGREES: f64 = 1.5;

/// At which phases a move is sampled.
pub fn of(step: Move) -> Sampling {
    Sampling { steps: steps(step), resolution: resolution(step) }
}

/// How many equal steps a move is sampled in before refinement.
fn steps(step: Move) -> u32 {
    match step.motion {
        Motion::Slide { .. } => SLIDE_STEPS,
        Motion::Pivot { turn: Turn::Quarter, .. } => QUARTER_STEPS,
        Motion::Pivot { turn: Turn::Half, .. } => 2 * QUARTER_STEPS,
    }
}

/// A few phases strictly between the ends, all of them sampled before refinement:
/// the middle, and every 45 degrees of a pivot.
pub fn coarse(step: Move) -> impl Iterator<Item = f64> {
    let parts = match step.motion {
        Motion::Slide { .. } | Motion::Pivot { turn: Turn::Quarter, .. } => 2,
        Motion::Pivot { turn: Turn::Half, .. } => 4,
    };
    (1..parts).map(move |part| f64::from(part) / f64::from(parts))
}

/// The distance in phase below which samples are not refined further.
fn resolution(step: Move) -> f64 {
    match step.motion {
        Motion::Slide { .. } => SLIDE_RESOLUTION,
        Motion::Pivot { turn, .. } => PIVOT_RESOLUTION_DEGREES / turn.degrees(),
    }
}
