//! `plan parallel PLAN`: which actions of a plan may run at the same time.

use std::fmt::{Display, Write as _};
use std::io;
use std::time::Instant;

use petgraph::visit::EdgeRef;
use steadfast::io::{PartialOrderReport, Verifiable, read_verifiable};
use steadfast::reconfigure::partial_order::{OrderError, OrderOptions, PartialOrder, Timetable};

use crate::arguments::ParallelArguments;
use crate::exit::Exit;
use crate::family::{DocumentOf, Family, OrderOf, PlanOf};
use crate::{files, gantt, output};

/// Width of the bars of the chart for people, in characters.
const BARS: usize = 32;

/// Finds the partial order of a file's best plan and reports it.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &ParallelArguments) -> io::Result<Exit> {
    let file = files::read(&arguments.file);
    let refused = |reason: &str| output::refused(&file.name, [reason.to_string()], arguments.json);
    match read_verifiable(&file) {
        Ok(Verifiable::Plan(document)) => answer(&document, arguments, &refused),
        Ok(Verifiable::LinkagePlan(document)) => answer(&document, arguments, &refused),
        Ok(Verifiable::Certificate(_)) => refused("this is a certificate, not a plan"),
        Err(diagnostics) => output::bad_input(&diagnostics, arguments.json),
    }
}

/// Reports the partial order of a document's best plan.
fn answer<P: Family>(
    document: &DocumentOf<P>,
    arguments: &ParallelArguments,
    refused: &dyn Fn(&str) -> io::Result<Exit>,
) -> io::Result<Exit> {
    let Some(plan) = &document.report.plan else { return refused("the file has no plan") };
    let required = document.report.required.unwrap_or(document.problem.required());
    let options = OrderOptions {
        required: arguments.min_margin.unwrap_or(required),
        most_at_once: arguments.most as usize,
        deadline: arguments.time_limit.and_then(|limit| Instant::now().checked_add(limit)),
        ..OrderOptions::default()
    };
    let order = match document.problem.partial_order(plan, &options) {
        Ok(order) => order,
        Err(broken @ OrderError::Broken { .. }) => {
            output::message(&format!("NOT VERIFIED: {broken}"))?;
            return Ok(Exit::No);
        }
        Err(OrderError::Refused(refusal)) => return refused(&refusal.to_string()),
    };
    let times = order.timetable(|action| match P::is_move(&plan.actions[action].action) {
        true => arguments.move_time,
        false => arguments.latch_time,
    });
    let label = |action: usize| document.problem.action(&plan.actions[action].action);
    let saved = |path: &std::path::Path, text: String| std::fs::write(path, text);
    if let Some(path) = &arguments.svg {
        saved(path, gantt::picture(&times, label))?;
    }
    if let Some(path) = &arguments.dot {
        saved(path, dot(&order, label))?;
    }
    let text = match arguments.json {
        true => match P::write_order(document, &PartialOrderReport { options: &options, order: &order, times: &times })
        {
            Ok(text) => text,
            Err(trouble) => {
                output::message(&format!("bug: the order cannot be written: {trouble}"))?;
                return Ok(Exit::Bug);
            }
        },
        false => chart(&document.problem, plan, &order, &times),
    };
    output::result(&text)?;
    Ok(Exit::Yes)
}

/// A row for every action: what it waits for, and when it runs.
fn chart<P: Family>(problem: &P, plan: &PlanOf<P>, order: &OrderOf<P>, times: &Timetable) -> String {
    let mut text = format!(
        "{} actions in {} waves: {:.2} instead of {:.2} one after the other, {:.0} % less\n",
        plan.actions.len(),
        order.waves().len(),
        times.makespan,
        times.one_by_one,
        100.0 * times.saved()
    );
    if !order.is_complete {
        text.push_str("the time was up before all of it was looked at: more may overlap\n");
    }
    let _ = writeln!(
        text,
        "every order and overlap: margin {:.4}; {} states, {} overlaps, {} oracle solves",
        order.margin.lower, order.checked.states, order.checked.overlaps, order.checked.oracle_solves
    );
    for (index, planned) in plan.actions.iter().enumerate() {
        let waits: Vec<String> = order.waits_for(index).iter().map(|before| (before + 1).to_string()).collect();
        let bar = bar(times.spans[index], times.makespan);
        let what = problem.action(&planned.action);
        let row = format!("  {:>3}  {what:<36}  {bar}  {}", index + 1, waits.join(", "));
        let _ = writeln!(text, "{}", row.trim_end());
    }
    text
}

/// A span of time as a bar.
fn bar([begin, end]: [f64; 2], makespan: f64) -> String {
    let at = |time: f64| if makespan > 0.0 { (time / makespan * BARS as f64).round() as usize } else { 0 };
    let (begin, end) = (at(begin).min(BARS - 1), at(end));
    let length = end.saturating_sub(begin).max(1);
    format!("|{}{}{}|", " ".repeat(begin), "#".repeat(length), " ".repeat(BARS - begin - length))
}

/// The graph in the language of Graphviz.
fn dot<T: Display>(order: &PartialOrder<T>, label: impl Fn(usize) -> String) -> String {
    let quoted = |text: String| text.replace('\\', "\\\\").replace('"', "\\\"");
    let mut text = "digraph plan {\n  rankdir=LR;\n  node [shape=box];\n".to_string();
    for action in 0..order.graph.node_count() {
        let _ = writeln!(text, "  {} [label=\"{}. {}\"];", action + 1, action + 1, quoted(label(action)));
    }
    for edge in order.graph.edge_references() {
        let (from, to) = (edge.source().index() + 1, edge.target().index() + 1);
        let _ = writeln!(text, "  {from} -> {to} [tooltip=\"{}\"];", quoted(edge.weight().to_string()));
    }
    text.push_str("}\n");
    text
}
