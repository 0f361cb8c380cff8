//! A search's report for people.

use std::fmt::Write;

use steadfast::reconfigure::replay::Replay;
use steadfast::reconfigure::{InTheWay, Limit, Nearest, Objective, Outcome, Plan, Report};
use steadfast::statics::{Bracket, Rung};

use crate::family::{Answer, Family};
use crate::{memory, verify};

/// Width from which on a margin is shown as a bound: below it the digits that are shown are known.
const BOUND: f64 = 1e-4;

/// What was found, what it is worth, what limits it, and what was proved.
pub fn summary<F: Family>(
    problem: &F,
    report: &Answer<F>,
    replay: Option<&Replay<F::Connection, F::Touched>>,
) -> String {
    let mut text = headline(report);
    if let Some(plan) = &report.plan {
        actions(&mut text, problem, plan);
        bottleneck(&mut text, problem, plan);
    }
    for (index, plan) in report.alternatives.iter().enumerate() {
        let _ = match report.objective {
            Objective::Pareto => writeln!(text, "\nwith fewer moves: {}", worth(plan)),
            Objective::Margin | Objective::Moves => writeln!(text, "\nalternative {}: {}", index + 1, worth(plan)),
        };
        actions(&mut text, problem, plan);
    }
    if let Some(limit) = report.alternatives_cut_by.filter(|_| report.plan.is_some()) {
        let _ = writeln!(text, "\nthere may be further plans: the search for them was {}", cut(limit));
    }
    text.push('\n');
    if let Some(found) = &report.in_the_way {
        in_the_way(&mut text, problem, found, report.required.unwrap_or(f64::NEG_INFINITY));
    }
    proved(&mut text, report);
    if let Some(replay) = replay {
        text.push_str(&verified(problem, report, replay));
    }
    let statistics = &report.statistics;
    let _ = writeln!(
        text,
        "{} states expanded, {} margins asked for, {} oracle solves, {:.2} s, {}",
        statistics.expanded,
        statistics.certified,
        statistics.oracle_solves,
        statistics.seconds,
        memory::spelled(statistics.bytes)
    );
    if statistics.decided_by.total() > 0 {
        let of = |rung| statistics.decided_by.of(rung);
        let _ = writeln!(
            text,
            "of the solves {} by balance alone, {} by what a neighbouring state left, {} as soon as bounds told, {} to the end",
            of(Rung::ClosedForm),
            of(Rung::CarriedOver),
            of(Rung::StoppedEarly),
            of(Rung::Solved) + of(Rung::SolvedGenerally)
        );
    }
    text
}

fn headline<A, C>(report: &Report<A, C>) -> String {
    match (&report.outcome, &report.plan) {
        (Outcome::Impossible(reason), _) => format!("NO PLAN EXISTS: {reason}\n"),
        (Outcome::OutOfBudget(limit), None) => format!("NO PLAN FOUND: {}\n", stopped(*limit)),
        (Outcome::OutOfBudget(limit), Some(plan)) => {
            format!("PLAN: {}, the best so far; {}\n", worth(plan), stopped(*limit))
        }
        (Outcome::Solved, Some(plan)) => format!("PLAN: {}\n", worth(plan)),
        (Outcome::Solved, None) => "NO PLAN FOUND\n".to_string(),
    }
}

fn stopped(limit: Limit) -> &'static str {
    match limit {
        Limit::Deadline => "stopped at the time limit",
        Limit::Expansions => "stopped at the limit on expansions",
        Limit::Memory => "stopped at the memory limit",
        Limit::Cancelled => "interrupted",
        Limit::Precision => "some margins are too close to the required one to be decided",
        Limit::Incomplete => "made module by module, without a search of all plans",
    }
}

fn cut(limit: Limit) -> &'static str {
    match limit {
        Limit::Precision => "left undecided by margins too close to the required one",
        other => stopped(other),
    }
}

fn worth<A, C>(plan: &Plan<A, C>) -> String {
    let moves = if plan.moves == 1 { "1 move".to_string() } else { format!("{} moves", plan.moves) };
    let actions =
        if plan.actions.len() == 1 { "1 action".to_string() } else { format!("{} actions", plan.actions.len()) };
    match plan.margin {
        Some(margin) => format!("{moves} ({actions}), margin {:.4}", margin.lower),
        None => format!("{moves} ({actions}), made without regard to stability"),
    }
}

fn actions<F: Family>(text: &mut String, problem: &F, plan: &Plan<F::Action, F::Connection>) {
    let worst = plan.bottleneck.as_ref().and_then(|bottleneck| bottleneck.action);
    for (index, planned) in plan.actions.iter().enumerate() {
        let what = problem.action(&planned.action);
        let margin = planned.margin.map_or_else(String::new, |margin: Bracket| format!("{:.4}", margin.lower));
        let mark = if worst == Some(index) { "  <- bottleneck" } else { "" };
        let row = format!("  {:>3}  {what:<42}  {margin:>8}{mark}", index + 1);
        let _ = writeln!(text, "{}", row.trim_end());
    }
}

fn bottleneck<F: Family>(text: &mut String, problem: &F, plan: &Plan<F::Action, F::Connection>) {
    let Some(bottleneck) = &plan.bottleneck else { return };
    let place = match bottleneck.action {
        None => "the start itself".to_string(),
        Some(index) if bottleneck.phase >= 1.0 => format!("after action {}", index + 1),
        Some(index) => format!("action {} at {:.0} % of the way", index + 1, 100.0 * bottleneck.phase),
    };
    let connection = bottleneck.connection.as_ref();
    let held = connection.map_or_else(String::new, |pair| format!(", {}", problem.held(pair)));
    let _ = writeln!(text, "bottleneck: {place}{held}");
    if let Some(gain) = plan.if_stronger {
        let _ = writeln!(
            text,
            "{} times as strong, it would give the plan a margin of {:.4}",
            gain.factor, gain.margin.lower
        );
    }
}

/// What would have to change for there to be a plan.
fn in_the_way<F: Family>(text: &mut String, problem: &F, found: &InTheWay<F::Action, F::Connection>, required: f64) {
    let Bracket { lower, upper } = found.margin;
    let mut line = |sentence: String| {
        let _ = writeln!(text, "  {sentence}");
    };
    if let Some(Nearest { modules, in_place, stuck }) = found.nearest {
        line(format!("at best {in_place} of {modules} modules were in place"));
        if stuck > 0 {
            line(format!("of the others {stuck} could not leave their cells: buried, holding others, held or loaded"));
        }
        if stuck + in_place < modules {
            let without = modules - in_place - stuck;
            let safely =
                if required.is_finite() { format!(" with a margin of {required} all along") } else { String::new() };
            line(format!("{without} found no way to a cell to fill{safely}"));
        }
    } else if upper == f64::NEG_INFINITY {
        line("whatever margin is required, and however strong the connections, nothing leads to the goal".to_string());
    } else if lower == f64::NEG_INFINITY {
        line("no plan was found with smaller margins either".to_string());
    } else {
        let at_most = if upper - lower <= 1e-4 { String::new() } else { format!(", and none above {upper:.4}") };
        let moves = found.plan.as_ref().map_or(0, |plan| plan.moves);
        line(format!("with a required margin of {lower:.4} there is a plan, of {moves} moves{at_most}"));
        let factor = found.strength_factor;
        if factor.upper.is_finite() {
            let at_least = match factor.upper - factor.lower <= 1e-4 * factor.upper {
                true => String::new(),
                false => format!(", and with less than {:.4} times there is none", factor.lower),
            };
            line(format!(
                "with everything {:.4} times as strong it would have the margin of {required}{at_least}",
                factor.upper
            ));
        }
    }
    for (held, margin) in found.too_weak.iter().take(SHOWN) {
        line(format!("too weak for it: {}, margin {:.4}", problem.held(held), margin.lower));
    }
    if found.too_weak.len() > SHOWN {
        line(format!("and {} more", found.too_weak.len() - SHOWN));
    }
    match found.never_move.as_deref() {
        None | Some([]) => {}
        Some(modules) => {
            let ids: Vec<&str> = modules.iter().map(|&module| problem.id(module)).collect();
            line(format!("never moves with the required margin, whatever others do: {}", ids.join(", ")));
        }
    }
    if let Some(limit) = found.cut_by {
        line(format!("(this search was {})", cut(limit)));
    }
}

/// How many connections that are too weak are shown.
const SHOWN: usize = 5;

fn proved<A, C>(text: &mut String, report: &Report<A, C>) {
    let proof = &report.proof;
    if matches!(report.outcome, Outcome::Impossible(_)) {
        return;
    }
    let statement = match (report.objective, proof.optimal, report.required.is_some()) {
        (Objective::Margin, true, true) => {
            "proved: no plan has a larger margin, and none with this margin has fewer moves".to_string()
        }
        (Objective::Moves, true, true) => "proved: no plan with the required margin has fewer moves".to_string(),
        (Objective::Pareto, true, true) => {
            "proved: every other plan with the required margin has no more margin than one of these, and no fewer moves"
                .to_string()
        }
        (_, true, false) => "proved: no plan has fewer moves".to_string(),
        (_, false, stability) => {
            let mut known = Vec::new();
            if stability && proof.margin_at_most.is_finite() {
                known.push(format!("no plan has a margin above {:.4}", proof.margin_at_most));
            }
            if proof.moves_at_least > 0 && proof.moves_at_least < u32::MAX {
                known.push(format!("none that is as good has fewer than {} moves", proof.moves_at_least));
            }
            if known.is_empty() { "proved: nothing yet".to_string() } else { format!("proved: {}", known.join("; ")) }
        }
    };
    let _ = writeln!(text, "{statement}");
}

fn verified<F: Family>(problem: &F, report: &Answer<F>, replay: &Replay<F::Connection, F::Touched>) -> String {
    match replay.failures.first() {
        None => {
            let (actions, states, margin) = (replay.actions_replayed, replay.oracle_solves, replay.margin);
            // Where a plan claims bounds only, so does its replay.
            let least = if margin.upper - margin.lower > BOUND { " at least" } else { "" };
            let margin = margin.lower;
            format!("verified: replayed {actions} actions over {states} states, smallest margin{least} {margin:.4}\n")
        }
        Some(failure) if report.required.is_none() => {
            format!("carried out, it would fail: {}\n", verify::sentence(problem, report.plan.as_ref(), failure))
        }
        Some(failure) => format!("NOT VERIFIED: {}\n", verify::sentence(problem, report.plan.as_ref(), failure)),
    }
}
