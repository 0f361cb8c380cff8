//! Walks through neighbouring states, each assessed as a neighbour of the one
//! before and, for comparison, cold.
//!
//!     cargo bench --bench neighbours

#[path = "../tests/support/random.rs"]
mod random;
#[path = "../tests/support/scenes.rs"]
mod scenes;
#[path = "../tests/support/walks.rs"]
mod walks;

use std::time::Instant;

use steadfast::statics::{Question, Rung, Tally, Verdict, assess, assess_keeping, assess_near};
use walks::Walk;

fn main() {
    let quick = std::env::args().any(|argument| argument == "--test");
    let states = if quick { 10 } else { 200 };
    let only = std::env::args().nth(1).filter(|a| !a.starts_with("--"));
    for walk in walks::trusses().into_iter().chain(walks::cubes()) {
        if only.as_ref().is_none_or(|o| walk.name.contains(o.as_str())) {
            run(walk, states);
        }
    }
}

fn run(mut walk: Walk, states: usize) {
    let question = Question::Decide(1.0);
    let t = assess(&walk.structure, Question::VALUE).unwrap().utilisation.upper;
    walk.strengthen(t / 0.9);
    let (mut answer, mut memory) = assess_keeping(&walk.structure, question).unwrap();
    let mut tally = Tally::default();
    let (mut near, mut cold, mut exact) = (0.0, 0.0, 0.0);
    let mut carried_time = 0.0;
    let mut done = 0;
    let mut rejected = 0;
    let mut undecided: std::collections::BTreeMap<(String, bool), [usize; 2]> = Default::default();
    let mut stable = 0;
    while done < states {
        let (step, next) = walk.neighbour();
        let truth = assess(&next.structure, Question::ToGap(1e-6)).unwrap();
        if !(truth.utilisation.upper < 1.5 && truth.utilisation.lower > 0.5) {
            rejected += 1;
            assert!(rejected < 20 * states, "{}: stuck", walk.name);
            continue;
        }
        let matching: Vec<Option<usize>> = (0..next.structure.bodies.len()).map(Some).collect();
        let timed = |f: &mut dyn FnMut()| {
            let mut best = f64::INFINITY;
            for _ in 0..(if std::env::var("FAST").is_ok() { 1 } else { 3 }) {
                let s = Instant::now();
                f();
                best = f64::min(best, s.elapsed().as_secs_f64() * 1e3);
            }
            best
        };
        let mut got = None;
        let spent = timed(&mut || got = Some(assess_near(&next.structure, question, &memory, &matching).unwrap()));
        near += spent;
        cold += timed(&mut || drop(std::hint::black_box(assess(&next.structure, question))));
        if std::env::var("FAST").is_err() {
            exact += timed(&mut || drop(std::hint::black_box(assess(&next.structure, Question::ToGap(1e-6)))));
        }
        let (a, m) = got.unwrap();
        if a.decided_by.is_without_solve() {
            carried_time += spent;
        }
        assert!(
            a.utilisation.lower <= truth.utilisation.upper * (1.0 + 1e-9) + 1e-12,
            "{} {:?} {:?}",
            walk.name,
            a.utilisation,
            truth.utilisation
        );
        assert!(
            a.utilisation.upper >= truth.utilisation.lower * (1.0 - 1e-9),
            "{} {:?} {:?}",
            walk.name,
            a.utilisation,
            truth.utilisation
        );
        assert_eq!(a.verdict, truth.verdict);
        tally.count(&a);
        stable += usize::from(a.verdict == Verdict::Stable);
        let entry = undecided.entry((format!("{step:?}"), a.verdict == Verdict::Stable)).or_default();
        entry[usize::from(a.decided_by.is_without_solve())] += 1;
        (answer, memory) = (a, m);
        walk.go(next);
        done += 1;
    }
    let _ = &answer;
    let counts: Vec<String> = Rung::ALL.iter().map(|&r| format!("{}", tally.of(r))).collect();
    let share = tally.share_without_solve();
    println!(
        "{:<24} {:>4} bodies  without solve {:>5.1} %  near/decide {:.3} near/1e-6 {:.3}  carried {:.3} ms  cold {:.3} {:.3} ms  stable {} rejected {} rungs {}",
        walk.name,
        walk.structure.bodies.len(),
        share * 100.0,
        near / cold,
        near / exact,
        carried_time / (share * states as f64),
        cold / states as f64,
        exact / states as f64,
        stable,
        rejected,
        counts.join(" ")
    );
    println!("     {:?}", undecided);
    println!(
        "     stages {:?}",
        steadfast::statics::STAGES.iter().map(|s| s.swap(0, std::sync::atomic::Ordering::Relaxed)).collect::<Vec<_>>()
    );
}
