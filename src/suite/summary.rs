//! What can be said about many jobs: rows of tables and points of figures.
//!
//! Only plans that a replay confirms count as plans. Knows neither tables nor figures.

use std::collections::BTreeMap;

use crate::generate::Family;
use crate::reconfigure::Limit;
use crate::statics::Tally;

use super::job::{Job, Planner, objective_name};
use super::record::{Ending, Record};
use super::survival::{self, Observation, Step, lower_median};

/// A job with its record.
#[derive(Clone, Copy, Debug)]
pub struct Entry<'a> {
    /// What was asked.
    pub job: &'a Job,
    /// What was found.
    pub record: &'a Record,
}

/// Jobs of one family planned for in one way.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Way {
    /// What kind of robot.
    pub family: Family,
    /// How it was planned.
    pub planner: Planner,
    /// What made a plan better.
    pub objective: &'static str,
}

/// What is known about jobs of one size planned for in one way.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// How many modules.
    pub modules: usize,
    /// How many jobs were run.
    pub jobs: usize,
    /// Of these, with a confirmed plan.
    pub solved: usize,
    /// Of these, with a confirmed plan that is proved to be the best, or proved to have none.
    pub decided: usize,
    /// Of these, proved to have no plan.
    pub impossible: usize,
    /// How the others ended, in words, with how many.
    pub open: Vec<(&'static str, usize)>,
    /// Plans that their replay refutes, other than that one by geometry alone breaks: none, or a bug.
    pub refuted: usize,
    /// Median time to the first plan and to the answer in s; `None` where less than half got there.
    pub first_plan_seconds: Option<f64>,
    /// See [`Row::first_plan_seconds`].
    pub decided_seconds: Option<f64>,
    /// Median of the moves and of the smallest margins of confirmed plans.
    pub moves: Option<f64>,
    /// See [`Row::moves`].
    pub margin: Option<f64>,
    /// Median of what the search took.
    pub expanded: f64,
    /// Transitions generated.
    pub generated: f64,
    /// Share of the transitions generated whose margin was never asked for, in all jobs together.
    pub by_bounds: Option<f64>,
    /// Median of the structures that the oracle assessed.
    pub oracle_solves: f64,
    /// How oracle calls were decided, in all jobs together.
    pub decided_by: Tally,
    /// Largest peak memory of a job's process in bytes, where known.
    pub peak_bytes: Option<u64>,
}

/// What happens to plans that ignore stability, of one family and size.
#[derive(Clone, Debug, PartialEq)]
pub struct Naive {
    /// What kind of robot.
    pub family: Family,
    /// How many modules.
    pub modules: usize,
    /// Plans by geometry alone that were found.
    pub plans: usize,
    /// Of these, how many break the robot.
    pub breaking: usize,
    /// 95 % confidence interval of that share.
    pub interval: [f64; 2],
    /// Of those that break, how many do so on the way of a move rather than between actions.
    pub on_the_way: usize,
    /// Plans with another fault: none, or a bug.
    pub faulty: usize,
    /// Median of their moves.
    pub moves: Option<f64>,
    /// Median of their smallest margins, minus infinity where the robot falls.
    pub margin: Option<f64>,
}

/// A series of a figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Whose.
    pub way: Way,
    /// Robots of how many modules; `None` for all.
    pub modules: Option<usize>,
    /// The steps.
    pub steps: Vec<Step>,
    /// Where it ends: the longest time that a job of it ran, in s.
    pub until: f64,
}

/// How long a job took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// How many modules.
    pub modules: usize,
    /// Time in s.
    pub seconds: f64,
    /// Whether that was the time to the answer, rather than to being cut off.
    pub decided: bool,
}

impl Way {
    /// Of a job.
    pub fn of(job: &Job) -> Self {
        Self { family: job.request.family, planner: job.planner, objective: objective_name(job.objective) }
    }
}

/// The rows of each way, by size.
pub fn rows(entries: &[Entry<'_>]) -> BTreeMap<Way, Vec<Row>> {
    let mut groups: BTreeMap<(Way, usize), Vec<Entry<'_>>> = BTreeMap::new();
    for entry in entries {
        groups.entry((Way::of(entry.job), entry.job.request.modules)).or_default().push(*entry);
    }
    let mut rows: BTreeMap<Way, Vec<Row>> = BTreeMap::new();
    for ((way, modules), group) in groups {
        rows.entry(way).or_default().push(row(modules, &group));
    }
    rows
}

fn row(modules: usize, group: &[Entry<'_>]) -> Row {
    let records = || group.iter().map(|entry| entry.record);
    let count = |is: &dyn Fn(&Record) -> bool| records().filter(|record| is(record)).count();
    let solved: Vec<&Record> = records().filter(|record| record.is_solved()).collect();
    let median = |value: &dyn Fn(&Record) -> f64| lower_median(&records().map(value).collect::<Vec<_>>());
    let mut open: Vec<(&'static str, usize)> = Vec::new();
    for word in records().filter(|record| !record.is_decided()).map(ending_word) {
        match open.iter_mut().find(|(known, _)| *known == word) {
            Some((_, count)) => *count += 1,
            None => open.push((word, 1)),
        }
    }
    let generated: u64 = records().map(|record| record.statistics.generated).sum();
    let by_bounds: u64 = records().map(|record| record.statistics.decided_by_bounds()).sum();
    let mut decided_by = Tally::default();
    records().for_each(|record| decided_by.merge(&record.statistics.decided_by));
    Row {
        modules,
        jobs: group.len(),
        solved: solved.len(),
        decided: count(&Record::is_decided),
        impossible: count(&|record| record.ending == Ending::Impossible),
        open,
        refuted: count(&Record::is_refuted),
        first_plan_seconds: survival::median(&first_plans(group)),
        decided_seconds: survival::median(&answers(group)),
        moves: moves(&solved),
        margin: margins(&solved),
        expanded: median(&|record| record.statistics.expanded as f64).unwrap_or(0.0),
        generated: median(&|record| record.statistics.generated as f64).unwrap_or(0.0),
        by_bounds: (generated > 0).then(|| by_bounds as f64 / generated as f64),
        oracle_solves: median(&|record| record.statistics.oracle_solves as f64).unwrap_or(0.0),
        decided_by,
        peak_bytes: records().filter_map(|record| record.peak_bytes).max(),
    }
}

/// How a job that decided nothing ended, in words.
fn ending_word(record: &Record) -> &'static str {
    match &record.ending {
        _ if record.breaks() == Some(true) => "a plan that breaks the robot",
        Ending::Solved => "plan not confirmed, or not proved to be the best",
        Ending::Impossible => "no plan exists",
        Ending::Stopped(Limit::Deadline) | Ending::Overran => "time limit",
        Ending::Stopped(Limit::Memory) => "memory limit",
        Ending::Stopped(Limit::Expansions) => "expansion limit",
        Ending::Stopped(Limit::Cancelled) => "interrupted",
        Ending::Stopped(Limit::Precision) => "margins too close to decide",
        Ending::Stopped(Limit::Incomplete) => "nothing found by a method that looks for some plans only",
        Ending::Crashed(_) => "crashed",
        Ending::Refused(_) => "no such problem",
    }
}

fn moves(solved: &[&Record]) -> Option<f64> {
    let moves = solved.iter().filter_map(|record| Some(f64::from(record.found.as_ref()?.moves)));
    lower_median(&moves.collect::<Vec<_>>())
}

fn margins(solved: &[&Record]) -> Option<f64> {
    let margins = solved.iter().filter_map(|record| Some(record.check.as_ref()?.margin.lower));
    lower_median(&margins.collect::<Vec<_>>())
}

/// Times to the first plan. Of a problem that is proved to have none, nothing is waited for: it is cut off.
fn first_plans(group: &[Entry<'_>]) -> Vec<Observation> {
    let observation = |entry: &Entry<'_>| match entry.record.first_plan_seconds() {
        Some(seconds) => Observation { seconds, reached: true },
        None => Observation { seconds: entry.record.seconds, reached: false },
    };
    drawn(group).map(observation).collect()
}

/// Times to the answer.
fn answers(group: &[Entry<'_>]) -> Vec<Observation> {
    let observation = |entry: &Entry<'_>| {
        let record = entry.record;
        Observation { seconds: record.seconds, reached: record.is_decided() }
    };
    drawn(group).map(observation).collect()
}

/// The jobs whose problem could be drawn.
fn drawn<'a>(group: &'a [Entry<'a>]) -> impl Iterator<Item = &'a Entry<'a>> {
    group.iter().filter(|entry| !matches!(entry.record.ending, Ending::Refused(_)))
}

/// The jobs of each way, and of each size or of all.
fn by_way<'a>(entries: &[Entry<'a>], by_size: bool) -> BTreeMap<(Way, Option<usize>), Vec<Entry<'a>>> {
    let mut groups: BTreeMap<_, Vec<Entry<'a>>> = BTreeMap::new();
    for entry in entries {
        let modules = by_size.then_some(entry.job.request.modules);
        groups.entry((Way::of(entry.job), modules)).or_default().push(*entry);
    }
    groups
}

fn until(group: &[Entry<'_>]) -> f64 {
    group.iter().map(|entry| entry.record.seconds).fold(0.0, f64::max)
}

/// The share of jobs with a first plan over time, and the share that is answered.
pub fn solved_over_time(entries: &[Entry<'_>]) -> [Vec<Curve>; 2] {
    let curves = |times: fn(&[Entry<'_>]) -> Vec<Observation>| {
        let groups = by_way(entries, false).into_iter();
        groups
            .map(|((way, modules), group)| {
                let steps = survival::reached_over_time(&times(&group));
                Curve { way, modules, steps, until: until(&group) }
            })
            .collect()
    };
    [curves(first_plans), curves(answers)]
}

/// What a plan's margin is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// The best margin that is known for the problem, of all that its jobs found.
    BestKnown,
    /// What was proved by then that no plan exceeds.
    Proved,
}

/// By how much the margin of the best plan so far falls short, over time: the median over the problems, where a problem
/// without a plan so far, or of which nothing is proved so far, counts as infinitely far. Of jobs whose objective
/// is the margin. A step's `share` is that median.
pub fn error_over_time(entries: &[Entry<'_>], against: Against) -> Vec<Curve> {
    let mut best: BTreeMap<String, f64> = BTreeMap::new();
    for entry in entries.iter().filter(|entry| entry.record.is_solved() && entry.record.breaks().is_none()) {
        let Some(margin) = entry.record.found.as_ref().and_then(|found| found.margin) else { continue };
        let known = best.entry(entry.job.problem()).or_insert(f64::NEG_INFINITY);
        *known = known.max(margin.lower);
    }
    let of_margin = entries.iter().filter(|entry| {
        entry.job.planner != Planner::IgnoreStability
            && entry.job.objective == crate::reconfigure::Objective::Margin
            && best.contains_key(&entry.job.problem())
    });
    let of_margin: Vec<Entry<'_>> = of_margin.copied().collect();
    let curve = |((way, modules), group): (_, Vec<Entry<'_>>)| {
        let runs: Vec<Vec<(f64, f64)>> =
            group.iter().map(|entry| errors(entry.record, best[&entry.job.problem()], against)).collect();
        let mut times: Vec<f64> = runs.iter().flatten().map(|(seconds, _)| *seconds).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        let at = |run: &Vec<(f64, f64)>, time: f64| {
            run.iter().take_while(|(seconds, _)| *seconds <= time).last().map_or(f64::INFINITY, |(_, error)| *error)
        };
        let median = |time: f64| lower_median(&runs.iter().map(|run| at(run, time)).collect::<Vec<_>>());
        let step = |&time: &f64| Some(Step { seconds: time, share: median(time)? });
        let mut steps: Vec<Step> = times.iter().filter_map(step).filter(|step| step.share.is_finite()).collect();
        steps.dedup_by(|next, previous| next.share == previous.share);
        Curve { way, modules, steps, until: until(&group) }
    };
    by_way(&of_margin, true).into_iter().map(curve).collect()
}

/// When a run's best plan so far was how far from what it is compared with. Only a confirmed last plan vouches for
/// those before it.
fn errors(record: &Record, best: f64, against: Against) -> Vec<(f64, f64)> {
    if !record.is_solved() {
        return Vec::new();
    }
    let from_trace = record.trace.iter().filter_map(|point| Some((point.seconds, point.margin?, point.margin_at_most)));
    let last = record.found.as_ref().and_then(|found| found.margin);
    let last = last.map(|margin| {
        // Of a plan that is proved to be the best its own margin is the bound, within the tolerance of proofs.
        let at_most = if record.is_decided() { margin.lower } else { record.margin_at_most };
        (record.seconds, margin.lower, at_most)
    });
    let (mut so_far, mut at_most) = (f64::NEG_INFINITY, f64::INFINITY);
    let known = from_trace.chain(last).map(|(seconds, margin, bound)| {
        (so_far, at_most) = (so_far.max(margin), at_most.min(bound));
        let aim = match against {
            Against::BestKnown => best,
            Against::Proved => at_most,
        };
        (seconds, (aim - so_far).max(0.0))
    });
    known.collect()
}

/// How long each job took, by way.
pub fn growth(entries: &[Entry<'_>]) -> BTreeMap<Way, Vec<Dot>> {
    let mut dots: BTreeMap<Way, Vec<Dot>> = BTreeMap::new();
    for entry in entries.iter().filter(|entry| !matches!(entry.record.ending, Ending::Refused(_))) {
        let (modules, seconds) = (entry.job.request.modules, entry.record.seconds);
        let dot = Dot { modules, seconds, decided: entry.record.is_decided() };
        dots.entry(Way::of(entry.job)).or_default().push(dot);
    }
    dots
}

/// What happens to plans that ignore stability, by family and size.
pub fn naive(entries: &[Entry<'_>]) -> Vec<Naive> {
    let mut groups: BTreeMap<(Family, usize), Vec<&Record>> = BTreeMap::new();
    for entry in entries.iter().filter(|entry| entry.record.breaks().is_some()) {
        groups.entry((entry.job.request.family, entry.job.request.modules)).or_default().push(entry.record);
    }
    let naive = |((family, modules), group): ((Family, usize), Vec<&Record>)| {
        let flaws = || group.iter().filter_map(|record| record.check.as_ref()?.flaw.as_ref());
        let breaking = flaws().filter(|flaw| flaw.breaks).count();
        Naive {
            family,
            modules,
            plans: group.len(),
            breaking,
            interval: survival::wilson(breaking, group.len()),
            on_the_way: flaws().filter(|flaw| flaw.breaks && flaw.phase.is_some_and(|phase| phase < 1.0)).count(),
            faulty: flaws().filter(|flaw| !flaw.breaks).count(),
            moves: moves(&group),
            margin: margins(&group),
        }
    };
    groups.into_iter().map(naive).collect()
}
