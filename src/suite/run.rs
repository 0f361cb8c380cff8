//! Runs one job.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use crate::generate::{Generated, Pair, generate};
use crate::reconfigure::{
    Event, Limit, Method, News, Options, Outcome, Plan, Proof, Reduction, Refusal, Report, Statistics, linkage, solve,
};

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
    /// Given every plan that is better than those before it, as the answer of a search that was cut off.
    pub on_plan: &'a mut dyn FnMut(&Pair, &AnyPlan),
    /// Measures the memory in use in bytes, for a job that has a process to itself.
    pub measure_bytes: Option<fn() -> Option<usize>>,
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
    let options = Options {
        objective: job.objective,
        min_margin: Some(job.min_margin),
        time_limit: Some(job.time),
        max_bytes: usize::try_from(job.bytes).ok(),
        measure_bytes: watch.measure_bytes,
        cancel: watch.cancel.clone(),
        ignore_stability: job.planner == Planner::IgnoreStability,
        reduction: if job.planner == Planner::Primitive { Reduction::Primitive } else { Reduction::Saturated },
        method: if job.planner == Planner::Decompose { Method::Decompose } else { Method::Exact },
        ..Options::default()
    };
    let mut diary = Diary::new(job, watch);
    let answer = match &pair {
        Pair::Lattice { start, goal } => {
            let on_event =
                &mut |event: &Event| diary.note(event, &mut |report| (&pair, AnyPlan::Lattice(report.into())));
            solve(start, goal, &options, on_event).map(|report| (base(job, &report), AnyPlan::Lattice(report.into())))
        }
        Pair::Linkage { start, goal } => {
            let on_event =
                &mut |event: &Event<_, _>| diary.note(event, &mut |report| (&pair, AnyPlan::Linkage(report.into())));
            linkage::solve(start, goal, &options, on_event)
                .map(|report| (base(job, &report), AnyPlan::Linkage(report.into())))
        }
    };
    let trace = diary.trace;
    match answer {
        Ok((record, answer)) => Run { record: Record { trace, ..record }, answer: Some((pair, answer)) },
        Err(refusal) => Run { record: refused(job, Refusal::to_string(&refusal)), answer: None },
    }
}

/// What became known of a job so far.
struct Diary<'a, 'b> {
    job: &'a Job,
    watch: &'a mut Watch<'b>,
    began: Instant,
    trace: Vec<Point>,
}

impl<'a, 'b> Diary<'a, 'b> {
    fn new(job: &'a Job, watch: &'a mut Watch<'b>) -> Self {
        let nothing =
            Point { seconds: 0.0, margin: None, moves: None, margin_at_most: f64::INFINITY, moves_at_least: 0 };
        (watch.on_point)(&nothing);
        Self { job, watch, began: Instant::now(), trace: vec![nothing] }
    }

    /// Notes an event, if it says anything new.
    fn note<'p, A: Clone, C: Clone>(
        &mut self,
        event: &Event<A, C>,
        any: &mut dyn FnMut(Report<A, C>) -> (&'p Pair, AnyPlan),
    ) {
        let seconds = self.began.elapsed().as_secs_f64();
        let known = &event.known;
        let point = Point {
            seconds,
            margin: known.margin,
            moves: known.moves,
            margin_at_most: known.margin_at_most,
            moves_at_least: known.moves_at_least,
        };
        if self.trace.last().is_none_or(|last| Point { seconds, ..*last } != point) {
            (self.watch.on_point)(&point);
            self.trace.push(point);
        }
        if let News::Plan(plan) = &event.news {
            let (pair, answer) = any(self.so_far(plan, &point));
            (self.watch.on_plan)(pair, &answer);
        }
    }

    /// A plan as the answer of a search that was cut off there.
    fn so_far<A: Clone, C: Clone>(&self, plan: &Plan<A, C>, point: &Point) -> Report<A, C> {
        let Point { seconds, margin_at_most, moves_at_least, .. } = *point;
        Report {
            outcome: Outcome::OutOfBudget(Limit::Cancelled),
            objective: self.job.objective,
            required: (self.job.planner != Planner::IgnoreStability).then_some(self.job.min_margin),
            plan: Some(plan.clone()),
            alternatives: Vec::new(),
            alternatives_cut_by: None,
            proof: Proof { optimal: false, margin_at_most, moves_at_least },
            in_the_way: None,
            statistics: Statistics { seconds, ..Statistics::default() },
        }
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
            statistics: Statistics::default(),
            peak_bytes: None,
            trace,
        }
    }

    /// Whether the user ended the job, so that it is to be run again.
    pub fn is_interrupted(&self) -> bool {
        self.ending == Ending::Stopped(Limit::Cancelled)
    }
}
