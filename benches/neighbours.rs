//! Walks through neighbouring states: how many are decided by bounds carried over
//! from the state before, and what that costs against cold solves.
//!
//!     cargo bench --bench neighbours
//!
//! Every verdict and bracket is checked against a cold solve before anything is
//! timed. Writes `benches/record/neighbours.{csv,md}`.

#[path = "support/machine.rs"]
mod machine;
#[path = "support/publish.rs"]
mod publish;
#[path = "../tests/support/random.rs"]
#[expect(dead_code, reason = "what tests build on is not walked on here")]
mod random;
#[path = "../tests/support/scenes.rs"]
#[expect(dead_code, reason = "what tests build on is not walked on here")]
mod scenes;
#[path = "../tests/support/walks.rs"]
mod walks;

use std::fmt::Write as _;

use cpu_time::ProcessTime;
use steadfast::statics::{Assessment, Question, Rung, Tally, Verdict, assess, assess_keeping, assess_near};
use walks::{Step, Walk};

/// States per walk.
const STATES: usize = 200;

/// Utilisations that the walk keeps between: both verdicts occur.
const RANGE: [f64; 2] = [0.5, 1.5];

/// Repetitions of every timing, of which the fastest counts.
const REPETITIONS: usize = 5;

const STEPS: [Step; 4] = [Step::Removed, Step::Added, Step::Moved, Step::Shifted];

const DECIDE: Question = Question::Decide(1.0);
const EXACT: Question = Question::ToGap(1e-6);

/// Least share of the states that bounds are promised to decide, and largest promised mean
/// cost of a state over that of a cold solve.
const DECIDED: f64 = 0.8;
const COST: f64 = 0.2;

fn main() {
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("nothing has started threads yet");
    let quick = publish::only_starts();
    let states = if quick { 5 } else { STATES };
    let walks = walks::trusses().into_iter().chain(walks::cubes());
    let rows: Vec<Row> = walks.map(|walk| measure(walk, states, if quick { 1 } else { REPETITIONS })).collect();
    publish::publish("neighbours", &report(&rows, states), &table(&rows));
}

/// What was found on one walk.
struct Row {
    name: &'static str,
    bodies: usize,
    links: usize,
    stable: usize,
    tally: Tally,
    /// States by step, without and with a solve.
    steps: Vec<(Step, [usize; 2])>,
    /// Mean milliseconds per state: as neighbours, those of them that bounds
    /// decided, cold for the verdict, and cold to a gap of 1e-6.
    near: f64,
    bounds: f64,
    decide: f64,
    exact: f64,
}

fn measure(mut walk: Walk, states: usize, repetitions: usize) -> Row {
    let t = assess(&walk.structure, Question::VALUE).expect("sound").utilisation.upper;
    walk.strengthen(t / 0.9);
    let mut memory = assess_keeping(&walk.structure, DECIDE).expect("sound").1;
    let mut row = Row {
        name: walk.name,
        bodies: walk.structure.bodies.len(),
        links: walk.structure.connections.len() + walk.structure.contacts.len(),
        stable: 0,
        tally: Tally::default(),
        steps: STEPS.map(|step| (step, [0, 0])).to_vec(),
        near: 0.0,
        bounds: 0.0,
        decide: 0.0,
        exact: 0.0,
    };
    let matching: Vec<Option<usize>> = (0..row.bodies).map(Some).collect();
    let mut rejected = 0;
    while row.tally.total() < states as u64 {
        let (step, next) = walk.neighbour();
        let truth = assess(&next.structure, Question::VALUE).expect("sound");
        if !(truth.utilisation.lower > RANGE[0] && truth.utilisation.upper < RANGE[1]) {
            rejected += 1;
            assert!(rejected < 100 * states, "{}: there is nowhere to go", walk.name);
            continue;
        }
        let ask = || assess_near(&next.structure, DECIDE, &memory, &matching).expect("a sound neighbour");
        let (answer, kept) = ask();
        check(walk.name, &answer, &truth);
        let near = fastest(repetitions, ask);
        row.near += near;
        row.decide += fastest(repetitions, || assess(&next.structure, DECIDE));
        row.exact += fastest(repetitions, || assess(&next.structure, EXACT));
        let solved = !answer.decided_by.is_without_solve();
        if !solved {
            row.bounds += near;
        }
        row.tally.count(&answer);
        row.stable += usize::from(answer.verdict == Verdict::Stable);
        let steps = row.steps.iter_mut().find(|(of, _)| *of == step).expect("all steps are listed");
        steps.1[usize::from(solved)] += 1;
        memory = kept;
        walk.go(next);
    }
    row.bounds /= row.tally.share_without_solve() * states as f64;
    for time in [&mut row.near, &mut row.decide, &mut row.exact] {
        *time /= states as f64;
    }
    row
}

/// The answer against a cold solve.
fn check(name: &str, answer: &Assessment, truth: &Assessment) {
    let (near, cold) = (answer.utilisation, truth.utilisation);
    assert!(near.lower <= cold.upper + 1e-9 && cold.lower <= near.upper + 1e-9, "{name}: {near:?} against {cold:?}");
    assert_eq!(answer.verdict, truth.verdict, "{name}: {near:?} against {cold:?}");
}

/// Milliseconds of processor time of the fastest of some repetitions.
fn fastest<T>(repetitions: usize, work: impl Fn() -> T) -> f64 {
    let once = |_| {
        let started = ProcessTime::now();
        std::hint::black_box(work());
        started.elapsed().as_secs_f64() * 1e3
    };
    (0..repetitions).map(once).fold(f64::INFINITY, f64::min)
}

fn report(rows: &[Row], states: usize) -> String {
    let mut text = format!(
        "# Neighbouring states\n\n{}; {states} states per walk; of {REPETITIONS} processor times the fastest.\n\n",
        machine::describe()
    );
    text += "Mean milliseconds per state: `near` as a neighbour of the state before, solved where bounds did not decide; \
             `bounds` those that bounds decided; `decide` and `1e-6` cold, for the verdict and for the value. Promised: \
             at least 80 % without a solve, and a mean cost of at most a fifth of a cold solve (to 1e-6).\n\n";
    text += "| walk | bodies | links | stable | without solve | promised | near | bounds | decide | 1e-6 | near / decide \
             | near / 1e-6 | promised |\n";
    text += "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
    let promised = |kept: bool| if kept { "kept" } else { "NOT KEPT" };
    for row in rows {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {:.1} % | {} | {:.3} | {:.3} | {:.3} | {:.3} | {:.2} | {:.2} | {} |",
            row.name,
            row.bodies,
            row.links,
            row.stable,
            100.0 * row.tally.share_without_solve(),
            promised(row.tally.share_without_solve() >= DECIDED),
            row.near,
            row.bounds,
            row.decide,
            row.exact,
            row.near / row.decide,
            row.near / row.exact,
            promised(row.near <= COST * row.exact)
        );
    }
    let mean = |of: &dyn Fn(&Row) -> f64| rows.iter().map(of).sum::<f64>() / rows.len() as f64;
    let _ = writeln!(
        text,
        "| mean | | | | {:.1} % | | | | | | {:.2} | {:.2} | |",
        100.0 * mean(&|row| row.tally.share_without_solve()),
        mean(&|row| row.near / row.decide),
        mean(&|row| row.near / row.exact)
    );
    text += "\nAnswers by rung, and states that were solved of all that a kind of step led to:\n\n| walk |";
    for rung in Rung::ALL {
        let _ = write!(text, " {rung:?} |");
    }
    for step in STEPS {
        let _ = write!(text, " {step:?} |");
    }
    text += "\n|";
    text += &" --- |".repeat(1 + Rung::ALL.len() + STEPS.len());
    for row in rows {
        let _ = write!(text, "\n| {} |", row.name);
        for rung in Rung::ALL {
            let _ = write!(text, " {} |", row.tally.of(rung));
        }
        for (_, [without, with]) in &row.steps {
            let _ = write!(text, " {with} of {} |", without + with);
        }
    }
    text + "\n"
}

fn table(rows: &[Row]) -> String {
    let mut text = "walk,bodies,links,stable,without_solve,near_ms,bounds_ms,decide_ms,exact_ms".to_owned();
    for rung in Rung::ALL {
        let _ = write!(text, ",{rung:?}");
    }
    for row in rows {
        let Row { name, bodies, links, stable, tally, near, bounds, decide, exact, .. } = row;
        let share = tally.share_without_solve();
        let name = name.replace(',', "");
        let _ = write!(text, "\n{name},{bodies},{links},{stable},{share},{near},{bounds},{decide},{exact}");
        for rung in Rung::ALL {
            let _ = write!(text, ",{}", tally.of(rung));
        }
    }
    text + "\n"
}
