//! Narrows an end where the program's own fields did not prove enough.
//!
//! The oracle itself is asked at forces near the end. Its mechanism there supports the
//! utilisation from below as a line in the force, so where that line meets the limit is the next
//! guess (Newton's method on a convex function, from outside); its bracket proves on which side
//! of the end a force lies. A guess proves nothing.

use super::super::assessment::{Assessment, Question, Verdict};
use super::super::loads::own_loads;
use super::Start;
use super::line::Line;
use super::reach::{NARROW, Reach, interpolated};

/// Most assessments for one end.
const ROUNDS: usize = 24;

/// Steps to either side of a guess, as shares of the end's size: the first that is proved ends it.
const STEPS: [f64; 6] = [1e-8, 3e-8, 4e-7, 1e-5, 1e-3, 3e-2];

/// By how much a force grows while no end is in sight, and how many times the typical one it becomes.
const GROWTH: f64 = 1e2;
const LARGEST: f64 = 1e12;

/// Narrows `reach` from `start` in the direction of `sign` until it is narrow, or no more is gained.
pub(super) fn polish(line: &Line<'_>, start: &Start, sign: f64, limit: f64, reach: &mut Reach) {
    let mut guess = None;
    let (mut inward, mut outward) = (0, 0);
    let mut far = reach.typical.max(f64::MIN_POSITIVE);
    for _ in 0..ROUNDS {
        if reach.is_narrow(start) {
            return;
        }
        let size = reach.size(start);
        let probe = match guess {
            Some(end) if reach.outer > end + size * NARROW / 2.0 && outward < STEPS.len() => {
                outward += 1;
                end + size * STEPS[outward - 1]
            }
            Some(end) if inward < STEPS.len() => {
                inward += 1;
                end - size * STEPS[inward - 1]
            }
            Some(_) => return,
            None if reach.outer.is_finite() => reach.outer + size * STEPS[0],
            None if far > LARGEST * reach.typical => return,
            None => {
                far *= GROWTH;
                reach.inner + far
            }
        };
        if !(probe > reach.inner && probe.is_finite()) {
            continue;
        }
        let answer = line.assess(start.force + sign * probe, Question::VALUE);
        let upper = answer.utilisation.upper;
        reach.inner = reach.inner.max(interpolated(probe, upper, start.utilisation, limit).min(reach.outer));
        if answer.verdict == Verdict::WholeBodyUnstable || answer.utilisation.lower > limit {
            reach.outer = reach.outer.min(probe);
            let end = meets(line, start, sign, limit, &answer).filter(|end| *end < probe);
            if let Some(end) = end
                && guess.is_none_or(|known| end < known - size * STEPS[0])
            {
                guess = Some(end.max(reach.inner));
                (inward, outward) = (0, 0);
            }
            if guess.is_none() {
                // Without a motion to go by, halfway is as good as any.
                guess = Some(0.5 * (reach.inner + probe));
            }
        } else if guess.is_some_and(|end| probe > end) {
            // It stands beyond the guess, which a poor motion had made.
            guess = None;
        }
    }
}

/// Where the utilisation that the mechanism of `answer` proves meets the limit, as a distance from `start`.
fn meets(line: &Line<'_>, start: &Start, sign: f64, limit: f64, answer: &Assessment) -> Option<f64> {
    let power = |structure| -> f64 {
        own_loads(structure).iter().zip(&answer.mechanism).map(|(load, twist)| twist.power(&load.wrench)).sum()
    };
    let (base, pushing) = (power(&line.at(start.force)), power(&line.alone(sign)));
    // Mechanisms are of unit dissipation, those of whole-body instability of none.
    let dissipated = if answer.verdict == Verdict::WholeBodyUnstable { 0.0 } else { limit };
    let end = (dissipated - base) / pushing;
    (pushing > 0.0 && end.is_finite() && end >= 0.0).then_some(end)
}
