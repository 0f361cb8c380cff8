//! Runs one job.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use crate::generate::{Generated, Pair, generate};
use crate::reconfigure::{Event, Limit, Options, Outcome, Plan, Reduction, Refusal, Report, linkage, solve};

use super::job::{Job, Planner};
use super::plan::AnyPlan;
use super::record::{Ending, Found, Point, Record};

/// What a job answered.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// What was found, not yet checked.
    pub record: Record,
    /// The problem, and the planner's answer to it; `None` where there is none.
    pub answer: Option<(Pair, AnyPlan)>,
}

/// How a caller follows a job.
pub struct Watch<'a> {
    /// Told when planning begins, and whenever something becomes known that was not.
    pub on_point: &'a mut dyn FnMut(&Point),
    /// Set it from any thread to stop.
    pub cancel: Option<Arc<AtomicBool>>,
}

/// Draws the job's problem and plans for it within the job's limits. Its time counts from when the problem is
/// drawn. The plan is not checked: see [`judge`](super::judge()).
pub fn run(job: &Job, watch: &mut Watch<'_>) -> Run {
    let pair = match generate(&job.request) {
        Ok(Generated { pair, .. }) => pair,
        Err(failure) => return Run { record: refused(job, failure.to_string()), answer: None },
    };
    let began = Instant::now();
    let nothing = Point { seconds: 0.0, margin: None, moves: None, margin_at_most: f64::INFINITY, moves_at_least: 0 };
    (watch.on_point)(&nothing);
    let mut trace = vec![nothing];
    let mut on_event = |event: &Event| {
        let point = point(event, began);
        let last = trace.last().copied().unwrap_or(nothing);
        if (Point { seconds: point.seconds, ..last }) != point {
            (watch.on_point)(&point);
            trace.push(point);
        }
    };
    let options = Options {
        objective: job.objective,
        min_margin: Some(job.min_margin),
        time_limit: Some(job.time),
        max_bytes: usize::try_from(job.bytes).ok(),
        cancel: watch.cancel.clone(),
        ignore_stability: job.planner == Planner::IgnoreStability,
        reduction: if job.planner == Planner::Primitive { Reduction::Primitive } else { Reduction::Saturated },
        ..Options::default()
    };
    let answer = match &pair {
        Pair::Lattice { start, goal } => solve(start, goal, &options, &mut on_event)
            .map(|report| (base(job, &report), AnyPlan::Lattice(report.into()))),
        Pair::Linkage { start, goal } => linkage::solve(start, goal, &options, &mut on_event)
            .map(|report| (base(job, &report), AnyPlan::Linkage(report.into()))),
    };
    match answer {
        Ok((record, answer)) => Run { record: Record { trace, ..record }, answer: Some((pair, answer)) },
        Err(refusal) => Run { record: refused(job, Refusal::to_string(&refusal)), answer: None },
    }
}

/// What a search knows at the moment of an event.
fn point(event: &Event, began: Instant) -> Point {
    let progress = &event.progress;
    Point {
        seconds: began.elapsed().as_secs_f64(),
        margin: progress.best_width.filter(|width| width.is_finite()),
        moves: progress.best_cost,
        margin_at_most: progress.width_at_most,
        moves_at_least: progress.cost_at_least,
    }
}

/// The record of a report, without its trace.
fn base<A, C>(job: &Job, report: &Report<A, C>) -> Record {
    let ending = match &report.outcome {
        Outcome::Solved => Ending::Solved,
        Outcome::Impossible(_) => Ending::Impossible,
        Outcome::OutOfBudget(limit) => Ending::Stopped(*limit),
    };
    let found = report.plan.as_ref().map(|plan: &Plan<A, C>| Found {
        moves: plan.moves,
        actions: plan.actions.len(),
        margin: plan.margin,
        optimal: report.proof.optimal,
    });
    Record {
        job: job.name(),
        ending,
        seconds: report.statistics.seconds,
        trace: Vec::new(),
        found,
        check: None,
        margin_at_most: report.proof.margin_at_most,
        moves_at_least: report.proof.moves_at_least,
        statistics: report.statistics,
        rungs: Vec::new(),
        peak_bytes: None,
    }
}

fn refused(job: &Job, why: String) -> Record {
    Record::without_answer(job.name(), Ending::Refused(why), 0.0, Vec::new())
}

impl Record {
    /// The record of a job that gave no answer: what became known until it ended.
    pub fn without_answer(job: String, ending: Ending, seconds: f64, trace: Vec<Point>) -> Self {
        let last = trace.last();
        Self {
            job,
            ending,
            seconds,
            found: None,
            check: None,
            margin_at_most: last.map_or(f64::INFINITY, |point| point.margin_at_most),
            moves_at_least: last.map_or(0, |point| point.moves_at_least),
            statistics: crate::reconfigure::Statistics::default(),
            rungs: Vec::new(),
            peak_bytes: None,
            trace,
        }
    }

    /// Whether the user ended the job, so that it is to be run again.
    pub fn is_interrupted(&self) -> bool {
        self.ending == Ending::Stopped(Limit::Cancelled)
    }
}
