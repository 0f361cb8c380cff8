//! Planning against the two cheapest baselines, and how long proofs take.
//!
//!     cargo bench --bench planning
//!
//! On the cubes of the standard suite and on the planning problems of the library, with one thread: what lazy evaluation
//! saves of the oracle's time against evaluating every successor by cold solves, and what estimates save in expansions. Then the
//! margin-optimal plans of eight cubes with their proofs, and where they are kept beside the repository the shortest plans of
//! RoFI modules without gravity. Every answer is checked against the manifest before it counts. Writes
//! `benches/record/planning.{md,csv}`.

#[path = "planning/baselines.rs"]
mod baselines;
#[path = "support/machine.rs"]
mod machine;
#[path = "support/publish.rs"]
mod publish;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::PathBuf;

use cpu_time::ProcessTime;
use problems::{Manifest, PlanningCase};
use steadfast::generate::{Family, Pair, generate};
use steadfast::io::{LatticeProblem, SourceFile, no_references, read_linkage, read_problem, read_suite};
use steadfast::reconfigure::{Objective, Options, Outcome, Report, linkage, solve};
use steadfast::robot::Matching;
use steadfast::robot::linkage::Goal;
use steadfast::suite::{Job, Planner};

use baselines::Problem;

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

/// Both baselines on the cubes of the standard suite that are searched exactly, and on the library's problems that have a
/// plan with moves under gravity.
fn baselines(manifest: &Manifest, quick: bool, record: &mut Record) {
    let most = if quick { 2 } else { usize::MAX };
    record.text += "## Baselines\n\n";
    record.text += baselines::METHOD;
    baselines::compare("Cubes of the standard suite", of_suite().into_iter().take(most), true, record);
    let is_asked = |case: &PlanningCase| case.modules <= SMALL && case.moves.moves.is_some_and(|moves| moves > 0);
    let cases = manifest.cubes.iter().filter(|(name, case)| is_asked(case) && *name != "no_gravity");
    let of_library = cases.take(most).map(|(name, case)| {
        let LatticeProblem { start, goal, .. } = read(name);
        Problem { name: name.clone(), start, goal, moves: case.moves.moves }
    });
    baselines::compare("The library", of_library, false, record);
}

/// The problems of cubes that the standard suite searches exactly, each once.
fn of_suite() -> Vec<Problem> {
    let path = problems::root().join("suites/standard.toml");
    let file = SourceFile::new("standard.toml", std::fs::read(path).expect("the suite is there"));
    let jobs = read_suite(&file).expect("the suite is sound").jobs();
    let cubes = jobs.iter().filter(|job| (job.request.family, job.planner) == (Family::Cubes, Planner::Exact));
    let mut names = BTreeSet::new();
    let each = cubes.filter(|job| names.insert(job.problem()));
    let problem = |job: &Job| match generate(&job.request).expect("the suite's problems can be drawn").pair {
        Pair::Lattice { start, goal } => Problem { name: job.problem(), start, goal, moves: None },
        Pair::Linkage { .. } => unreachable!("cubes sit in a lattice"),
    };
    each.map(problem).collect()
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
