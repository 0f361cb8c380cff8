//! The picture of a timetable: a bar for every action.

use steadfast::reconfigure::partial_order::Timetable;
use svg::Document;
use svg::node::element::{Rectangle, Text};

/// Height of a row, width of the names and of the bars, in px.
const ROW: f64 = 20.0;
const NAMES: f64 = 300.0;
const BARS: f64 = 500.0;

/// The picture as SVG; `label` says what an action is.
pub fn picture(times: &Timetable, label: impl Fn(usize) -> String) -> String {
    let (width, height) = (NAMES + BARS + 20.0, ROW * (times.spans.len() as f64 + 1.0));
    let scale = if times.makespan > 0.0 { BARS / times.makespan } else { 0.0 };
    let mut document = Document::new()
        .set("viewBox", (0, 0, width, height))
        .set("width", width)
        .set("height", height)
        .set("font-family", "sans-serif")
        .set("font-size", 12);
    for (action, [begin, end]) in times.spans.iter().enumerate() {
        let y = ROW * (action as f64 + 0.5);
        let name = format!("{}  {}", action + 1, label(action));
        let bar = Rectangle::new()
            .set("x", NAMES + begin * scale)
            .set("y", y + 3.0)
            .set("width", ((end - begin) * scale).max(1.0))
            .set("height", ROW - 6.0)
            .set("fill", "#1f6f8b");
        document = document.add(Text::new(name).set("x", 8).set("y", y + ROW - 6.0)).add(bar);
    }
    document.to_string()
}
