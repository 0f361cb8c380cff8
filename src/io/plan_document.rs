//! A plan file once read: the planner's own report, with its problem.

use std::fmt;

use super::document::{LatticeProblem, LinkageProblem};
use super::turn::AxisAngle;
use crate::reconfigure::linkage::assembly::Held;
use crate::reconfigure::{Action, Plan, Report, linkage};
use crate::robot::FaceConnection;

/// All that a plan file says: of a problem `P` with actions `A` and connections `C`, by default those of lattices.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanDocument<P = LatticeProblem, A = Action, C = FaceConnection> {
    /// The problem, so that the file stands on its own.
    pub problem: P,
    /// What the search answered.
    pub report: Report<A, C>,
    /// Pivots of the file that contradict themselves, by plan and action. A plan with one
    /// of them does not verify. Always empty for what a search answered.
    pub contradictions: Vec<Contradiction>,
}

/// All that a plan file for a linkage says.
pub type LinkagePlanDocument = PlanDocument<LinkageProblem, linkage::Action, Held>;

/// A pivot whose axis or angle, as its file gives them, is not that of the turn from where
/// the module is to where the same action says that it ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Contradiction {
    /// Which plan: 0 for the best one, then the alternatives.
    pub plan: usize,
    /// Index of the action in that plan.
    pub action: usize,
    /// The turn that the file gives.
    pub given: AxisAngle,
    /// The turn between the two cells; `None` when no turn leads from one to the other.
    pub actual: Option<AxisAngle>,
}

impl<P, A: Clone, C: Clone> PlanDocument<P, A, C> {
    /// What a search answered to a problem.
    pub fn new(problem: P, report: &Report<A, C>) -> Self {
        Self { problem, report: report.clone(), contradictions: Vec::new() }
    }

    /// The plans, best first.
    pub fn plans(&self) -> impl Iterator<Item = &Plan<A, C>> {
        self.report.plan.iter().chain(&self.report.alternatives)
    }

    /// The contradictions of one of the [plans](Self::plans), by its place among them.
    pub fn contradictions_of(&self, plan: usize) -> impl Iterator<Item = &Contradiction> {
        self.contradictions.iter().filter(move |contradiction| contradiction.plan == plan)
    }
}

impl fmt::Display for Contradiction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a turn by {} does not lead to the cell that is given", self.given)?;
        match self.actual {
            Some(actual) => write!(f, ", a turn by {actual} does"),
            None => f.write_str(", and no turn about the support does"),
        }
    }
}

impl std::error::Error for Contradiction {}
