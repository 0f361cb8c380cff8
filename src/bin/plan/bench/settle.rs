//! What a job's plan file is worth: nothing before a replay.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use steadfast::generate::{Generated, Pair, generate};
use steadfast::io::{Verifiable, read_verifiable};
use steadfast::reconfigure::Report;
use steadfast::statics::Bracket;
use steadfast::suite::{AnyPlan, Check, Flaw, Found, Job, Record, judge};

use crate::files;

/// The record of a job with what a replay of its plan file finds. The problem is drawn anew: the file is believed in
/// nothing, and what the job said of its plan does not count.
pub fn settled(job: &Job, mut record: Record, plan: &Path) -> Record {
    record.found = None;
    if plan.exists() {
        let (found, check) = catch_unwind(AssertUnwindSafe(|| replayed(job, plan)))
            .unwrap_or_else(|_| refuted("the replay has a bug: it panicked"));
        (record.found, record.check) = (Some(found), Some(check));
    }
    record
}

fn replayed(job: &Job, plan: &Path) -> (Found, Check) {
    let (answer, found, contradicts) = match read_verifiable(&files::read(plan)) {
        Ok(Verifiable::Plan(document)) => {
            let contradicts = !document.contradictions.is_empty();
            (AnyPlan::Lattice(document.report.clone().into()), summary(&document.report), contradicts)
        }
        Ok(Verifiable::LinkagePlan(document)) => {
            let contradicts = !document.contradictions.is_empty();
            (AnyPlan::Linkage(document.report.clone().into()), summary(&document.report), contradicts)
        }
        Ok(Verifiable::Certificate(_)) => return refuted("the file holds no plan"),
        Err(diagnostics) => {
            let first = diagnostics.items().first().map_or_else(String::new, |item| item.message.clone());
            return refuted(&format!("the plan's file cannot be read: {first}"));
        }
    };
    let pair: Pair = match generate(&job.request) {
        Ok(Generated { pair, .. }) => pair,
        Err(failure) => return refuted(&failure.to_string()),
    };
    if !answer.fits(&pair) {
        return refuted("the plan is for robots of another kind");
    }
    let Some(found) = found else { return refuted("the file holds no plan") };
    match judge(&pair, &answer, job.min_margin) {
        Ok(Some(check)) if contradicts && check.is_verified() => {
            let flaw = flaw("an action of the file contradicts itself");
            (found, Check { flaw: Some(flaw), ..check })
        }
        Ok(Some(check)) => (found, check),
        Ok(None) => refuted("the file holds no plan"),
        Err(refusal) => refuted(&refusal.to_string()),
    }
}

fn summary<A, C>(report: &Report<A, C>) -> Option<Found> {
    report.plan.as_ref().map(|plan| Found {
        moves: plan.moves,
        actions: plan.actions.len(),
        margin: plan.margin,
        optimal: report.proof.optimal,
    })
}

/// A plan that does not count.
fn refuted(why: &str) -> (Found, Check) {
    let unknown = Bracket::new(f64::NEG_INFINITY, f64::INFINITY);
    let found = Found { moves: 0, actions: 0, margin: Some(unknown), optimal: false };
    (found, Check { flaw: Some(flaw(why)), margin: unknown, states: 0 })
}

fn flaw(what: &str) -> Flaw {
    Flaw { action: None, phase: None, breaks: false, what: what.to_string() }
}

/// A finished job on one line.
pub fn line(record: &Record) -> String {
    use steadfast::suite::Ending;
    let ending = match &record.ending {
        Ending::Solved => "solved".to_string(),
        Ending::Impossible => "no plan exists".to_string(),
        Ending::Stopped(limit) => format!("stopped ({limit:?})").to_lowercase(),
        Ending::Overran => "overran its time limit".to_string(),
        Ending::Crashed(how) => format!("crashed: {how}"),
        Ending::Refused(why) => format!("refused: {why}"),
    };
    let plan = record.found.as_ref().map_or_else(String::new, |found| {
        let margin = found.margin.map_or_else(String::new, |margin| format!(" with margin {:.4}", margin.lower));
        format!(", {} moves{margin}", found.moves)
    });
    let check = match &record.check {
        Some(Check { flaw: Some(flaw), .. }) if flaw.breaks => ", breaks",
        Some(Check { flaw: Some(_), .. }) => ", NOT VERIFIED",
        Some(_) => ", verified",
        None => "",
    };
    format!("{}: {ending}{plan}{check}, {:.2} s", record.job, record.seconds)
}
