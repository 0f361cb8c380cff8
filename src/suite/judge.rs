//! Replays what a job found: nothing counts before.

use std::fmt::Display;

use crate::generate::Pair;
use crate::reconfigure::linkage::assembly::Held;
use crate::reconfigure::replay::{Failure, Fault, Replay, replay};
use crate::reconfigure::{Refusal, linkage};
use crate::robot::FaceConnection;
use crate::statics::Bracket;

use super::plan::AnyPlan;

/// What a replay found.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The first thing that is wrong; `None` for a plan that is confirmed.
    pub flaw: Option<Flaw>,
    /// Smallest margin over all states that were reached.
    pub margin: Bracket,
    /// States that the oracle was asked about.
    pub states: u64,
}

/// What is wrong with a plan.
#[derive(Clone, Debug, PartialEq)]
pub struct Flaw {
    /// Which action, from 0; `None` for the plan as a whole.
    pub action: Option<usize>,
    /// How far on its way the action was, from 0 to 1; `None` where that says nothing.
    pub phase: Option<f64>,
    /// Whether the robot breaks, tips, slides or falls: everything else is a fault of the plan.
    pub breaks: bool,
    /// In a sentence.
    pub what: String,
}

impl Check {
    /// Whether the plan is confirmed.
    pub fn is_verified(&self) -> bool {
        self.flaw.is_none()
    }
}

/// Replays the plan of an answer to a problem, holding it to a margin that every transient state must have. `None`
/// where there is no plan.
///
/// # Errors
/// The problem itself is unsound.
///
/// # Panics
/// When the answer is for robots of the other kind.
pub fn judge(pair: &Pair, answer: &AnyPlan, required: f64) -> Result<Option<Check>, Refusal> {
    match (pair, answer) {
        (Pair::Lattice { start, goal }, AnyPlan::Lattice(report)) => {
            let Some(plan) = &report.plan else { return Ok(None) };
            let found = replay(start, goal, plan, required)?;
            let name = |held: &FaceConnection| {
                held.ports.map(|port| format!("{}:{}", start.modules[port.module].id, port.face.name())).join(" - ")
            };
            Ok(Some(check(&found, name)))
        }
        (Pair::Linkage { start, goal }, AnyPlan::Linkage(report)) => {
            let Some(plan) = &report.plan else { return Ok(None) };
            let found = linkage::replay::replay(start, goal, plan, required)?;
            let name = |held: &Held| match *held {
                Held::Ports(connection) => {
                    let port = |port: crate::robot::linkage::Port| {
                        let kind = &start.module_type(port.module).ports[port.port];
                        format!("{}:{}", start.modules[port.module].id, kind.name)
                    };
                    connection.ports.map(port).join(" - ")
                }
                Held::Joint { module, joint } => {
                    format!("{}.{}", start.modules[module].id, start.module_type(module).joints[joint].name)
                }
            };
            Ok(Some(check(&found, name)))
        }
        (Pair::Lattice { .. }, AnyPlan::Linkage(_)) | (Pair::Linkage { .. }, AnyPlan::Lattice(_)) => {
            panic!("a plan for robots of another kind")
        }
    }
}

fn check<C, T: Display>(replay: &Replay<C, T>, name: impl Fn(&C) -> String) -> Check {
    let flaw = replay.failures.first().map(|failure| flaw(failure, name));
    Check { flaw, margin: replay.margin, states: replay.oracle_solves }
}

fn flaw<C, T: Display>(failure: &Failure<C, T>, name: impl Fn(&C) -> String) -> Flaw {
    let breaks = matches!(failure.fault, Fault::Unstable { .. });
    let mut what = failure.fault.to_string();
    if let Some(connection) = failure.connection.as_ref().filter(|_| breaks) {
        what += &format!("; {} gives way", name(connection));
    }
    Flaw { action: failure.action, phase: failure.phase, breaks, what }
}
