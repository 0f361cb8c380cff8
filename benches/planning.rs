//! Planning against the two cheapest baselines, and how long proofs take.
//!
//!     cargo bench --bench planning
//!
//! On the planning problems of the library, with one thread: what lazy evaluation saves against evaluating every
//! successor by cold solves, and what estimates and the search from both ends save in expansions. Then the
//! margin-optimal plans of eight cubes with their proofs, and where they are kept beside the repository the shortest plans of
//! RoFI modules without gravity. Every answer is checked against the manifest before it counts. Writes
//! `benches/record/planning.{md,csv}`.

#[path = "support/machine.rs"]
mod machine;
#[path = "support/publish.rs"]
mod publish;

use std::fmt::Write as _;
use std::path::PathBuf;

use cpu_time::ProcessTime;
use problems::{Manifest, PlanningCase};
use steadfast::io::{LatticeProblem, SourceFile, no_references, read_linkage, read_problem};
use steadfast::reconfigure::{Baseline, Objective, Options, Outcome, Report, linkage, solve};
use steadfast::robot::Matching;
use steadfast::robot::linkage::Goal;

/// Least promised ratios: of processor time without lazy evaluation, and of expansions without estimates.
const LAZY: f64 = 20.0;
const GUIDED: f64 = 10.0;

/// A baseline is given up after so many times the expansions of the planner; its ratio is then at least that.
const PATIENCE: u64 = 30;

/// Problems with more modules are left out of the comparison with baselines.
const SMALL: usize = 6;

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nothing has started threads yet");
    let manifest = problems::manifest().expect("the manifest is sound");
    let quick = publish::only_starts();
    let text = format!("# Planning\n\n{}.\n\n", machine::describe());
    let mut record = Record { text, table: "question,problem,ours,other,ratio\n".to_owned() };
    baselines(&manifest, quick, &mut record);
    proofs(&manifest, quick, &mut record);
    rofi(quick, &mut record);
    publish::publish("planning", &record.text, &record.table);
}

/// What is written down.
struct Record {
    text: String,
    table: String,
}

/// Runs a search; processor seconds with its report.
fn timed(problem: &LatticeProblem, options: &Options) -> (f64, Report) {
    let began = ProcessTime::now();
    let report = solve(&problem.start, &problem.goal, options, &mut |_| {}).expect("the problem is sound");
    (began.elapsed().as_secs_f64(), report)
}

/// Both baselines on every small problem that has a plan with moves under gravity.
fn baselines(manifest: &Manifest, quick: bool, record: &mut Record) {
    let is_asked = |case: &PlanningCase| case.modules <= SMALL && case.moves.moves.is_some_and(|moves| moves > 0);
    let cases = manifest.cubes.iter().filter(|(name, case)| is_asked(case) && *name != "no_gravity");
    record.text += &format!(
        "## Baselines\n\nFewest moves. Processor seconds of the planner (all of it) and with every successor evaluated \
         by cold solves; expansions, greedy search included, and from the start alone without estimates, given up \
         after {PATIENCE} times as many.\n\n| problem | moves | s | s, eager | ratio | expanded | expanded, blind | ratio |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- |\n"
    );
    let mut sums = [0.0; 4];
    for (name, case) in cases.take(if quick { 2 } else { usize::MAX }) {
        let problem = read(name);
        let options = Options { objective: Objective::Moves, ..Options::default() };
        let (ours, report) = timed(&problem, &options);
        check(name, &report, case.moves.moves);
        let expanded = report.statistics.expanded;
        let (eager, report) = timed(&problem, &Options { baseline: Some(Baseline::Eager), ..options.clone() });
        check(name, &report, case.moves.moves);
        let most = Some(expanded * PATIENCE);
        let blind = Options { baseline: Some(Baseline::Blind), max_expansions: most, ..options };
        let (_, report) = timed(&problem, &blind);
        let blind = report.statistics.expanded;
        if report.outcome == Outcome::Solved {
            check(name, &report, case.moves.moves);
        }
        let moves = case.moves.moves.unwrap_or_default();
        let (in_time, in_expansions) = (eager / ours, blind as f64 / expanded as f64);
        let _ = writeln!(
            record.text,
            "| {name} | {moves} | {ours:.3} | {eager:.3} | {in_time:.1} | {expanded} | {blind} | {in_expansions:.1} |"
        );
        let _ = writeln!(record.table, "eager,{name},{ours},{eager},{in_time}");
        let _ = writeln!(record.table, "blind,{name},{expanded},{blind},{in_expansions}");
        for (sum, more) in sums.iter_mut().zip([ours, eager, expanded as f64, blind as f64]) {
            *sum += more;
        }
    }
    let [ours, eager, expanded, blind] = sums;
    let ratios = [(eager / ours, LAZY, "time"), (blind / expanded, GUIDED, "expansions")];
    for (ratio, promised, what) in ratios {
        let kept = if ratio >= promised { "kept" } else { "NOT KEPT" };
        let _ =
            writeln!(record.text, "\nAll together, ratio of {what}: {ratio:.1}; promised at least {promised}: {kept}.");
    }
}

/// Margin-optimal plans of eight cubes.
fn proofs(manifest: &Manifest, quick: bool, record: &mut Record) {
    record.text += "\n## Margin-optimal plans, proved\n\n| problem | modules | moves | margin | s | expanded | certified \
                    | oracle solves | without a solve |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    let cases = manifest.cubes.iter().filter(|(_, case)| case.margin.is_some() && case.modules >= SMALL);
    for (name, case) in cases.take(if quick { 1 } else { usize::MAX }) {
        let problem = read(name);
        let (seconds, report) = timed(&problem, &Options::default());
        check(name, &report, case.margin.as_ref().map(|margin| margin.moves));
        let margin = report.plan.as_ref().and_then(|plan| plan.margin).map_or(f64::NAN, |margin| margin.lower);
        let moves = report.plan.as_ref().map_or(0, |plan| plan.moves);
        let statistics = &report.statistics;
        let _ = writeln!(
            record.text,
            "| {name} | {} | {moves} | {margin:.4} | {seconds:.2} | {} | {} | {} | {:.0} % |",
            case.modules,
            statistics.expanded,
            statistics.certified,
            statistics.oracle_solves,
            100.0 * statistics.decided_by.share_without_solve()
        );
        let _ = writeln!(record.table, "margin,{name},{seconds},,");
    }
}

/// The answer is that of the manifest, and proved.
fn check(name: &str, report: &Report, moves: Option<u32>) {
    assert_eq!(report.outcome, Outcome::Solved, "{name}");
    assert_eq!(report.plan.as_ref().map(|plan| plan.moves), moves, "{name}");
    assert!(report.proof.optimal, "{name}");
}

fn read(name: &str) -> LatticeProblem {
    let directory = problems::root().join("cubes").join(name);
    let file = |which: &str| SourceFile::new(which, std::fs::read(directory.join(which)).expect("the file is there"));
    let beside = |_: &str, name: &str| {
        let bytes = std::fs::read(directory.join(name)).map_err(|error| error.to_string())?;
        Ok(SourceFile::new(name, bytes))
    };
    let problem = read_problem(&file("start.json"), &file("goal.json"), &beside).expect("the problem reads");
    problem.into_lattice().expect("all modules sit in a lattice")
}

/// Shortest plans of RoFI modules without gravity, where the platform's instances are.
fn rofi(quick: bool, record: &mut Record) {
    let directory = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/cases/rofi_plan");
    let Ok(entries) = std::fs::read_dir(directory) else { return };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    record.text += "\n## RoFI modules without gravity, shortest plans proved\n\n| instance | modules | moves | s | expanded |\n\
                    | --- | --- | --- | --- | --- |\n";
    for path in paths.iter().take(if quick { 1 } else { usize::MAX }) {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let value: serde_json::Value =
            serde_json::from_slice(&std::fs::read(path).expect("it was listed")).expect("the instance is JSON");
        let read = |key: &str| {
            let text = serde_json::to_vec(&value[key]).expect("JSON can be written");
            read_linkage(&SourceFile::new(key, text), &no_references).expect("the world reads")
        };
        let goal = Goal { linkage: read("goal"), matching: Matching { labelled: false, free_frame: true } };
        let options = Options { objective: Objective::Moves, ignore_stability: true, ..Options::default() };
        let start = read("start");
        let began = ProcessTime::now();
        let report = linkage::solve(&start, &goal, &options, &mut |_| {}).expect("the problem is sound");
        let seconds = began.elapsed().as_secs_f64();
        let moves = report.plan.as_ref().map(|plan| u64::from(plan.moves));
        assert!(report.proof.optimal && moves == value["shortest"].as_u64(), "{name}: {moves:?}");
        let moves = moves.unwrap_or_default();
        let (modules, expanded) = (&value["modules"], report.statistics.expanded);
        let _ = writeln!(record.text, "| {name} | {modules} | {moves} | {seconds:.2} | {expanded} |");
        let _ = writeln!(record.table, "rofi,{name},{seconds},,");
    }
}
