//! Whether what a plan claims is what was found.

use crate::reconfigure::plan::Plan;
use crate::statics::Bracket;

use super::failure::Fault;
use super::judge::{Found, Judge, Sample};

/// Margins of one and the same state, assessed twice with its modules in
/// another order, differ by at most this, relative to the larger of 1 and the
/// utilisation: twice the width of a bracket.
const SAME_STATE: f64 = 2e-6;

/// Relative difference in utilisation that two samplings of one move may have:
/// between samples 1/32 of the move apart it changes by no more, unless the
/// move is far from what the planner's refinement has seen.
const SAMPLING: f64 = 0.05;

/// Relative distance to the utilisation at which a connection counts as at its limit.
pub(in crate::reconfigure) const AT_LIMIT: f64 = 1e-3;

/// By how much the margin of a move found on one grid may differ from `margin`, found on another.
pub(super) fn tolerance(margin: f64) -> f64 {
    SAMPLING * (1.0 - margin).abs() + same_state(margin)
}

fn same_state(margin: f64) -> f64 {
    SAME_STATE * (1.0 - margin).abs().max(1.0)
}

/// Whether both ends agree. Infinite ends agree with themselves only, NaN with nothing.
fn agree(a: Bracket, b: Bracket, tolerance: f64) -> bool {
    let close = |a: f64, b: f64| a == b || (a - b).abs() <= tolerance;
    close(a.lower, b.lower) && close(a.upper, b.upper)
}

/// The margin that replaying has to confirm where a claim is a bound rather than a value: its lower end, less what
/// another grid of samples may find during a move.
pub(in crate::reconfigure) fn bound(claim: &Bracket, is_move: bool) -> Option<f64> {
    let less = if is_move { tolerance(claim.lower) } else { same_state(claim.lower) };
    let least = claim.lower - less;
    let least = if claim.lower >= 0.0 { least.max(0.0) } else { least };
    is_bound(claim).then_some(least)
}

/// Whether a claim leaves open what the value is.
fn is_bound(claim: &Bracket) -> bool {
    claim.lower.is_finite() && claim.upper - claim.lower > same_state(claim.lower)
}

/// Whether a margin that was found is as claimed: the same value, or at least the claimed bound and not
/// surely above it.
fn confirms(found: Bracket, claimed: Bracket, tolerance: f64) -> bool {
    if is_bound(&claimed) {
        found.lower >= claimed.lower - tolerance && found.lower <= claimed.upper + tolerance
    } else {
        agree(claimed, found, tolerance)
    }
}

/// Compares a plan's claims with the margins found: of the start, then of
/// every action that could be replayed. `moves` is how many of the actions are moves.
pub(in crate::reconfigure) fn check<A, C: Copy + PartialEq, T>(
    checker: &mut Judge<C, T>,
    plan: &Plan<A, C>,
    moves: usize,
    found: &[Found<C>],
) {
    if usize::try_from(plan.moves) != Ok(moves) {
        checker.fail(None, None, Fault::MovesDiffer { claimed: plan.moves, found: moves }, None);
    }
    let claims = || plan.actions.iter().map(|planned| planned.margin);
    if claims().any(|claim| claim.is_some() != plan.margin.is_some()) {
        checker.fail(None, None, Fault::ClaimsIncomplete, None);
    }
    for (index, (planned, found)) in plan.actions.iter().zip(&found[1..]).enumerate() {
        let Some(claimed) = planned.margin else { continue };
        let allowed = if found.exact { same_state(claimed.lower) } else { tolerance(claimed.lower) };
        let there = planned.phase.map(|phase| margin_of(found.at(phase)));
        let at_phase = |there: Bracket| is_bound(&claimed) || agree(claimed, there, same_state(claimed.lower));
        let holds = confirms(found.margin, claimed, allowed) && there.is_none_or(|there| there.is_some_and(at_phase));
        if !holds {
            let fault = Fault::MarginDiffers { claimed, found: there.flatten().unwrap_or(found.margin) };
            checker.fail(Some(index), None, fault, None);
        }
    }
    if found.len() == plan.actions.len() + 1 {
        check_whole(checker, plan, found);
    }
}

/// The plan's own margin and bottleneck.
fn check_whole<A, C: Copy + PartialEq, T>(checker: &mut Judge<C, T>, plan: &Plan<A, C>, found: &[Found<C>]) {
    let Some(claimed) = plan.margin else { return };
    let smallest = plan.actions.iter().filter_map(|planned| planned.margin).fold(found[0].margin, Bracket::min);
    if !agree(claimed, smallest, same_state(claimed.lower)) {
        checker.fail(None, None, Fault::MarginDiffers { claimed, found: smallest }, None);
    }
    let Some(bottleneck) = &plan.bottleneck else {
        checker.fail(None, None, Fault::BottleneckDiffers, None);
        return;
    };
    if is_bound(&claimed) {
        let there = match bottleneck.action {
            Some(action) => plan.actions.get(action).and_then(|planned| planned.margin),
            None => Some(found[0].margin),
        };
        if !there.is_some_and(|there| (there.lower - claimed.lower).abs() <= same_state(claimed.lower)) {
            checker.fail(bottleneck.action, Some(bottleneck.phase), Fault::BottleneckDiffers, None);
        }
        return;
    }
    let place = bottleneck.action.map_or(Some(0), |action| action.checked_add(1));
    let samples = || place.and_then(|at| found.get(at)).into_iter().flat_map(|f| f.at(bottleneck.phase));
    let attained = samples().filter(|sample| agree(sample.margin, claimed, same_state(claimed.lower)));
    let limits = |sample: &Sample<C>| match &bottleneck.connection {
        Some(connection) => sample.limiting.contains(connection),
        None => sample.weakest.is_none(),
    };
    if !attained.into_iter().any(limits) {
        checker.fail(bottleneck.action, Some(bottleneck.phase), Fault::BottleneckDiffers, None);
    }
}

fn margin_of<'a, C: 'a>(samples: impl Iterator<Item = &'a Sample<C>>) -> Option<Bracket> {
    samples.map(|sample| sample.margin).reduce(Bracket::min)
}
