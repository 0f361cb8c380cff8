//! `result/1` to records of jobs.

use super::super::codes;
use super::super::document::SourceFile;
use super::super::findings::{Document, Findings, Place};
use super::super::wire;
use super::decode::decode;
use super::outcome::limit;
use super::plan::statistics;
use super::sequence::bracket;
use crate::statics::Bracket;
use crate::suite::{Check, Ending, Flaw, Found, Point, Record};

/// The records of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Results {
    /// In the order of the lines.
    pub records: Vec<Record>,
    /// How many bytes of the file are whole lines: less than all of them when the last one was being written as the
    /// program was stopped.
    pub whole_bytes: usize,
}

/// What a job writes while it runs.
#[derive(Clone, Debug, PartialEq)]
pub enum Message {
    /// Something became known.
    Point(Point),
    /// It has ended.
    Record(Box<Record>),
}

/// The records that stand in these documents.
pub(super) fn read(documents: &[Document<'_>], file: &SourceFile, findings: &mut Findings) -> Results {
    let mut records: Vec<Record> = Vec::new();
    for document in documents {
        let place = document.root();
        let Some(record) = record(&place, findings) else { continue };
        if records.iter().any(|known| known.job == record.job) {
            let message = "a line before this one is of the same job".to_string();
            findings.add(&place.key("job"), codes::DUPLICATE_ID, message, "take one of the two lines away".to_string());
        }
        records.push(record);
    }
    let bytes = file.bytes.as_deref().unwrap_or_default();
    let whole_bytes = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    Results { records, whole_bytes }
}

/// What a line says that a job wrote while it ran.
pub(super) fn message(line: &str) -> Option<Message> {
    if let Ok(wire) = serde_json::from_str::<wire::TracePoint>(line) {
        return Some(Message::Point(point(&wire)));
    }
    let file = SourceFile::new("job", format!("{}\n", line.trim_end()));
    let mut findings = Findings::default();
    let documents = findings.open_lines(&file);
    let read = documents.map(|documents| read(&documents, &file, &mut findings));
    let mut records = findings.finish(read).ok()?.records;
    records.pop().map(|record| Message::Record(Box::new(record)))
}

fn record(place: &Place<'_>, findings: &mut Findings) -> Option<Record> {
    let wire: wire::JobResult = decode("result", place, findings)?;
    let because = wire.because.clone();
    let ending = match wire.ending {
        wire::JobEnding::Solved => Ending::Solved,
        wire::JobEnding::Impossible => Ending::Impossible,
        wire::JobEnding::Stopped => match wire.stopped_by {
            Some(stopped_by) => Ending::Stopped(limit(stopped_by)),
            None => {
                let hint = "the limit stands in `stopped_by`".to_string();
                findings.add(&place.key("ending"), codes::PLAN, "it is not said what stopped it", hint);
                return None;
            }
        },
        wire::JobEnding::Overran => Ending::Overran,
        wire::JobEnding::Crashed => Ending::Crashed(because.unwrap_or_default()),
        wire::JobEnding::Refused => Ending::Refused(because.unwrap_or_default()),
    };
    let statistics = statistics(&wire.statistics, &place.key("statistics"), findings);
    Some(Record {
        job: wire.job,
        ending,
        seconds: wire.seconds.0,
        trace: wire.trace.iter().map(point).collect(),
        found: wire.plan.map(|plan| Found {
            moves: plan.moves,
            actions: usize::try_from(plan.actions).unwrap_or(usize::MAX),
            margin: plan.margin.map(bracket),
            optimal: plan.optimal,
        }),
        check: wire.replay.map(check),
        margin_at_most: wire.margin_at_most.0.unwrap_or(f64::INFINITY),
        moves_at_least: wire.moves_at_least.unwrap_or(u32::MAX),
        statistics,
        peak_bytes: wire.peak_memory_bytes,
    })
}

fn check(wire: wire::ReplayOf) -> Check {
    let falls = Bracket { lower: f64::NEG_INFINITY, upper: f64::NEG_INFINITY };
    Check {
        flaw: wire.flaw.map(|flaw| Flaw {
            action: flaw.action.and_then(|action| usize::try_from(action).ok()),
            phase: flaw.phase.map(|phase| phase.0),
            breaks: flaw.breaks,
            what: flaw.what,
        }),
        margin: if wire.falls { falls } else { bracket(wire.margin) },
        states: wire.states,
    }
}

fn point(wire: &wire::TracePoint) -> Point {
    Point {
        seconds: wire.seconds.0,
        margin: wire.margin.map(|margin| margin.0),
        moves: wire.moves,
        margin_at_most: wire.margin_at_most.0.unwrap_or(f64::INFINITY),
        moves_at_least: wire.moves_at_least.unwrap_or(u32::MAX),
    }
}
