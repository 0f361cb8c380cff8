//! What each reduction saves: every scene with all of them, with each one
//! switched off, and with none, in turns.
//!
//!     cargo bench --bench ablation
//!
//! Checks first that no reduction changes the answer: all brackets have a point in
//! common. Times are those of a clock on the wall, since blocks are solved on all
//! cores. Writes `benches/record/ablation.{csv,md}`.

#[path = "ablation/scenes.rs"]
mod ablation_scenes;
#[path = "support/machine.rs"]
mod machine;
#[path = "support/publish.rs"]
mod publish;
#[path = "../tests/support/random.rs"]
#[expect(dead_code, reason = "what tests turn about stays as it is here")]
mod random;
#[path = "../tests/support/scenes.rs"]
mod scenes;

use std::fmt::Write as _;
use std::time::Instant;

use ablation_scenes::{Scene, all};
use steadfast::statics::{Explanation, Question, Reductions, assess_reduced, explain};

/// What is asked: the value to the promised width.
const QUESTION: Question = Question::ToGap(1e-6);

/// Most rounds, and seconds after which a way is not timed again.
const ROUNDS: usize = 21;
const BUDGET: f64 = 1.0;

/// What counts as quick, in ms.
const QUICK: f64 = 10.0;

/// Room between brackets for the rounding in what is left of the data.
const ROOM: f64 = 1e-8;

const WAYS: [(&str, Reductions); 8] = [
    ("all", Reductions::ALL),
    ("no rigid links", Reductions { rigid_links: false, ..Reductions::ALL }),
    ("no blocks", Reductions { blocks: false, ..Reductions::ALL }),
    ("no closed form", Reductions { closed_form: false, ..Reductions::ALL }),
    ("no chains", Reductions { chains: false, ..Reductions::ALL }),
    ("no planes", Reductions { planar: false, ..Reductions::ALL }),
    ("not parallel", Reductions { parallel: false, ..Reductions::ALL }),
    ("none", Reductions::NONE),
];

/// One scene: fastest time by way in ms, the range of t that all brackets allow, and what is left.
struct Row {
    scene: &'static str,
    bodies: usize,
    links: usize,
    times: [f64; WAYS.len()],
    utilisation: [f64; 2],
    left: Explanation,
}

fn main() {
    let quick = publish::only_starts();
    let scenes = all().into_iter().filter(|scene| !quick || scene.structure.bodies.len() <= 40);
    let rows: Vec<Row> = scenes.map(|scene| measure(&scene, if quick { 1 } else { ROUNDS })).collect();
    publish::publish("ablation", &report(&rows), &table(&rows));
}

fn measure(scene: &Scene, rounds: usize) -> Row {
    let structure = &scene.structure;
    let ask = |reductions| assess_reduced(structure, QUESTION, reductions).expect("the scenes are sound");
    let (mut lower, mut upper) = (f64::NEG_INFINITY, f64::INFINITY);
    for (way, reductions) in WAYS {
        let found = ask(reductions).utilisation;
        (lower, upper) = (lower.max(found.lower), upper.min(found.upper));
        assert!(lower <= upper * (1.0 + ROOM) + ROOM, "{}, {way}: {found:?} excludes an answer before it", scene.name);
    }
    let (mut times, mut spent) = ([f64::INFINITY; WAYS.len()], [0.0; WAYS.len()]);
    for _ in 0..rounds {
        for (k, (_, reductions)) in WAYS.into_iter().enumerate() {
            if spent[k] >= BUDGET {
                continue;
            }
            // What is quick runs once more: the way before may have left it cold caches.
            if times[k] < QUICK {
                std::hint::black_box(ask(reductions));
            }
            let started = Instant::now();
            std::hint::black_box(ask(reductions));
            let seconds = started.elapsed().as_secs_f64();
            spent[k] += seconds;
            times[k] = times[k].min(seconds * 1e3);
        }
    }
    Row {
        scene: scene.name,
        bodies: structure.bodies.len(),
        links: structure.connections.len() + structure.contacts.len(),
        times,
        utilisation: [lower, upper],
        left: explain(structure, Reductions::ALL).expect("the scenes are sound"),
    }
}

fn report(rows: &[Row]) -> String {
    let mut text = format!(
        "# What is left out\n\n{}\n\nMilliseconds to a gap of 1e-6, of up to {ROUNDS} rounds in turns the fastest, by the \
         clock on the wall and with all cores. In brackets: times what it takes with all reductions. The brackets of all \
         eight answers have a point in common on every scene.\n\n| scene | bodies | links | t |",
        machine::describe().replace("; one thread", "")
    );
    for (way, _) in WAYS {
        let _ = write!(text, " {way} |");
    }
    text += "\n|";
    text += &" --- |".repeat(4 + WAYS.len());
    for row in rows {
        let [lower, upper] = row.utilisation;
        let _ =
            write!(text, "\n| {} | {} | {} | {:.6} |", row.scene, row.bodies, row.links, f64::midpoint(lower, upper));
        for (k, time) in row.times.iter().enumerate() {
            let _ = write!(text, " {time:.3}");
            text += &if k == 0 { " |".to_owned() } else { format!(" ({:.1}) |", time / row.times[0]) };
        }
    }
    text += "\n\nWhat was left out, and what remained:\n\n\
             | scene | merged bodies | closed form | in chains | blocks | planar | largest | unknown wrenches | equations | cones |\n\
             | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |";
    for Row { scene, left, .. } in rows {
        let blocks = &left.remaining;
        let _ = write!(
            text,
            "\n| {scene} | {} | {} | {} | {} | {} | {} | {} | {} | {} |",
            left.merged_bodies,
            left.closed_form_connections + left.closed_form_contacts,
            blocks.iter().map(|block| block.bodies_in_chains).sum::<usize>(),
            blocks.len(),
            blocks.iter().filter(|block| block.is_planar()).count(),
            blocks.iter().map(|block| block.bodies).max().unwrap_or(0),
            blocks.iter().map(|block| block.unknown_wrenches).sum::<usize>(),
            blocks.iter().map(|block| block.equations).sum::<usize>(),
            blocks.iter().map(|block| block.friction_cones + block.connector_cones).sum::<usize>(),
        );
    }
    text + "\n"
}

fn table(rows: &[Row]) -> String {
    let mut text = "scene,bodies,links,lower,upper".to_owned();
    for (way, _) in WAYS {
        let _ = write!(text, ",{}_ms", way.replace(' ', "_"));
    }
    for Row { scene, bodies, links, times, utilisation: [lower, upper], .. } in rows {
        let _ = write!(text, "\n{scene},{bodies},{links},{lower},{upper}");
        for time in times {
            let _ = write!(text, ",{time:.4}");
        }
    }
    text + "\n"
}
