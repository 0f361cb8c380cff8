//! Which measurements go into which figure.

use crate::growth::{self, Point};
use crate::methods::{Claim, LeftIn, Method};
use crate::plot::{Dot, Figure, Look, Mark, Panel, Series};
use crate::pyramid::Side;
use crate::study::Row;

/// Errors below this, or below the reference's uncertainty, are drawn there.
const FLOOR: f64 = 1e-17;

/// Error against time, a panel per scene of one family.
pub fn error_against_time(family: &str, rows: &[Row]) -> Figure {
    // One reduction alone is a matter for a table.
    let shown = |row: &&Row| !matches!(row.method, Method::Unreduced(left_in, _) if left_in != LeftIn::Everything);
    let own: Vec<&Row> = rows.iter().filter(|row| row.family == family).filter(shown).collect();
    let panels = own.chunk_by(|a, b| a.scene == b.scene).map(|rows| {
        let floor = rows[0].uncertainty.max(FLOOR);
        let mut series: Vec<Series> = Vec::new();
        for row in rows {
            let Some(error) = row.error else { continue };
            let hollow = !matches!(row.answer.claim, Claim::Solved | Claim::Proved);
            let dot = Dot { x: row.milliseconds, y: error.max(floor), hollow };
            match series.iter_mut().find(|series| series.name == row.method.name()) {
                Some(series) => series.dots.push(dot),
                None => {
                    series.push(Series { name: row.method.name().to_owned(), look: look(row.method), dots: vec![dot] });
                }
            }
        }
        Panel {
            title: format!("{}, {} bodies", rows[0].scene, rows[0].bodies),
            series,
            floor: Some((floor, "uncertainty of the reference")),
        }
    });
    Figure {
        title: format!("Error against time: {family}"),
        x: "time, ms",
        y: "error of the utilisation",
        panels: panels.collect(),
        alike: false,
        hollow: Some("hollow: given up,\nnot called solved;\ncarried over: had\nto be solved"),
    }
}

/// Growth of one quantity, a panel per family.
pub fn growth(title: &str, y: &'static str, quantity: fn(&Point) -> f64, points: &[Point]) -> Figure {
    let panels = growth::FAMILIES.iter().map(|family| {
        let series = growth::METHODS.iter().map(|&(name, method)| {
            let own = points.iter().filter(|p| p.family == family.name && p.method == name);
            let dots = own.filter(|point| quantity(point) > 0.0).map(|point| Dot {
                x: point.bodies as f64,
                y: quantity(point),
                hollow: !matches!(point.claim.as_str(), "Solved" | "Proved"),
            });
            Series { name: name.to_owned(), look: look(method), dots: dots.collect() }
        });
        Panel { title: family.name.to_owned(), series: series.collect(), floor: None }
    });
    Figure {
        title: title.to_owned(),
        x: "bodies",
        y,
        panels: panels.collect(),
        alike: true,
        hollow: Some("hollow: given up,\nnot called solved"),
    }
}

/// Colours that the colour-blind can tell apart (Okabe and Ito 2008).
const fn look(method: Method) -> Look {
    let (color, mark) = match method {
        Method::Paper(_) => ((213, 94, 0), Mark::Circle),
        Method::Standard(_) => ((0, 114, 178), Mark::Square),
        Method::Pyramid(Side::Inner, _) => ((230, 159, 0), Mark::Up),
        Method::Pyramid(Side::Outer, _) => ((86, 180, 233), Mark::Down),
        Method::ToGap(_) => ((0, 158, 115), Mark::Circle),
        Method::Unreduced(..) => ((130, 130, 130), Mark::Circle),
        Method::Decide => ((0, 0, 0), Mark::Cross),
        Method::CarriedOver => ((204, 121, 167), Mark::Square),
    };
    Look { color, mark, line: true }
}
