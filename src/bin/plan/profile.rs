//! A plan's margins over time, as a table and as a picture.

use std::fmt::Write;
use std::path::Path;

use steadfast::reconfigure::{Moment, Plan};
use svg::Document;
use svg::node::element::path::Data;
use svg::node::element::{Circle, Line, Path as Curve, Text, Title};

/// Width of one action, height of the picture, and what surrounds it, in px.
const STEP: f64 = 60.0;
const HEIGHT: f64 = 240.0;
const BORDER: f64 = 50.0;

/// What is written to a file of this name; `actions` say in a few words what is done.
pub fn text<A, C>(file: &Path, plan: &Plan<A, C>, actions: &[String]) -> String {
    match file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg")) {
        true => picture(plan, actions),
        false => table(plan, actions),
    }
}

fn table<A, C>(plan: &Plan<A, C>, actions: &[String]) -> String {
    let mut text = "action,what,phase,margin_lower,margin_upper\n".to_string();
    for Moment { action, phase, margin } in &plan.profile {
        let (number, what) = match action {
            Some(action) => ((action + 1).to_string(), actions.get(*action).map_or("", String::as_str)),
            None => (String::new(), "start"),
        };
        // An action in words holds commas.
        let _ = writeln!(text, "{number},\"{what}\",{phase},{},{}", margin.lower, margin.upper);
    }
    text
}

/// Margin over actions: each is as wide as the next, whatever it takes.
fn picture<A, C>(plan: &Plan<A, C>, actions: &[String]) -> String {
    let finite = plan.profile.iter().map(|moment| moment.margin.lower).filter(|margin| margin.is_finite());
    let lowest = finite.fold(0.0, f64::min);
    let width = STEP * actions.len().max(1) as f64;
    let height = |margin: f64| HEIGHT * (1.0 - (margin.max(lowest) - lowest) / (1.0 - lowest));
    let across = |moment: &Moment| STEP * moment.action.map_or(0.0, |action| action as f64 + moment.phase);
    let mut document = Document::new()
        .set("viewBox", (-BORDER, -BORDER / 2.0, width + 2.0 * BORDER, HEIGHT + BORDER))
        .set("width", width + 2.0 * BORDER)
        .set("height", HEIGHT + BORDER)
        .set("font-family", "sans-serif")
        .set("font-size", 11);
    for margin in [lowest, 0.0, 0.25, 0.5, 0.75, 1.0] {
        let y = height(margin);
        let line = Line::new().set("x1", 0).set("x2", width).set("y1", y).set("y2", y);
        let colour = if margin == 0.0 { "#8c1d18" } else { "#d9d9d9" };
        document = document.add(line.set("stroke", colour));
        let label = Text::new(format!("{margin:.2}")).set("x", -8).set("y", y + 4.0).set("text-anchor", "end");
        document = document.add(label);
    }
    for (index, what) in actions.iter().enumerate() {
        let x = STEP * index as f64;
        let tick = Line::new().set("x1", x).set("x2", x).set("y1", 0).set("y2", HEIGHT).set("stroke", "#eeeeee");
        let label = Text::new((index + 1).to_string()).set("x", x + STEP / 2.0).set("y", HEIGHT + 16.0);
        document = document.add(tick).add(label.set("text-anchor", "middle").add(Title::new(what.clone())));
    }
    let mut curve = Data::new();
    for (index, moment) in plan.profile.iter().enumerate() {
        let at = (across(moment), height(moment.margin.lower));
        curve = if index == 0 { curve.move_to(at) } else { curve.line_to(at) };
    }
    let curve = Curve::new().set("d", curve).set("fill", "none").set("stroke", "#1f5fa8").set("stroke-width", 1.5);
    document = document.add(curve);
    let worst = plan.profile.iter().min_by(|a, b| a.margin.lower.total_cmp(&b.margin.lower));
    if let Some(worst) = worst {
        let (x, y) = (across(worst), height(worst.margin.lower));
        let title = Title::new(format!("bottleneck: margin {:.4}", worst.margin.lower));
        let mark = Circle::new().set("cx", x).set("cy", y).set("r", 4).set("fill", "#8c1d18");
        document = document.add(mark.add(title));
    }
    document.to_string()
}
