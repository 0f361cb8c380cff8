//! Many problems at once.

use std::cmp::Ordering;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

use crate::reconfigure::{Objective, Options, Refusal};

use super::robot::Robot;
use super::{Problem, ReportOf};

/// Plans every problem with its own options, several at once in the rayon pool that this is called in. The answers
/// come in the order of the problems and do not depend on the number of threads, but for limits on time.
///
/// `cancel` stops all of them, those with a flag of their own excepted; what has not begun by then ends at once.
/// Time limits count from when a problem is begun.
pub fn plan_batch<R: Robot>(
    problems: &[(Problem<R>, Options)],
    cancel: &Arc<AtomicBool>,
) -> Vec<Result<ReportOf<R>, Refusal>> {
    let answer = |(problem, options): &(Problem<R>, Options)| {
        let mut options = options.clone();
        options.cancel.get_or_insert_with(|| Arc::clone(cancel));
        problem.plan(&options, &mut |_| {})
    };
    problems.par_iter().map(answer).collect()
}

/// The report with the best plan by its objective, as an index; of equals the first. Plans of
/// [`Objective::Moves`] are ranked by moves, then margin, all others by margin, then moves.
pub fn best<A, C>(reports: &[crate::reconfigure::Report<A, C>]) -> Option<usize> {
    let plans = reports.iter().enumerate().filter_map(|(index, report)| Some((index, report, report.plan.as_ref()?)));
    let margin = |plan: &crate::reconfigure::Plan<A, C>| plan.margin.map_or(f64::NEG_INFINITY, |margin| margin.lower);
    let ranked = plans.min_by(|(_, report, a), (_, _, b)| {
        let by_margin: Ordering = margin(b).total_cmp(&margin(a));
        let by_moves = a.moves.cmp(&b.moves);
        match report.objective {
            Objective::Moves => by_moves.then(by_margin),
            _ => by_margin.then(by_moves),
        }
    });
    ranked.map(|(index, ..)| index)
}
