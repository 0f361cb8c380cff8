//! Plans that are not what they claim do not count, and what is counted is counted right.

use std::time::Duration;

use super::job::{Job, Planner};
use super::record::{Ending, Found, Point, Record};
use super::summary::{self, Against, Entry};
use super::{AnyPlan, Check, Flaw, Run, Watch, judge, run};
use crate::generate::{Family, Request};
use crate::reconfigure::{Limit, Objective};
use crate::statics::Bracket;

fn job(seed: u64, planner: Planner) -> Job {
    Job {
        request: Request { difficulty: Some(2), ..Request::new(Family::Cubes, 4, seed) },
        objective: Objective::Moves,
        planner,
        min_margin: 0.0,
        time: Duration::from_secs(60),
        bytes: 1 << 30,
    }
}

fn quietly(job: &Job) -> Run {
    run(job, &mut Watch { on_point: &mut |_| {}, on_plan: &mut |_, _| {}, measure_bytes: None, cancel: None })
}

#[test]
fn a_tampered_plan_does_not_count() {
    let job = job(1, Planner::Exact);
    let Run { record, answer } = quietly(&job);
    let (pair, AnyPlan::Lattice(report)) = answer.unwrap() else { panic!("cubes have cells") };
    assert_eq!(record.ending, Ending::Solved);
    let with = |report: crate::reconfigure::Report| {
        let check = judge(&pair, &AnyPlan::Lattice(report.into()), job.min_margin).unwrap().unwrap();
        Record { check: Some(check), ..record.clone() }
    };
    let honest = with((*report).clone());
    assert!(honest.is_solved() && honest.is_decided() && !honest.is_refuted());
    // Without a check nothing counts either.
    assert!(!record.is_solved() && !record.is_decided());

    let mut shorter = (*report).clone();
    shorter.plan.as_mut().unwrap().actions.pop();
    let mut better = (*report).clone();
    let margin = better.plan.as_mut().unwrap().margin.as_mut().unwrap();
    *margin = Bracket::new(margin.lower + 0.1, margin.upper + 0.1);
    for tampered in [with(shorter), with(better)] {
        assert!(!tampered.is_solved() && !tampered.is_decided() && tampered.is_refuted());
        let rows = summary::rows(&[Entry { job: &job, record: &tampered }]);
        let row = &rows.values().next().unwrap()[0];
        assert_eq!((row.jobs, row.solved, row.decided, row.refuted), (1, 0, 0, 1));
        assert_eq!((row.first_plan_seconds, row.moves, row.margin), (None, None, None));
    }
}

#[test]
fn a_job_ends_within_its_time_and_says_what_became_known() {
    let mut seen = Vec::new();
    let job = Job { time: Duration::from_millis(1), objective: Objective::Margin, ..job(3, Planner::Exact) };
    let job = Job { request: Request { modules: 8, difficulty: None, ..job.request }, ..job };
    let mut on_point = |point: &Point| seen.push(*point);
    let run =
        run(&job, &mut Watch { on_point: &mut on_point, on_plan: &mut |_, _| {}, measure_bytes: None, cancel: None });
    assert_eq!(run.record.ending, Ending::Stopped(Limit::Deadline));
    assert_eq!(seen, run.record.trace);
    assert_eq!(seen[0].seconds, 0.0);
}

/// The record of a job that took so long; with a plan of this margin if it found one.
fn made_up(job: &Job, seconds: f64, margin: Option<f64>, trace: &[(f64, f64)]) -> Record {
    let ending = if margin.is_some() { Ending::Solved } else { Ending::Stopped(Limit::Deadline) };
    let point = |&(seconds, margin): &(f64, f64)| Point {
        seconds,
        margin: Some(margin),
        moves: Some(5),
        margin_at_most: 1.0,
        moves_at_least: 1,
    };
    let bracket = |margin| Bracket::new(margin, margin);
    let by_geometry = job.planner == Planner::IgnoreStability;
    Record {
        found: margin.map(|margin| Found {
            moves: 5,
            actions: 9,
            margin: (!by_geometry).then(|| bracket(margin)),
            optimal: true,
        }),
        check: margin.map(|margin| Check {
            flaw: (margin < 0.0).then(|| Flaw {
                action: Some(2),
                phase: Some(0.5),
                breaks: true,
                what: "it breaks".to_string(),
            }),
            margin: bracket(margin),
            states: 10,
        }),
        ..Record::without_answer(job.name(), ending, seconds, trace.iter().map(point).collect())
    }
}

#[test]
fn time_outs_are_censored_not_averaged() {
    let jobs: Vec<Job> = (1..=5).map(|seed| job(seed, Planner::Exact)).collect();
    let found = [(1.0, Some(0.3)), (2.0, Some(0.5)), (60.0, None), (4.0, Some(0.4)), (60.0, None)];
    let records: Vec<Record> =
        jobs.iter().zip(found).map(|(job, (seconds, margin))| made_up(job, seconds, margin, &[])).collect();
    let entries: Vec<Entry<'_>> = jobs.iter().zip(&records).map(|(job, record)| Entry { job, record }).collect();
    let rows = summary::rows(&entries);
    let row = &rows.values().next().unwrap()[0];
    assert_eq!((row.jobs, row.solved, row.decided), (5, 3, 3));
    assert_eq!(row.decided_seconds, Some(4.0), "three of five by 4 s, two of five before");
    assert_eq!(row.open, [("time limit", 2)]);
    assert_eq!(row.margin, Some(0.4));
    let [_, answered] = summary::solved_over_time(&entries);
    let shares: Vec<f64> = answered[0].steps.iter().map(|step| step.share).collect();
    assert!(shares.iter().zip([0.2, 0.4, 0.6]).all(|(a, b)| (a - b).abs() < 1e-12), "{shares:?}");
    assert_eq!(answered[0].until, 60.0);

    // One more time-out of six: half are solved, by 4 s. Of seven, less than half, and no median is given.
    let more: Vec<Job> = (6..=7).map(|seed| job(seed, Planner::Exact)).collect();
    let late: Vec<Record> = more.iter().map(|job| made_up(job, 60.0, None, &[])).collect();
    let six = [&entries[..], &[Entry { job: &more[0], record: &late[0] }]].concat();
    assert_eq!(summary::rows(&six).values().next().unwrap()[0].decided_seconds, Some(4.0));
    let seven = [&six[..], &[Entry { job: &more[1], record: &late[1] }]].concat();
    assert_eq!(summary::rows(&seven).values().next().unwrap()[0].decided_seconds, None);
}

#[test]
fn errors_over_time_are_medians_with_missing_plans_counted_as_infinite() {
    let jobs: Vec<Job> =
        (1..=3).map(|seed| Job { objective: Objective::Margin, ..job(seed, Planner::Exact) }).collect();
    // The first has margins 0.2 at 1 s and 0.5 at 3 s, the second 0.4 at 2 s and 0.4 in the end, the third is slow.
    let records = [
        made_up(&jobs[0], 5.0, Some(0.5), &[(1.0, 0.2), (3.0, 0.5)]),
        made_up(&jobs[1], 6.0, Some(0.4), &[(2.0, 0.4)]),
        made_up(&jobs[2], 50.0, Some(0.1), &[(50.0, 0.1)]),
    ];
    let entries: Vec<Entry<'_>> = jobs.iter().zip(&records).map(|(job, record)| Entry { job, record }).collect();
    let curves = summary::error_over_time(&entries, Against::BestKnown);
    let steps: Vec<(f64, f64)> = curves[0].steps.iter().map(|step| (step.seconds, step.share)).collect();
    // Until 2 s two of three have no plan. At 2 s errors are 0.3, 0 and infinite; from 3 s on 0, 0 and infinite.
    assert_eq!(steps.len(), 2, "{steps:?}");
    assert!(steps[0].0 == 2.0 && (steps[0].1 - 0.3).abs() < 1e-12 && steps[1] == (3.0, 0.0), "{steps:?}");
    // Against the bound of 1 while they run, and against themselves once they are proved to be the best: at 2 s 0.8,
    // 0.6 and infinite; at 3 s 0.5 and 0.6; at 5 s 0 and 0.6; at 6 s 0 and 0.
    let curves = summary::error_over_time(&entries, Against::Proved);
    let steps: Vec<(f64, f64)> = curves[0].steps.iter().map(|step| (step.seconds, step.share)).collect();
    let expected = [(2.0, 0.8), (3.0, 0.6), (6.0, 0.0)];
    assert_eq!(steps.len(), 3, "{steps:?}");
    assert!(steps.iter().zip(expected).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-12), "{steps:?}");
}

#[test]
fn plans_that_ignore_stability_are_counted_with_where_they_break() {
    let jobs: Vec<Job> = (1..=4).map(|seed| job(seed, Planner::IgnoreStability)).collect();
    let margins = [Some(0.3), Some(-0.5), Some(f64::NEG_INFINITY), None];
    let records: Vec<Record> = jobs.iter().zip(margins).map(|(job, margin)| made_up(job, 1.0, margin, &[])).collect();
    let entries: Vec<Entry<'_>> = jobs.iter().zip(&records).map(|(job, record)| Entry { job, record }).collect();
    let naive = summary::naive(&entries);
    assert_eq!(naive.len(), 1);
    assert_eq!((naive[0].plans, naive[0].breaking, naive[0].on_the_way, naive[0].faulty), (3, 2, 2, 0));
    assert!(records.iter().all(|record| !record.is_refuted()), "to break is what they are there for");
}

#[test]
fn the_name_of_a_job_says_all_that_it_depends_on() {
    let base = job(1, Planner::Exact);
    let others = [
        Job { planner: Planner::IgnoreStability, ..base.clone() },
        Job { objective: Objective::Margin, ..base.clone() },
        Job { min_margin: 0.1, ..base.clone() },
        Job { time: Duration::from_millis(2500), ..base.clone() },
        Job { bytes: 1 << 29, ..base.clone() },
        Job { request: Request { seed: 2, ..base.request }, ..base.clone() },
        Job { request: Request { modules: 5, ..base.request }, ..base.clone() },
        Job { request: Request { held: true, ..base.request }, ..base.clone() },
        Job { request: Request { difficulty: Some(3), ..base.request }, ..base.clone() },
        Job { request: Request { difficulty: None, ..base.request }, ..base.clone() },
        Job { request: Request { margin: 0.2, ..base.request }, ..base.clone() },
        Job { request: Request { goal: crate::generate::GoalKind::Walk, ..base.request }, ..base.clone() },
        Job { request: Request { setting: crate::generate::Setting::Steps, ..base.request }, ..base.clone() },
        Job { request: Request { family: Family::Rofi, ..base.request }, ..base.clone() },
    ];
    let mut names: Vec<String> = others.iter().map(Job::name).chain([base.name()]).collect();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), others.len() + 1);
}
