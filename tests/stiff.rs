//! The oracle on stiff and extreme structures whose utilisation is known by
//! hand: one test per member of a family.
//!
//!     cargo test --test stiff                      # what is quick
//!     cargo test --test stiff -- --include-ignored # up to 100 000 modules
//!     cargo test --test stiff -- --nocapture       # and the width of every bracket

#[path = "support/families/mod.rs"]
mod families;
#[path = "support/stiff.rs"]
mod members;
#[path = "support/random.rs"]
mod random;
#[path = "support/recheck.rs"]
mod recheck;

use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use families::{Measures, measured, turned};
use libtest_mimic::{Arguments, Failed, Trial};
use members::{Member, Size};
use random::{Kind, Recipe, structure};
use steadfast::statics::{Assessment, Bracket, Question, Structure, Verdict, assess};

/// Relative rounding of a formula worked out in a few dozen operations, or
/// summed over 100 000 modules.
const FORMULA: f64 = 1e-11;

/// Relative width that users are promised.
const WIDTH: f64 = 1e-6;

/// Distance of t from 1 within which the verdict may be left open.
const CLOSE: f64 = 1e-9;

/// Random structures that the laws are tried on.
const LAWFUL: u64 = 80;

fn main() {
    let arguments = Arguments::from_args();
    let rows = Arc::new(Mutex::new(Vec::new()));
    let trials = members::all().into_iter().map(|member| {
        let (rows, ignored) = (Arc::clone(&rows), member.size == Size::Large);
        let name = format!("{} {}", member.family, member.name);
        Trial::test(name, move || check(&member, &rows)).with_ignored_flag(ignored)
    });
    let trials = trials.chain((0..LAWFUL).map(|seed| {
        let recipe = Recipe { kind: Kind::ALL[seed as usize % Kind::ALL.len()], bodies: 1 + seed as usize % 15, seed };
        Trial::test(format!("random {:?} {seed}", recipe.kind), move || obeys(&recipe))
    }));
    let conclusion = libtest_mimic::run(&arguments, trials.collect());
    if arguments.nocapture {
        let rows = rows.lock().expect("no test panics while it holds the lock");
        std::io::stdout().write_all(report(&rows).as_bytes()).expect("the report can be written");
    }
    conclusion.exit();
}

/// What came of one member.
struct Row {
    family: &'static str,
    name: String,
    bodies: usize,
    truth: f64,
    answer: Assessment,
    time: Duration,
    fault: Option<String>,
}

fn check(member: &Member, rows: &Mutex<Vec<Row>>) -> Result<(), Failed> {
    let (structure, truth) = (member.make)();
    let started = Instant::now();
    let answer = assess(&structure, Question::VALUE).map_err(|problems| format!("{problems:?}"))?;
    let time = started.elapsed();
    let fault = recheck::recheck(&structure, &answer).and_then(|()| judge(&answer, truth, member.narrow)).err();
    let result = fault.clone().map_or(Ok(()), |fault| Err(Failed::from(fault)));
    let (family, name, bodies) = (member.family, member.name.clone(), structure.bodies.len());
    rows.lock().expect("no test panics while it holds the lock").push(Row {
        family,
        name,
        bodies,
        truth,
        answer,
        time,
        fault,
    });
    result
}

/// The verdict is right or open where it may be, the bracket holds the truth and
/// is as narrow as promised.
fn judge(answer: &Assessment, truth: f64, narrow: bool) -> Result<(), String> {
    let Bracket { lower, upper } = answer.utilisation;
    let right = match answer.verdict {
        Verdict::Stable => truth <= 1.0 + FORMULA,
        Verdict::InternallyUnstable => truth.is_finite() && truth >= 1.0 - FORMULA,
        Verdict::WholeBodyUnstable => truth.is_infinite(),
        Verdict::Undecided => true,
    };
    let found = format!("{:?} [{lower:e}, {upper:e}], truth {truth:e}", answer.verdict);
    if !right {
        return Err(format!("wrong: {found}"));
    }
    if truth.is_finite() {
        let room = FORMULA * truth;
        if !(lower <= truth + room && truth - room <= upper) {
            return Err(format!("outside the bracket: {found}"));
        }
    }
    if answer.verdict == Verdict::Undecided {
        let why = answer.undecided_because.as_deref().ok_or_else(|| format!("undecided without a reason: {found}"))?;
        if !((truth - 1.0).abs() <= CLOSE) {
            return Err(format!("undecided: {found}; {why}"));
        }
    }
    if narrow && truth.is_finite() && !(upper - lower <= WIDTH * truth.max(1.0)) {
        return Err(format!("{:e} wide: {found}", upper - lower));
    }
    Ok(())
}

/// What no hand can work out still obeys the laws: other measures scale it and a
/// turn leaves it alone. Each answer is proved by its fields besides.
fn obeys(recipe: &Recipe) -> Result<(), Failed> {
    let one = structure(recipe);
    let bracket = |structure: &Structure| -> Result<Bracket, Failed> {
        let answer = assess(structure, Question::VALUE).map_err(|problems| format!("{problems:?}"))?;
        recheck::recheck(structure, &answer)?;
        Ok(answer.utilisation)
    };
    let before = bracket(&one)?;
    for measures in [[1e-3, 1e-9, 1e-9], [1e3, 1e6, 1e6], [1.0, 1e3, 1.0]] {
        let [length, mass, strength] = measures;
        let (other, factor) = measured((one.clone(), 1.0), &Measures { length, mass, strength });
        let after = bracket(&turned((other, factor), recipe.seed).0)?;
        let room = |t: f64| 1e-8 * (t * factor).max(1.0);
        let apart = before.lower * factor - room(before.lower) > after.upper
            || after.lower > before.upper * factor + room(before.upper);
        if apart {
            return Err(format!("{before:?}, but {after:?} where it is {factor} times as much").into());
        }
    }
    Ok(())
}

/// Every member with its bracket's relative width, in the families' order.
fn report(rows: &[Row]) -> String {
    let mut text = format!(
        "{:<14} {:<34} {:>7} {:>12} {:>12} {:>8} {:>10}  fault\n",
        "family", "member", "bodies", "truth", "upper", "width", "ms"
    );
    for member in members::all() {
        let Some(row) = rows.iter().find(|row| (row.family, &row.name) == (member.family, &member.name)) else {
            continue;
        };
        let (upper, width) = (row.answer.utilisation.upper, row.answer.utilisation.width() / row.truth.max(1.0));
        let (bodies, milliseconds) = (row.bodies, row.time.as_secs_f64() * 1e3);
        let width = if row.truth.is_finite() { width } else { 0.0 };
        let _ = writeln!(
            text,
            "{:<14} {:<34} {bodies:>7} {:>12.5e} {upper:>12.5e} {width:>8.1e} {milliseconds:>10.2}  {}",
            row.family,
            row.name,
            row.truth,
            row.fault.as_deref().unwrap_or("")
        );
    }
    text
}
