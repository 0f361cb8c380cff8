//! The planner against the two cheapest planners that one could think of, problem by problem.

use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use cpu_time::ProcessTime;
use steadfast::reconfigure::{Baseline, Objective, Options, Outcome, Report, solve};
use steadfast::robot::{Configuration, Goal};

use super::Record;

/// Least promised ratios: of oracle time without lazy evaluation, and of expansions without estimates.
const LAZY: f64 = 20.0;
const GUIDED: f64 = 10.0;

/// The planner's processor time for a problem. What it does not solve by then has no ratios.
const LIMIT: Duration = Duration::from_secs(10);

/// Eager evaluation is given up after so many times the oracle time of the planner, and this long more.
const EAGER_PATIENCE: f64 = 30.0;
const EAGER_START: Duration = Duration::from_millis(300);

/// The blind search is given up after so many times the expansions of the planner, or after this long.
const BLIND_PATIENCE: u64 = 15;
const BLIND_LIMIT: Duration = Duration::from_secs(60);

/// How often the processor time of a search is looked at.
const LOOK: Duration = Duration::from_millis(2);

/// What is compared and how, for whoever reads the record.
pub const METHOD: &str = "\
Fewest moves. Oracle time is processor time inside the oracle, structures assembled and checks of their answers included: for \
the planner that of all it does, the values of the plan that it returns and of an early one included. It is compared with two \
planners as one would write them first, both best-first from the start alone:

- *eager*: the same estimates, but every successor of an expanded state is assessed when it is generated, all transient \
states of its move and the states at rest before and after it, each to a value by a solve from nothing. Nothing is remembered \
from one successor to the next, no bound replaces a solve, and states that follow one that falls are not left out.
- *blind*: the planner's own lazy evaluation, but nothing is known of how far it is to the goal (uniform cost).

A baseline that was given up (>) has spent at least as much as it had by then, and so do the sums. A ratio in expansions counts the \
expansions of all the planner's searches, from either end and greedy ones included. The baselines are searches of robots in a \
lattice: the suite's struts and nodes and its chains are not compared.
";

/// A problem, and the fewest moves where they are known from elsewhere.
pub struct Problem {
    pub name: String,
    pub start: Configuration,
    pub goal: Goal,
    pub moves: Option<u32>,
}

/// Both baselines on every problem.
pub fn compare(title: &str, problems: impl Iterator<Item = Problem>, promised: bool, record: &mut Record) {
    let _ = write!(
        record.text,
        "\n### {title}\n\n| problem | moves | oracle s | eager | ratio | expanded | blind | ratio |\n\
         | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n"
    );
    let mut ratios: [Ratios; 2] = Default::default();
    for problem in problems {
        compare_one(&problem, &mut ratios, record);
    }
    for (ratios, least, what) in ratios.iter_mut().zip([LAZY, GUIDED]).zip(["oracle time", "expansions"]).map(flat) {
        let (together, median) = (ratios.together(), ratios.median());
        let at_least = if ratios.is_censored { "at least " } else { "" };
        let _ = write!(record.text, "\nAll together, ratio of {what}: {at_least}{together:.1}, median {median:.1}");
        let kept = if together >= least { "kept" } else { "NOT KEPT" };
        let promise = if promised { format!("; promised at least {least}: {kept}.\n") } else { ".\n".to_owned() };
        record.text += &promise;
    }
}

fn flat<A, B, C>(((a, b), c): ((A, B), C)) -> (A, B, C) {
    (a, b, c)
}

fn compare_one(problem: &Problem, ratios: &mut [Ratios; 2], record: &mut Record) {
    let Problem { name, .. } = problem;
    let options =
        Options { objective: Objective::Moves, clock: Some(|| ProcessTime::now().as_duration()), ..Options::default() };
    let ours = run(problem, options.clone(), LIMIT);
    let (oracle, expanded) = (ours.statistics.oracle_seconds, ours.statistics.expanded);
    if ours.outcome != Outcome::Solved {
        let _ = writeln!(record.text, "| {name} | not proved | >{oracle:.3} | | | >{expanded} | | |");
        return;
    }
    let moves = check(problem, &ours, problem.moves);
    let patience = EAGER_START + Duration::from_secs_f64(EAGER_PATIENCE * oracle);
    let eager = run(problem, Options { baseline: Some(Baseline::Eager), ..options.clone() }, patience);
    let most = Some(expanded * BLIND_PATIENCE);
    let blind = Options { baseline: Some(Baseline::Blind), max_expansions: most, ..options };
    let blind = run(problem, blind, BLIND_LIMIT);
    let mut mark = [""; 2];
    for (mark, report) in mark.iter_mut().zip([&eager, &blind]) {
        match report.outcome {
            Outcome::Solved => _ = check(problem, report, Some(moves)),
            _ => *mark = ">",
        }
    }
    let (eager, blind) = (eager.statistics.oracle_seconds, blind.statistics.expanded);
    let in_time = ratios[0].add(oracle, eager, mark[0] == ">");
    let in_expansions = ratios[1].add(expanded as f64, blind as f64, mark[1] == ">");
    let [eager_is, blind_is] = mark;
    let row = format!(
        "| {name} | {moves} | {oracle:.4} | {eager_is}{eager:.3} | {eager_is}{in_time:.1} | {expanded} | \
         {blind_is}{blind} | {blind_is}{in_expansions:.1} |\n"
    );
    // It takes minutes until all are there.
    let _ = std::io::stderr().write_all(row.as_bytes());
    record.text += &row;
    let _ = writeln!(record.table, "eager,{name},{oracle},{eager},{eager_is}{in_time}");
    let _ = writeln!(record.table, "blind,{name},{expanded},{blind},{blind_is}{in_expansions}");
}

/// Searches until it is done, or has taken so much of the processor.
fn run(problem: &Problem, options: Options, most: Duration) -> Report {
    let (cancel, is_done) = (Arc::new(AtomicBool::new(false)), AtomicBool::new(false));
    let options = Options { cancel: Some(Arc::clone(&cancel)), ..options };
    let began = ProcessTime::now();
    std::thread::scope(|scope| {
        scope.spawn(|| {
            while !is_done.load(Ordering::Relaxed) {
                cancel.store(began.elapsed() > most, Ordering::Relaxed);
                std::thread::sleep(LOOK);
            }
        });
        let report = solve(&problem.start, &problem.goal, &options, &mut |_| {});
        is_done.store(true, Ordering::Relaxed);
        report.expect("the problem is sound")
    })
}

/// The number of moves of a proved answer, which is as many as expected.
fn check(problem: &Problem, report: &Report, expected: Option<u32>) -> u32 {
    let moves = report.plan.as_ref().map(|plan| plan.moves).expect("it was solved");
    assert!(report.proof.optimal && expected.is_none_or(|expected| expected == moves), "{}: {moves}", problem.name);
    moves
}

/// What a baseline took against what the planner did.
#[derive(Default)]
struct Ratios {
    sums: [f64; 2],
    each: Vec<f64>,
    is_censored: bool,
}

impl Ratios {
    fn add(&mut self, ours: f64, other: f64, is_censored: bool) -> f64 {
        self.sums[0] += ours;
        self.sums[1] += other;
        self.is_censored |= is_censored;
        self.each.push(other / ours);
        other / ours
    }

    fn together(&self) -> f64 {
        self.sums[1] / self.sums[0]
    }

    fn median(&mut self) -> f64 {
        self.each.sort_by(f64::total_cmp);
        self.each.get(self.each.len() / 2).copied().unwrap_or(f64::NAN)
    }
}
