//! What planning returns: plans, what they are worth, and what was proved.
//!
//! Plain data, whatever the robot: `A` is an action on its modules and `C` what names a
//! connection of it. Without parameters they are those of a lattice.

use crate::robot::FaceConnection;
use crate::statics::{Bracket, Tally};

use super::action::Action;
use super::in_the_way::InTheWay;
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
    /// Every trade between the two that no other plan beats: first the plan of the largest margin, then those with fewer
    /// moves and smaller margins.
    Pareto,
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

/// One of the states that a plan passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Index of the action; `None` for the start as it is.
    pub action: Option<usize>,
    /// Phase of the action, from 0 to 1; 1 also at rest after it.
    pub phase: f64,
    /// Margin then.
    pub margin: Bracket,
}

/// What a plan would be worth if the connection at its bottleneck were stronger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IfStronger {
    /// How many times as strong, wherever the same two ports hold each other, or the same joint.
    pub factor: f64,
    /// Smallest margin of the same plan's states then, on the grid of a replay.
    pub margin: Bracket,
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
    /// Margins over time, on the grid of a replay; empty until the plan is [appraised](super::replay::appraise).
    pub profile: Vec<Moment>,
    /// What a stronger bottleneck would gain; `None` until the plan is appraised, or where no connection is the weakest.
    pub if_stronger: Option<IfStronger>,
}

impl<A, C> Plan<A, C> {
    /// The plan that does nothing, before anything is known of it.
    pub(super) const EMPTY: Self =
        Self { margin: None, moves: 0, bottleneck: None, actions: Vec::new(), profile: Vec::new(), if_stronger: None };
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
    /// margins; for [`Objective::Pareto`] whether the plans are the whole front.
    pub optimal: bool,
    /// No plan has a larger margin; infinite where plans are made by geometry alone.
    pub margin_at_most: f64,
    /// No plan with the margin required, or with the best one for
    /// [`Objective::Margin`], has fewer moves; for [`Objective::Pareto`], none that those found do not match.
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
    /// Time that assembling and assessing them took in s, by [`Options::clock`](super::Options::clock); 0 without one, and
    /// not part of a plan file.
    pub oracle_seconds: f64,
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
    /// Further plans, best first, that differ in more than the order of independent moves: those that come next by margin and
    /// then by moves, for [`Objective::Moves`] by moves, for [`Objective::Pareto`] the rest of the front.
    pub alternatives: Vec<Plan<A, C>>,
    /// What ended the search for further plans before there were as many as
    /// asked for; `None` where these are all that exist, or enough.
    pub alternatives_cut_by: Option<Limit>,
    /// What is in the way of a plan, where none was found and that was asked for.
    pub in_the_way: Option<InTheWay<A, C>>,
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
            in_the_way: None,
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
