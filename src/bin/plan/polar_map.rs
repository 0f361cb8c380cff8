//! The picture of a motion range: positions in polar coordinates, coloured by margin.
//!
//! Of a port over a ball the azimuth is the direction (0 to the right, counter-clockwise) and the polar angle the
//! distance from the centre; of a joint the position is the direction.

use std::f64::consts::TAU;

use steadfast::reconfigure::linkage::{MotionRange, Stand};
use svg::Document;
use svg::node::element::path::Data;
use svg::node::element::{Circle, Line, Path, Rectangle, Text, Title};

use crate::motion_range::stands;

/// Radius of the map, and what surrounds it, in px.
const RADIUS: f64 = 240.0;
const BORDER: f64 = 60.0;
/// Radius within which a joint's map has no colour, as a share of the whole.
const HUB: f64 = 0.5;

/// Colours of positions that are no place for the robot: something overlaps, or it does not stand.
const OVERLAPS: &str = "#d9d9d9";
const FALLS: &str = "#8c1d18";

/// The picture as SVG.
pub fn picture(range: &MotionRange, is_joint: bool) -> String {
    let largest = range.stands.iter().filter(|s| stands(s)).map(|s| s.margin.lower).fold(0.0, f64::max);
    let half = range.step_degrees / 2.0;
    let width = 2.0 * (RADIUS + BORDER) + 140.0;
    let height = 2.0 * (RADIUS + BORDER);
    let mut document = Document::new()
        .set("viewBox", (-(RADIUS + BORDER), -(RADIUS + BORDER), width, height))
        .set("width", width)
        .set("height", height)
        .set("font-family", "sans-serif")
        .set("font-size", 12);
    for stand in &range.stands {
        let [direction, polar] = stand.at;
        let is_pole = !is_joint && (polar == 0.0 || polar == 180.0);
        let (from, to) = if is_pole { (0.0, 360.0) } else { (direction - half, direction + half) };
        let (inner, outer) = if is_joint {
            (HUB * RADIUS, RADIUS)
        } else {
            let radius = |polar: f64| polar.clamp(0.0, 180.0) / 180.0 * RADIUS;
            (radius(polar - half), radius(polar + half))
        };
        let cell = Path::new()
            .set("d", sector(from, to, inner, outer))
            .set("fill", colour(stand, largest))
            .set("stroke", "#ffffff")
            .set("stroke-width", 0.5)
            .add(Title::new(described(stand, is_joint)));
        document = document.add(cell);
    }
    document = document.add(mark(range.present, is_joint));
    for quarter in 0..4 {
        let degrees = f64::from(quarter) * 90.0;
        let [x, y] = at(degrees, RADIUS + 20.0);
        document = document.add(label(x, y + 4.0, &format!("{degrees}°")).set("text-anchor", "middle"));
    }
    if !is_joint {
        for polar in [45.0, 90.0, 135.0] {
            let radius = polar / 180.0 * RADIUS;
            let ring = Circle::new().set("r", radius).set("fill", "none").set("stroke", "#000000");
            document = document.add(ring.set("stroke-opacity", 0.35).set("stroke-width", 0.7));
            document = document.add(label(3.0, -radius - 2.0, &format!("polar {polar}°")).set("font-size", 10));
        }
    }
    legend(document, largest).to_string()
}

/// Where a direction in degrees and a radius are on the page.
fn at(degrees: f64, radius: f64) -> [f64; 2] {
    let angle = degrees / 360.0 * TAU;
    [radius * angle.cos(), -radius * angle.sin()]
}

/// Part of a ring, in pieces short enough to draw a whole one.
fn sector(from: f64, to: f64, inner: f64, outer: f64) -> Data {
    let pieces = ((to - from) / 120.0).ceil().max(1.0) as usize;
    let along = |i: usize| from + (to - from) * i as f64 / pieces as f64;
    let point = |degrees: f64, radius: f64| {
        let [x, y] = at(degrees, radius);
        (x, y)
    };
    let mut data = Data::new().move_to(point(from, outer));
    for i in 1..=pieces {
        let (x, y) = point(along(i), outer);
        data = data.elliptical_arc_to((outer, outer, 0, 0, 0, x, y));
    }
    data = data.line_to(point(to, inner));
    for i in (0..pieces).rev() {
        let (x, y) = point(along(i), inner);
        data = data.elliptical_arc_to((inner.max(1e-3), inner.max(1e-3), 0, 0, 1, x, y));
    }
    data.close()
}

/// From dark (no margin) over green to bright yellow (the largest).
fn colour(stand: &Stand, largest: f64) -> String {
    if stand.overlaps {
        return OVERLAPS.to_string();
    }
    if !stands(stand) {
        return FALLS.to_string();
    }
    shade(if largest > 0.0 { (stand.margin.lower / largest).clamp(0.0, 1.0) } else { 1.0 })
}

fn shade(share: f64) -> String {
    const STOPS: [[f64; 3]; 4] = [[68.0, 1.0, 84.0], [49.0, 104.0, 142.0], [53.0, 183.0, 121.0], [253.0, 231.0, 37.0]];
    let along = share * (STOPS.len() - 1) as f64;
    let below = (along.floor() as usize).min(STOPS.len() - 2);
    let part = along - below as f64;
    let mix = |i: usize| (STOPS[below][i] + (STOPS[below + 1][i] - STOPS[below][i]) * part).round();
    format!("rgb({},{},{})", mix(0), mix(1), mix(2))
}

fn described(stand: &Stand, is_joint: bool) -> String {
    let place = if is_joint {
        format!("{}°", stand.at[0])
    } else {
        format!("azimuth {}°, polar {}°", stand.at[0], stand.at[1])
    };
    match () {
        () if stand.overlaps => format!("{place}: overlaps"),
        () if stands(stand) => format!("{place}: margin {:.4}", stand.margin.lower),
        () => format!("{place}: does not stand"),
    }
}

/// A cross where the robot is now.
fn mark([direction, polar]: [f64; 2], is_joint: bool) -> svg::node::element::Group {
    let radius = if is_joint { (1.0 + HUB) / 2.0 * RADIUS } else { polar / 180.0 * RADIUS };
    let [x, y] = at(direction, radius);
    let line = |sign: f64| {
        Line::new()
            .set("x1", x - 5.0)
            .set("y1", y - 5.0 * sign)
            .set("x2", x + 5.0)
            .set("y2", y + 5.0 * sign)
            .set("stroke", "#000000")
            .set("stroke-width", 2)
    };
    svg::node::element::Group::new().add(line(1.0)).add(line(-1.0)).add(Title::new("where it is now"))
}

fn label(x: f64, y: f64, text: &str) -> Text {
    Text::new(text).set("x", x).set("y", y)
}

fn legend(mut document: Document, largest: f64) -> Document {
    let x = RADIUS + BORDER;
    let row = |index: usize| -RADIUS + 22.0 * index as f64;
    let rows: [(String, String); 6] = [
        (shade(1.0), format!("margin {largest:.3}")),
        (shade(0.5), format!("margin {:.3}", largest / 2.0)),
        (shade(0.0), "margin 0".to_string()),
        (FALLS.to_string(), "does not stand".to_string()),
        (OVERLAPS.to_string(), "overlaps".to_string()),
        (String::new(), "× where it is now".to_string()),
    ];
    for (index, (fill, text)) in rows.into_iter().enumerate() {
        if !fill.is_empty() {
            let square = Rectangle::new().set("x", x).set("y", row(index)).set("width", 14).set("height", 14);
            document = document.add(square.set("fill", fill));
        }
        document = document.add(label(x + 20.0, row(index) + 11.0, &text));
    }
    document
}
