//! What planning returns: plans, what they are worth, and what was proved.
//!
//! Plain data, whatever the robot: `A` is an action on its modules and `C` what names a
//! connection of it. Without parameters they are those of a lattice.

use crate::robot::FaceConnection;
use crate::statics::{Bracket, Tally};

use super::action::Action;
use super::refusal::Impossible;

pub use planners::Limit;

/// What makes one plan better than another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Objective {
    /// The largest margin, then the fewest moves.
    #[default]
    Margin,
    /// The fewest moves whose margin is at least the required one.
    Moves,
}

/// An action with what it is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedAction<A = Action> {
    /// What is done.
    pub action: A,
    /// Smallest margin of the states during and after it; `None` where plans
    /// are made by geometry alone.
    pub margin: Option<Bracket>,
    /// Phase at which that margin is attained: 1 after the action. `None` where
    /// the margin is, or where a plan does not say.
    pub phase: Option<f64>,
}

/// Where a plan's margin is attained.
#[derive(Clone, Debug, PartialEq)]
pub struct Bottleneck<C = FaceConnection> {
    /// Index of the action; `None` for the start as it is.
    pub action: Option<usize>,
    /// Phase of the action, from 0 to 1.
    pub phase: f64,
    /// The weakest connection then, by its ports; of a sliding or pivoting module, the
    /// faces that slide over each other or that the hinge joins. `None` when nothing holds.
    pub connection: Option<C>,
}

/// A sequence of actions from the start to the goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan<A = Action, C = FaceConnection> {
    /// Smallest margin of all transient states, the start included; `None`
    /// where plans are made by geometry alone.
    pub margin: Option<Bracket>,
    /// How many of the actions are moves.
    pub moves: u32,
    /// Where the margin is attained; of equals the first.
    pub bottleneck: Option<Bottleneck<C>>,
    /// What to do.
    pub actions: Vec<PlannedAction<A>>,
}

/// How planning ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome<C = FaceConnection> {
    /// A plan was found and is proved to be the best.
    Solved,
    /// It is proved that there is none in this action set.
    Impossible(Impossible<C>),
    /// Neither; the plan, if there is one, is the best so far.
    OutOfBudget(Limit),
}

/// What holds for all plans.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proof {
    /// Whether the plan is the best by its objective, within the tolerance of
    /// margins.
    pub optimal: bool,
    /// No plan has a larger margin; infinite where plans are made by geometry alone.
    pub margin_at_most: f64,
    /// No plan with the margin required, or with the best one for
    /// [`Objective::Margin`], has fewer moves.
    pub moves_at_least: u32,
}

/// What planning took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Statistics {
    /// States expanded.
    pub expanded: u64,
    /// Distinct states met.
    pub states: u64,
    /// Transitions generated.
    pub generated: u64,
    /// Transitions whose margin was asked for; all others were decided by bounds.
    pub certified: u64,
    /// Structures that the oracle assessed.
    pub oracle_solves: u64,
    /// What it took to assess them, of lattice robots; not part of a plan file.
    pub decided_by: Tally,
    /// Peak memory of the search, in approximate bytes.
    pub bytes: u64,
    /// Wall-clock time in s.
    pub seconds: f64,
}

impl Statistics {
    /// Transitions for which the whole robot was never assessed.
    pub fn decided_by_bounds(&self) -> u64 {
        self.generated.saturating_sub(self.certified)
    }
}

/// The answer to a planning problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Report<A = Action, C = FaceConnection> {
    /// How it ended.
    pub outcome: Outcome<C>,
    /// What was asked for.
    pub objective: Objective,
    /// Margin that every transient state must have; `None` where plans are made
    /// by geometry alone.
    pub required: Option<f64>,
    /// The best plan found.
    pub plan: Option<Plan<A, C>>,
    /// Further plans, best first, that differ in more than the order of independent moves.
    pub alternatives: Vec<Plan<A, C>>,
    /// What ended the search for further plans before there were as many as
    /// asked for; `None` where these are all that exist, or enough.
    pub alternatives_cut_by: Option<Limit>,
    /// What was proved.
    pub proof: Proof,
    /// What it took.
    pub statistics: Statistics,
}

impl<A, C> Report<A, C> {
    /// The report of a problem that is proved to have no plan before any search.
    pub(super) fn impossible(objective: Objective, required: Option<f64>, reason: Impossible<C>) -> Self {
        Self {
            outcome: Outcome::Impossible(reason),
            objective,
            required,
            plan: None,
            alternatives: Vec::new(),
            alternatives_cut_by: None,
            proof: Proof::NOTHING_TO_FIND,
            statistics: Statistics::default(),
        }
    }
}

impl Proof {
    /// What holds for all plans when there are none.
    pub(super) const NOTHING_TO_FIND: Self =
        Self { optimal: false, margin_at_most: f64::NEG_INFINITY, moves_at_least: u32::MAX };
}
