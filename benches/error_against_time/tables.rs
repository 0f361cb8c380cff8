//! The measurements in a few tables, as Markdown.

use std::fmt::Write as _;

use crate::growth::{self, FAMILIES, Point, exponent};
use crate::methods::{Claim, LeftIn, Method};
use crate::study::Row;

/// The error that "exact" means in the first table.
const EXACT: f64 = 1e-6;

/// Time until the error is at most 1e-6, by scene: the fastest setting of each
/// method that gets there, chosen with hindsight.
pub fn exact(rows: &[Row]) -> String {
    let mut text = "| scene | bodies | paper ms | standard ms | ours ms | verdict only ms | carried over ms | paper / ours | standard / ours | paper / verdict |\n\
                    | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n"
        .to_owned();
    for rows in rows.chunk_by(|a, b| a.scene == b.scene) {
        let fastest = |wanted: fn(Method) -> bool| {
            let there = rows.iter().filter(|row| wanted(row.method) && row.error.is_some_and(|error| error <= EXACT));
            there.map(|row| row.milliseconds).min_by(f64::total_cmp)
        };
        let paper = fastest(|method| matches!(method, Method::Paper(_)));
        let standard = fastest(|method| matches!(method, Method::Standard(_)));
        let ours = fastest(|method| matches!(method, Method::ToGap(_)));
        let verdict = rows.iter().find(|row| row.method == Method::Decide && row.answer.upper <= 1.0 + 1e-12);
        let verdict = verdict.map(|row| row.milliseconds);
        let carried = rows.iter().find(|row| row.method == Method::CarriedOver).map_or_else(
            || "-".to_owned(),
            |row| {
                let time = figures(row.milliseconds);
                if row.answer.claim == Claim::Proved { time } else { format!("({time})") }
            },
        );
        let ratio = |slow: Option<f64>, fast: Option<f64>| {
            slow.zip(fast).map_or_else(|| "-".to_owned(), |(slow, fast)| figures(slow / fast))
        };
        let time = |time: Option<f64>| time.map_or_else(|| "-".to_owned(), figures);
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {carried} | {} | {} | {} |",
            rows[0].scene,
            rows[0].bodies,
            time(paper),
            time(standard),
            time(ours),
            time(verdict),
            ratio(paper, ours),
            ratio(standard, ours),
            ratio(paper, verdict)
        );
    }
    text
}

/// What every reduction saves at a gap of 1e-6, on the scenes that have something to leave out.
pub fn reductions(rows: &[Row]) -> String {
    let names = ["rigid links", "blocks", "closed form", "chains", "planes", "any"];
    let mut text = "| scene | bodies | ours ms |".to_owned();
    for name in names {
        let _ = write!(text, " without {name} ms |");
    }
    text += "\n| --- | ---: | ---: |";
    text += &" ---: |".repeat(names.len());
    text += "\n";
    for rows in rows.chunk_by(|a, b| a.scene == b.scene) {
        let time = |method: Method| rows.iter().find(|row| row.method == method).map(|row| row.milliseconds);
        let Some(all) = time(Method::ToGap(EXACT)) else { continue };
        let without = LeftIn::ALL.map(|left_in| time(Method::Unreduced(left_in, EXACT)));
        if without.iter().all(Option::is_none) {
            continue;
        }
        let _ = write!(text, "| {} | {} | {} |", rows[0].scene, rows[0].bodies, figures(all));
        for time in without {
            let cell = time.map_or_else(|| "-".to_owned(), |time| format!("{} ({:.1})", figures(time), time / all));
            let _ = write!(text, " {cell} |");
        }
        text += "\n";
    }
    text
}

/// How far each method's answers can be trusted, over all scenes.
pub fn trust(rows: &[Row]) -> String {
    let mut text = "| method | setting | called solved or proved | median error of these | largest error of these | in | given up, or wider than asked | infeasible, or wrong side |\n\
                    | --- | ---: | ---: | ---: | ---: | --- | ---: | ---: |\n"
        .to_owned();
    for method in Method::all().into_iter().filter(|method| !matches!(method, Method::Decide | Method::CarriedOver)) {
        let of_method: Vec<&Row> = rows.iter().filter(|row| row.method == method).collect();
        let count = |wanted: &[Claim]| of_method.iter().filter(|row| wanted.contains(&row.answer.claim)).count();
        let wider = of_method.iter().filter(|row| wider_than_asked(row)).count();
        let sure = of_method.iter().filter(|row| matches!(row.answer.claim, Claim::Solved | Claim::Proved));
        let mut errors: Vec<(f64, &str)> =
            sure.map(|row| (row.error.unwrap_or(f64::INFINITY), row.scene.as_str())).collect();
        errors.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((largest, scene)) = errors.last() else { continue };
        let parameter = method.parameter();
        let parameter = if parameter >= 1.0 { format!("{parameter} sides") } else { format!("{parameter:e}") };
        let _ = writeln!(
            text,
            "| {} | {parameter} | {} of {} | {:.0e} | {largest:.0e} | {scene} | {} | {} |",
            method.name(),
            errors.len(),
            of_method.len(),
            errors[errors.len() / 2].0,
            count(&[Claim::Stopped, Claim::Nothing]) + wider,
            count(&[Claim::Infeasible, Claim::Misplaced])
        );
    }
    text
}

/// Whether a proved bracket is wider than was asked for.
fn wider_than_asked(row: &Row) -> bool {
    let (Method::ToGap(gap) | Method::Unreduced(_, gap)) = row.method else { return false };
    row.answer.upper - row.answer.lower > gap * row.answer.upper.max(1.0)
}

/// Exponents of time and memory, and the largest structure that each method got to.
pub fn growth(points: &[Point]) -> String {
    let mut text = "| family | method | largest, bodies | its time | its memory added, MiB | exponent of time | exponent of memory | promised |\n\
                    | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |\n"
        .to_owned();
    for family in &FAMILIES {
        for (name, method) in growth::METHODS {
            let own: Vec<&Point> = points.iter().filter(|p| p.family == family.name && p.method == name).collect();
            let Some(last) = own.last() else { continue };
            let fit = |part: fn(&Point) -> f64| {
                let points: Vec<(f64, f64)> = own.iter().map(|point| (point.bodies as f64, part(point))).collect();
                // What fits into the process's spare pages does not show.
                let shown: Vec<(f64, f64)> = points.into_iter().filter(|point| point.1 > 0.0).collect();
                exponent(&shown).map_or_else(|| "-".to_owned(), |slope| format!("{slope:.2}"))
            };
            let promised = match (method, family.promised) {
                (Method::ToGap(_) | Method::Decide, Some(promised)) => format!("{promised}"),
                _ => String::new(),
            };
            let _ = writeln!(
                text,
                "| {} | {name} | {} | {} | {} | {} | {} | {promised} |",
                family.name,
                last.bodies,
                duration(last.milliseconds),
                figures(last.added),
                fit(|point| point.milliseconds),
                fit(|point| point.added)
            );
        }
    }
    text
}

/// How wrong each method is on chains and trees, where the truth is known exactly.
pub fn long(points: &[Point]) -> String {
    let mut text = "| family | bodies | ours | standard | paper |\n| --- | ---: | ---: | ---: | ---: |\n".to_owned();
    let known: Vec<&Point> = points.iter().filter(|point| point.error.is_some()).collect();
    let mut sizes: Vec<(&str, usize)> = known.iter().map(|point| (point.family, point.bodies)).collect();
    sizes.sort_unstable();
    sizes.dedup();
    for (family, bodies) in sizes {
        let cell = |method: &str| {
            let point = known.iter().find(|p| (p.family, p.bodies) == (family, bodies) && p.method == method);
            point.map_or_else(
                || "past the limit".to_owned(),
                |point| match (point.claim.as_str(), point.error) {
                    ("Solved" | "Proved", Some(error)) => format!("{error:.0e}"),
                    (claim, Some(error)) if error.is_finite() => format!("({error:.0e}, {})", claim.to_lowercase()),
                    (claim, _) => claim.to_lowercase(),
                },
            )
        };
        let _ = writeln!(
            text,
            "| {family} | {bodies} | {} | {} | {} |",
            cell(growth::METHODS[0].0),
            cell("standard"),
            cell("paper")
        );
    }
    text
}

/// Three figures, without an exponent.
fn figures(value: f64) -> String {
    if value >= 100.0 {
        format!("{value:.0}")
    } else if value >= 10.0 {
        format!("{value:.1}")
    } else {
        format!("{value:.2}")
    }
}

fn duration(milliseconds: f64) -> String {
    if milliseconds >= 1000.0 {
        format!("{} s", figures(milliseconds / 1e3))
    } else {
        format!("{} ms", figures(milliseconds))
    }
}
