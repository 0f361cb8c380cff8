//! What a job found. Plain data.

use crate::reconfigure::{Limit, Statistics};
use crate::statics::Bracket;

use super::judge::Check;

/// How a job ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Ending {
    /// A plan was found and is claimed to be the best.
    Solved,
    /// It is claimed that there is no plan.
    Impossible,
    /// The search stopped by itself at a limit.
    Stopped(Limit),
    /// The job did not stop at its time limit and was ended.
    Overran,
    /// The job ended without an answer: out of memory, or a bug. How, in the system's words.
    Crashed(String),
    /// The problem could not be drawn, or the planner refused it: why.
    Refused(String),
}

/// A moment of the search at which something became known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Time since planning began, in s.
    pub seconds: f64,
    /// Margin of the best plan so far.
    pub margin: Option<f64>,
    /// Its moves.
    pub moves: Option<u32>,
    /// No plan has a larger margin.
    pub margin_at_most: f64,
    /// No plan that is as good has fewer moves.
    pub moves_at_least: u32,
}

/// The plan that a job found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// How many moves it has.
    pub moves: u32,
    /// How many actions.
    pub actions: usize,
    /// The margin that it claims; `None` where it was made by geometry alone.
    pub margin: Option<Bracket>,
    /// Whether it is claimed to be the best.
    pub optimal: bool,
}

/// All that a job found.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Name of the job.
    pub job: String,
    /// How it ended.
    pub ending: Ending,
    /// Time that planning took in s; for a job that was ended, until then.
    pub seconds: f64,
    /// What became known when.
    pub trace: Vec<Point>,
    /// The plan, if there is one.
    pub found: Option<Found>,
    /// What a replay of the plan, as it is on file, found.
    pub check: Option<Check>,
    /// No plan has a larger margin.
    pub margin_at_most: f64,
    /// No plan that is as good has fewer moves.
    pub moves_at_least: u32,
    /// What the search took.
    pub statistics: Statistics,
    /// Peak memory of the job's process in bytes, where the system tells.
    pub peak_bytes: Option<u64>,
}

impl Record {
    /// Whether it holds a plan that a replay confirms.
    pub fn is_solved(&self) -> bool {
        self.found.is_some() && self.check.as_ref().is_some_and(Check::is_verified)
    }

    /// Whether the question is answered: a confirmed plan that is claimed to be the best, or none exists.
    pub fn is_decided(&self) -> bool {
        match self.ending {
            Ending::Solved => self.is_solved() && self.found.as_ref().is_some_and(|found| found.optimal),
            Ending::Impossible => true,
            Ending::Stopped(_) | Ending::Overran | Ending::Crashed(_) | Ending::Refused(_) => false,
        }
    }

    /// Whether a replay refutes its plan, for another reason than that a plan by geometry alone may break: a bug.
    pub fn is_refuted(&self) -> bool {
        let flaw = self.check.as_ref().and_then(|check| check.flaw.as_ref());
        flaw.is_some_and(|flaw| !(flaw.breaks && self.breaks().is_some()))
    }

    /// When the first plan was known, of a job that is solved: in s.
    pub fn first_plan_seconds(&self) -> Option<f64> {
        let first = self.trace.iter().find(|point| point.moves.is_some() || point.margin.is_some());
        self.is_solved().then(|| first.map_or(self.seconds, |point| point.seconds))
    }

    /// Whether a plan that ignores stability breaks when it is carried out; `None` unless there is such a plan.
    pub fn breaks(&self) -> Option<bool> {
        self.found.as_ref().filter(|found| found.margin.is_none())?;
        Some(!self.check.as_ref()?.is_verified())
    }
}
