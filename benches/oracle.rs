//! The oracle against a general solver on the paper's formulation and on the
//! standard form, all in this run, in turns. Checks the answers, then times them.
//!
//!     cargo bench --bench oracle

#[path = "support/cone_program.rs"]
mod cone_program;
#[path = "support/machine.rs"]
mod machine;
#[path = "../tests/support/paper.rs"]
mod paper;
#[path = "../tests/support/random.rs"]
mod random;
#[path = "../tests/support/recheck.rs"]
mod recheck;
#[path = "../tests/support/scenes.rs"]
mod scenes;
#[path = "support/standard.rs"]
mod standard;
#[path = "support/timing.rs"]
mod timing;

use std::fmt::Write as _;
use std::io::Write as _;
use std::time::Duration;

use clarabel::solver::SolverStatus;
use cone_program::settings;
use random::{Kind, Random, Recipe, moved, structure};
use steadfast::io::{SourceFile, read_structure};
use steadfast::spatial::Pose;
use steadfast::statics::{Question, Structure, assess};
use timing::{measuring, medians};

/// Tolerance of the general solver: its default.
const TOLERANCE: f64 = 1e-8;

/// "Exact": the gap that the oracle is asked for.
const EXACT: Question = Question::ToGap(1e-6);

/// Which promise a scene is to keep.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Group {
    /// 20 to 100 bodies with loops.
    Loops,
    /// Trees from 100 bodies.
    Trees,
    /// Shown, nothing promised.
    Others,
}

/// Smallest ratios promised, in order: paper over exact, standard over exact, paper over verdict.
const PROMISED: [(Group, &str, [f64; 3]); 2] =
    [(Group::Loops, "20 to 100 bodies with loops", [8.0, 3.0, 15.0]), (Group::Trees, "trees", [300.0, 0.0, 0.0])];

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nothing has started threads yet");
    let scenes = scenes();
    let (budget, most) = if measuring() { (Duration::from_millis(1000), 51) } else { (Duration::ZERO, 1) };
    let mut report = format!(
        "{}; medians of processor time, the methods in turns\n{:<20} {:>6} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8}  {}\n",
        machine::describe(),
        "scene",
        "bodies",
        "paper ms",
        "stand. ms",
        "exact ms",
        "verdict ms",
        "p/exact",
        "s/exact",
        "p/verd.",
        "utilisation"
    );
    let mut ratios: Vec<(Group, String, [f64; 3])> = Vec::new();
    for (group, name, scene) in &scenes {
        if measuring() || scene.bodies.len() <= 20 {
            let (line, ratio) = row(name, scene, budget, most);
            let _ = writeln!(report, "{line}");
            ratios.push((*group, name.clone(), ratio));
        }
    }
    let trees = scenes.iter().filter(|scene| scene.0 == Group::Trees);
    let widths = trees.map(|(_, _, scene)| {
        let proved = assess(scene, EXACT).expect("a valid scene").utilisation;
        proved.width() / proved.upper
    });
    let widest = widths.fold(0.0, f64::max);
    let verdict = if widest <= 1e-12 { "kept" } else { "NOT KEPT" };
    let _ = writeln!(report, "trees: brackets at most {widest:.1e} of the value wide, promised 1e-12: {verdict}");
    for (group, meaning, promised) in PROMISED {
        let names = ["paper / exact", "standard / exact", "paper / verdict"];
        for (k, (name, promised)) in names.into_iter().zip(promised).enumerate().filter(|entry| entry.1.1 > 0.0) {
            let own = ratios.iter().filter(|ratio| ratio.0 == group);
            if let Some(least) = own.min_by(|a, b| a.2[k].total_cmp(&b.2[k])) {
                let verdict = if least.2[k] >= promised { "kept" } else { "NOT KEPT" };
                let _ = writeln!(
                    report,
                    "{meaning}: {name} at least {:.1} ({}), promised {promised}: {verdict}",
                    least.2[k], least.1
                );
            }
        }
    }
    std::io::stdout().write_all(report.as_bytes()).expect("the report can be written");
}

fn scenes() -> Vec<(Group, String, Structure)> {
    let suspension = problems::root().join("structures/suspension_76.json");
    let text = std::fs::read(&suspension).expect("the problem library is there");
    let suspension = read_structure(&SourceFile::new("suspension_76", text)).expect("a sound file").structure;
    let mut random = Random::new(11);
    let turn = Pose::from_parts(random.vector().into(), random.rotation());
    let turned = moved(&scenes::truss([2, 2, 2]), &turn);
    let mut scenes = vec![
        (Group::Loops, "truss 2x2x2".to_owned(), scenes::truss([2, 2, 2])),
        (Group::Loops, "truss 2x2x2, turned".to_owned(), turned),
        (Group::Loops, "truss 3x2x2".to_owned(), scenes::truss([3, 2, 2])),
        (Group::Loops, "truss 5x2x2".to_owned(), scenes::truss([5, 2, 2])),
        (Group::Loops, "suspension 8x4".to_owned(), suspension),
        (Group::Loops, "truss 3x3x3".to_owned(), scenes::truss([3, 3, 3])),
        (Group::Loops, "wall 5x5".to_owned(), scenes::wall(5, 5)),
        (Group::Loops, "wall 8x8".to_owned(), scenes::wall(8, 8)),
        (Group::Trees, "tree 100".to_owned(), scenes::tree(100)),
        (Group::Trees, "tree 1000".to_owned(), scenes::tree(1000)),
        (Group::Trees, "tree 10000".to_owned(), scenes::tree(10_000)),
        (Group::Others, "wall 3x3".to_owned(), scenes::wall(3, 3)),
        (Group::Others, "truss 20x2x2".to_owned(), scenes::truss([20, 2, 2])),
    ];
    for kind in Kind::ALL {
        let recipe = Recipe { kind, bodies: 20, seed: 4 };
        scenes.push((Group::Others, format!("random {kind:?}"), structure(&recipe)));
    }
    scenes
}

/// The line of a scene, and its ratios as in [`PROMISED`].
///
/// # Panics
/// Where the oracle's answer does not stand up to the recheck.
fn row(name: &str, scene: &Structure, budget: Duration, most: usize) -> (String, [f64; 3]) {
    for question in [EXACT, Question::VALUE] {
        let answer = assess(scene, question).expect("a valid scene");
        if let Err(fault) = recheck::recheck(scene, &answer) {
            panic!("{name}: {fault}");
        }
    }
    let says = compare(scene);
    let mut ways: [Box<dyn FnMut()>; 4] = [
        Box::new(|| {
            std::hint::black_box(paper::solve(scene, TOLERANCE));
        }),
        Box::new(|| {
            let solution = standard::program::<f64>(scene).solve(settings(TOLERANCE));
            std::hint::black_box(solution.map(|solution| (solution.status, solution.value)));
        }),
        Box::new(|| {
            std::hint::black_box(assess(scene, EXACT).is_ok());
        }),
        Box::new(|| {
            std::hint::black_box(assess(scene, Question::Decide(1.0)).is_ok());
        }),
    ];
    let times = medians(&mut ways, budget, most);
    let [paper, standard, exact, verdict] = std::array::from_fn(|k| times[k].0);
    let ratios = [paper / exact, standard / exact, paper / verdict];
    let line = format!(
        "{name:<20} {:>6} {paper:>9.2} {standard:>9.2} {exact:>9.3} {verdict:>9.3} {:>8.1} {:>8.1} {:>8.1}  {says}",
        scene.bodies.len(),
        ratios[0],
        ratios[1],
        ratios[2]
    );
    (line, ratios)
}

/// What the general solver says in both formulations, beside the proved bracket.
fn compare(scene: &Structure) -> String {
    let proved = assess(scene, EXACT).expect("a valid scene").utilisation;
    let judge = |t: f64, allowed: f64| {
        let off = (proved.lower - t).max(t - proved.upper).max(0.0) / proved.upper.max(1.0);
        if off <= allowed { "agrees".to_owned() } else { format!("says {t:.6}, off by {off:.0e}") }
    };
    let paper = match paper::solve(scene, TOLERANCE) {
        paper::Answer::Utilisation(t) => judge(t, 1e-5),
        paper::Answer::Infeasible if proved.lower.is_infinite() => "agrees".to_owned(),
        other => format!("says {other:?}"),
    };
    let standard = match standard::program::<f64>(scene).solve(settings(TOLERANCE)) {
        Some(solution) if solution.status == SolverStatus::Solved => {
            judge(solution.value, 1e-5 + solution.residual + (solution.value - solution.dual_value).abs())
        }
        Some(solution) if solution.status == SolverStatus::DualInfeasible && proved.lower.is_infinite() => {
            "agrees".to_owned()
        }
        Some(solution) => format!("says {:?}", solution.status),
        None => "refuses".to_owned(),
    };
    format!("[{:.6}, {:.6}]; paper {paper}, standard {standard}", proved.lower, proved.upper)
}
