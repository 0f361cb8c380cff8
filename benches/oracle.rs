//! The oracle against the paper's formulation on one standard solver, both in
//! this run, in turns. Checks both answers, then times them.
//!
//!     cargo bench --bench oracle

#[path = "../tests/support/paper.rs"]
mod paper;
#[path = "../tests/support/random.rs"]
mod random;
#[path = "../tests/support/recheck.rs"]
mod recheck;
#[path = "../tests/support/scenes.rs"]
mod scenes;

use std::fmt::Write as _;
use std::io::Write as _;
use std::time::{Duration, Instant};

use random::{Kind, Random, Recipe, moved, structure};
use steadfast::io::{SourceFile, read_structure};
use steadfast::spatial::Pose;
use steadfast::statics::{Question, Structure, assess};

/// Time per scene and method after which no further repetition starts.
const BUDGET: Duration = Duration::from_millis(1500);

/// Most repetitions of one method on one scene.
const REPETITIONS: usize = 51;

/// Tolerance of the paper's formulation: the solver's default.
const TOLERANCE: f64 = 1e-8;

fn main() {
    // `cargo test --benches` only wants to see that it starts.
    let quick = std::env::args().any(|argument| argument == "--test");
    let mut report = header();
    let _ = writeln!(
        report,
        "{:<20} {:>6} {:>10} {:>10} {:>10} {:>9} {:>9}  paper says",
        "scene", "bodies", "paper ms", "value ms", "decide ms", "p/value", "p/decide"
    );
    for (name, scene) in scenes() {
        if !quick || scene.bodies.len() <= 20 {
            let _ = writeln!(report, "{}", row(&name, &scene, if quick { 1 } else { REPETITIONS }));
        }
    }
    std::io::stdout().write_all(report.as_bytes()).expect("the report can be written");
}

fn header() -> String {
    let run = |program: &str, arguments: &[&str]| {
        let output = std::process::Command::new(program).args(arguments).output().ok();
        output.map_or_else(String::new, |out| String::from_utf8_lossy(&out.stdout).trim().to_owned())
    };
    let revision = run("git", &["describe", "--always", "--dirty"]);
    let processors = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = processors.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("unknown");
    let model = model.trim_start_matches(['\t', ' ', ':']);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').next().unwrap_or("unknown");
    format!("revision {revision}; {model}, {cores} cores, load {load}; one thread; medians, the methods in turns\n")
}

fn scenes() -> Vec<(String, Structure)> {
    let suspension = problems::root().join("structures/suspension_76.json");
    let text = std::fs::read(&suspension).expect("the problem library is there");
    let suspension = read_structure(&SourceFile::new("suspension_76", text)).expect("a sound file").structure;
    let mut scenes = vec![
        ("suspension 8x4".to_owned(), suspension),
        ("truss 2x2x2".to_owned(), scenes::truss([2, 2, 2])),
        ("truss 5x2x2".to_owned(), scenes::truss([5, 2, 2])),
        ("wall 3x3".to_owned(), scenes::wall(3, 3)),
        ("wall 4x4".to_owned(), scenes::wall(4, 4)),
        ("tree 100".to_owned(), scenes::tree(100)),
        ("tree 10000".to_owned(), scenes::tree(10_000)),
    ];
    for kind in Kind::ALL {
        let recipe = Recipe { kind, bodies: 20, seed: 4 };
        scenes.push((format!("random {kind:?}"), structure(&recipe)));
    }
    let mut random = Random::new(11);
    let turn = Pose::from_parts(random.vector().into(), random.rotation());
    scenes.push(("truss 2x2x2, turned".to_owned(), moved(&scenes::truss([2, 2, 2]), &turn)));
    scenes
}

fn row(name: &str, scene: &Structure, repetitions: usize) -> String {
    let answer = assess(scene, Question::VALUE).expect("a valid scene");
    if let Err(fault) = recheck::recheck(scene, &answer) {
        panic!("{name}: {fault}");
    }
    let (lower, upper) = (answer.utilisation.lower, answer.utilisation.upper);
    let says = match paper::solve(scene, TOLERANCE) {
        paper::Answer::Utilisation(t) => {
            let off = (lower - t).max(t - upper).max(0.0) / upper.max(1.0);
            if off <= 1e-5 {
                format!("{t:.6}, agrees")
            } else {
                format!("{t:.6}, off by {off:.0e} of [{lower:.6}, {upper:.6}]")
            }
        }
        other => format!("{other:?}, we say [{lower:.6}, {upper:.6}]"),
    };
    let mut times: [Vec<f64>; 3] = Default::default();
    let started = Instant::now();
    while times[0].len() < repetitions && (times[0].is_empty() || started.elapsed() < 3 * BUDGET) {
        times[0].push(milliseconds(|| paper::solve(scene, TOLERANCE)));
        times[1].push(milliseconds(|| assess(scene, Question::VALUE)));
        times[2].push(milliseconds(|| assess(scene, Question::Decide(1.0))));
    }
    let [paper, value, decide] = times.map(median);
    let (by_value, by_decide) = (paper / value, paper / decide);
    let bodies = scene.bodies.len();
    format!(
        "{name:<20} {bodies:>6} {paper:>10.2} {value:>10.2} {decide:>10.2} {by_value:>9.1} {by_decide:>9.1}  {says}"
    )
}

fn milliseconds<T>(work: impl FnOnce() -> T) -> f64 {
    let started = Instant::now();
    std::hint::black_box(work());
    started.elapsed().as_secs_f64() * 1e3
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
