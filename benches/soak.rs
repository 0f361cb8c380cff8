//! Random structures of every kind, each answer judged three ways: by the
//! paper's formulation in a general solver, by the independent re-check of the
//! fields, and by the other question (value or verdict alone) to the oracle. Where one
//! of the first two finds fault, a certificate of the answer is issued and checked; where
//! there is none and the values differ, the solver is asked again with twice the
//! digits. Only what neither settles counts as wrong.
//!
//!     cargo bench --bench soak                     # 100 000 structures
//!     cargo bench --bench soak -- 2000 --seed 7    # fewer, others
//!     cargo bench --bench soak -- 1 --kind Masses --bodies 12 --seed 99
//!
//! What was found so far is written to `benches/record/soak.csv` and `soak.md`
//! after every thousand, so that a run that is stopped has not been in vain. Ends
//! with an error where an answer was wrong.

#[path = "support/cone_program.rs"]
#[expect(dead_code, reason = "solved in double-double arithmetic only")]
mod cone_program;
#[path = "error_against_time/double_double.rs"]
mod double_double;
#[path = "../tests/support/paper.rs"]
mod paper;
#[path = "../tests/support/random.rs"]
mod random;
#[path = "../tests/support/recheck.rs"]
mod recheck;
#[path = "error_against_time/reference.rs"]
#[expect(dead_code, reason = "nothing here has a closed form")]
mod reference;
#[path = "soak/second.rs"]
mod second;
#[path = "support/standard.rs"]
mod standard;
#[path = "soak/tally.rs"]
mod tally;

use std::io::Write as _;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use random::{Kind, Random, Recipe, structure};
use rayon::prelude::*;
use second::Opinion;
use steadfast::certificate;
use steadfast::statics::{Assessment, Bracket, Question, Structure, Verdict, assess};
use tally::{Record, Tally};

/// Most bodies of a structure.
const LARGEST: usize = 40;

/// Structures between two writings of the record.
const CHUNK: usize = 1000;

/// Relative width that users are promised.
const WIDTH: f64 = 1e-6;

/// Distance of t from 1 within which the verdict may be left open.
const CLOSE: f64 = 1e-3;

/// What came of one structure.
pub struct Outcome {
    recipe: Recipe,
    verdict: Verdict,
    time: Duration,
    /// An answer that cannot be right, in words.
    wrong: Option<String>,
    /// The fields do not prove what the answer says.
    unproved: Option<String>,
    /// What the second method or the re-check had against the answer before a
    /// certificate of it was issued and found right, or twice the digits confirmed it.
    settled: Option<String>,
    /// The second method is sure of nothing.
    silent: bool,
    undecided: bool,
    wide: bool,
    agrees: bool,
}

fn main() -> ExitCode {
    let options = match Options::new(std::env::args().skip(1)) {
        Ok(options) => options,
        Err(problem) => {
            let _ = writeln!(std::io::stderr(), "{problem}");
            return ExitCode::FAILURE;
        }
    };
    let recipes = options.recipes();
    let mut tally = Tally::new(options.seed);
    let started = Instant::now();
    for chunk in recipes.chunks(CHUNK) {
        let outcomes: Vec<Outcome> = chunk.par_iter().map(examine).collect();
        for outcome in &outcomes {
            tally.add(outcome);
        }
        let (done, seconds) = (tally.total(), started.elapsed().as_secs_f64());
        let _ = writeln!(std::io::stderr(), "{done} of {} after {seconds:.0} s: {}", recipes.len(), tally.summary());
        if options.record {
            Record::new(&tally, started.elapsed()).write().expect("the record can be written");
        }
    }
    let record = Record::new(&tally, started.elapsed());
    std::io::stdout().write_all(record.page().as_bytes()).expect("the report can be written");
    if tally.right() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// What is asked on the command line.
struct Options {
    count: usize,
    seed: u64,
    kind: Option<Kind>,
    bodies: Option<usize>,
    record: bool,
}

impl Options {
    fn new(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self { count: 100_000, seed: 1, kind: None, bodies: None, record: true };
        while let Some(argument) = arguments.next() {
            let number = |text: Option<String>| -> Result<u64, String> {
                text.and_then(|text| text.parse().ok()).ok_or_else(|| format!("{argument}: not a number"))
            };
            match argument.as_str() {
                "--bench" => {}
                // `cargo test --benches` only wants to see that it starts.
                "--test" => (options.count, options.record) = (2 * Kind::ALL.len(), false),
                "--seed" => options.seed = number(arguments.next())?,
                "--bodies" => options.bodies = Some(number(arguments.next())? as usize),
                "--kind" => {
                    let name = arguments.next().unwrap_or_default();
                    let kind = Kind::ALL.into_iter().find(|kind| format!("{kind:?}") == name);
                    options.kind = Some(kind.ok_or_else(|| format!("no kind is called {name:?}"))?);
                }
                count => options.count = number(Some(count.to_owned()))? as usize,
            }
        }
        options.record &= options.kind.is_none() && options.bodies.is_none();
        Ok(options)
    }

    /// Every kind in turn, of any size. A single one has the very seed that was given.
    fn recipes(&self) -> Vec<Recipe> {
        let mut random = Random::new(self.seed);
        let recipe = |i: usize| {
            let kind = self.kind.unwrap_or(Kind::ALL[i % Kind::ALL.len()]);
            let (bodies, seed) = (1 + random.below(LARGEST), random.below(1 << 40) as u64);
            let seed = if self.count == 1 { self.seed } else { seed };
            Recipe { kind, bodies: self.bodies.unwrap_or(bodies), seed }
        };
        (0..self.count).map(recipe).collect()
    }
}

fn examine(recipe: &Recipe) -> Outcome {
    let structure = structure(recipe);
    let started = Instant::now();
    let answer = assess(&structure, Question::VALUE).expect("the generator makes valid structures");
    let time = started.elapsed();
    let Bracket { lower, upper } = answer.utilisation;
    let near_one = lower >= 1.0 - CLOSE && upper <= 1.0 + CLOSE;
    let opinion = second::opinion(&structure, &answer);
    let mut wrong = contradiction(&structure, &answer);
    let mut differs = opinion.contradiction(&answer);
    let mut unproved = recheck::recheck(&structure, &answer).err();
    let agrees = opinion != Opinion::None && wrong.is_none() && differs.is_none();
    let mut settled = None;
    if (differs.is_some() || unproved.is_some()) && is_certified(&structure, &answer) {
        settled = differs.take().or(unproved.take());
        unproved = None;
    }
    if differs.is_some() && second::twice_the_digits_agree(&structure, &answer, WIDTH) {
        settled = settled.or(differs.take());
    }
    wrong = wrong.or(differs);
    Outcome {
        recipe: *recipe,
        verdict: answer.verdict,
        time,
        agrees,
        wrong,
        unproved,
        settled,
        silent: opinion == Opinion::None,
        undecided: answer.verdict == Verdict::Undecided && !near_one,
        wide: upper.is_finite() && !(upper - lower <= WIDTH * upper.max(1.0))
            || upper.is_infinite() && lower.is_finite(),
    }
}

/// Whether a certificate of the answer can be issued that the checker, which shares no
/// code with the solver, finds right: with the verdict and, up to what users are
/// promised, the bracket of the answer.
fn is_certified(structure: &Structure, answer: &Assessment) -> bool {
    let Ok(certificate) = certificate::issue(structure, answer) else { return false };
    let Ok(proof) = certificate::check(&certificate) else { return false };
    let (proved, stated) = (proof.utilisation, answer.utilisation);
    let room = |t: f64| WIDTH * t.max(1.0);
    certificate.verdict == answer.verdict
        && (proved.lower == stated.lower || proved.lower >= stated.lower - room(stated.lower))
        && (proved.upper == stated.upper || proved.upper <= stated.upper + room(stated.upper))
}

/// How the answer to a yes-or-no question contradicts the answer for the value.
fn contradiction(structure: &Structure, answer: &Assessment) -> Option<String> {
    let decided = assess(structure, Question::Decide(1.0)).expect("the generator makes valid structures");
    let unstable = |verdict| matches!(verdict, Verdict::InternallyUnstable | Verdict::WholeBodyUnstable);
    let apart = decided.verdict == Verdict::Stable && unstable(answer.verdict)
        || unstable(decided.verdict) && answer.verdict == Verdict::Stable
        || decided.utilisation.lower > answer.utilisation.upper * (1.0 + WIDTH) + WIDTH;
    apart.then(|| {
        let (a, b) = (answer.utilisation, decided.utilisation);
        format!("{:?} {a:?} for the value, {:?} {b:?} for the verdict", answer.verdict, decided.verdict)
    })
}
