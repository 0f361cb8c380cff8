//! At which phases of a move the oracle is asked. The only place for these numbers.

use crate::robot::{Motion, Turn};

use super::moves::Move;
use super::worst::Sampling;

/// Steps of a translation by one cell before refinement: every eighth of a cell.
const CELL_STEPS: u32 = 8;

/// Steps of a quarter turn before refinement: every 15 degrees.
const QUARTER_STEPS: u32 = 6;

/// Around the worst sample, a translation is refined until samples are closer than this, in cells.
const CELL_RESOLUTION: f64 = 1.0 / 64.0;

/// Around the worst sample, a rotation is refined until samples are closer than this, in degrees.
const TURN_RESOLUTION_DEGREES: f64 = 1.5;

/// At which phases a move is sampled.
pub fn of(step: Move) -> Sampling {
    Sampling { steps: steps(step), resolution: resolution(step) }
}

/// How many equal steps a move is sampled in before refinement. They meet every moment at which the module
/// leaves a cell and is held by least.
fn steps(step: Move) -> u32 {
    match step.motion {
        Motion::Translation { .. } => CELL_STEPS * step.motion.stages(),
        Motion::Rotation { turn: Turn::Quarter, .. } => QUARTER_STEPS,
        Motion::Rotation { turn: Turn::Half, .. } => 2 * QUARTER_STEPS,
    }
}

/// A few phases strictly between the ends, all of them sampled before refinement:
/// the middle, and every 45 degrees of a rotation.
pub fn coarse(step: Move) -> impl Iterator<Item = f64> {
    let parts = match step.motion {
        Motion::Translation { .. } | Motion::Rotation { turn: Turn::Quarter, .. } => 2,
        Motion::Rotation { turn: Turn::Half, .. } => 4,
    };
    (1..parts).map(move |part| f64::from(part) / f64::from(parts))
}

/// The distance in phase below which samples are not refined further.
fn resolution(step: Move) -> f64 {
    match step.motion {
        Motion::Translation { by } => CELL_RESOLUTION / f64::from(by.into_iter().fold(1, |most, c| most.max(c.abs()))),
        Motion::Rotation { turn, .. } => TURN_RESOLUTION_DEGREES / turn.degrees(),
    }
}
