//! What files mean, once read: core types with the names that the file gave.

use crate::robot::{Cell, Configuration, Face, Goal, Port};
use crate::statics::{Bracket, Structure};

/// A text and what to call it in messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceFile {
    /// Name as messages show it, usually the path as the user gave it.
    pub name: String,
    /// The bytes, which need not be valid UTF-8 nor valid JSON.
    pub bytes: Vec<u8>,
}

impl SourceFile {
    /// A text under a name.
    pub fn new(name: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { name: name.into(), bytes: bytes.into() }
    }
}

/// Fetches a file that another one refers to: the name of the referring
/// file, then the reference as written there. The error is shown to the user.
pub type Resolve<'a> = &'a dyn Fn(&str, &str) -> Result<SourceFile, String>;

/// Refuses every reference: for texts that must stand on their own.
///
/// # Errors
/// Always.
pub fn no_references(_from: &str, _reference: &str) -> Result<SourceFile, String> {
    Err("references to other files are not followed here".to_string())
}

/// A structure with the names of its parts, each list in the structure's order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedStructure {
    /// The oracle's input.
    pub structure: Structure,
    /// Names of the bodies.
    pub bodies: Vec<String>,
    /// Names of the connections.
    pub connections: Vec<String>,
    /// Names of the contacts.
    pub contacts: Vec<String>,
}

/// A start and a goal that have been checked against each other: the same
/// catalogue, gravity, environment and loads, and modules that can match.
/// The goal's modules are in the start's order when the goal is labelled.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Where the robot is.
    pub start: Configuration,
    /// Where it is to be.
    pub goal: Goal,
}

/// What `plan check` can look at.
#[derive(Clone, Debug, PartialEq)]
pub enum Checkable {
    /// Bodies and connections without a robot.
    Structure(NamedStructure),
    /// A robot in its environment.
    Configuration(Configuration),
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlanOutcome {
    /// A plan was found.
    Solved,
    /// It is proved that there is none.
    Impossible,
    /// Nothing was found within the limits.
    OutOfBudget,
}

/// What a search was asked to optimise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlanObjective {
    /// The best worst-case margin, then the fewest moves.
    Margin,
    /// The fewest moves with at least the required margin.
    Moves,
}

/// What a plan's action does, by indices into the start's modules.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlannedAction {
    /// Two coinciding faces engage. Ports are each module's own faces at that moment.
    Attach([Port; 2]),
    /// An engaged connection opens.
    Detach([Port; 2]),
    /// A module slides into the neighbouring cell `to`.
    Slide {
        /// Which module.
        module: usize,
        /// Where it ends.
        to: Cell,
    },
    /// A module turns about an edge that it shares with a neighbour.
    Pivot {
        /// Which module.
        module: usize,
        /// The neighbour that carries the hinge.
        support: usize,
        /// World direction that the turn is right-handed about.
        axis: Face,
        /// 1 for a turn of 90 degrees, 2 for 180.
        quarter_turns: u8,
        /// Where it ends.
        to: Cell,
    },
}

/// An action of a plan with what is known of its transient states.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedStep {
    /// What is done.
    pub action: PlannedAction,
    /// Smallest margin of the action's transient states; `None` when nothing
    /// was proved of it (planned without stability).
    pub margin: Option<Bracket>,
}

/// Where a plan's margin is smallest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanBottleneck {
    /// Index of the action; `None` when it is the start itself.
    pub action: Option<usize>,
    /// How far the action is done, 0 to 1.
    pub phase: f64,
    /// The connection that the margin hangs on, if any does.
    pub connection: Option<[Port; 2]>,
}

/// A sequence of actions and its worth.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanSequence {
    /// Smallest margin of all transient states, the start's included; `None` when unknown.
    pub margin: Option<Bracket>,
    /// Number of moves (slides and pivots).
    pub moves: usize,
    /// Where the margin is smallest; `None` when unknown.
    pub bottleneck: Option<PlanBottleneck>,
    /// The actions, in order.
    pub actions: Vec<PlannedStep>,
}

/// What a search proved.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanProof {
    /// Whether the first plan is proved best.
    pub optimal: bool,
    /// No plan has a larger margin than this; `None` when nothing was proved.
    pub margin_at_most: Option<f64>,
    /// No plan has fewer moves than this; `None` when nothing was proved.
    pub moves_at_least: Option<usize>,
}

/// What a search did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanStatistics {
    /// States expanded.
    pub expanded: u64,
    /// Exact oracle calls.
    pub oracle_solves: u64,
    /// States that bounds decided without a solve.
    pub decided_by_bounds: u64,
    /// Wall-clock time in s.
    pub seconds: f64,
}

/// All that a plan file says.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanDocument {
    /// How the search ended.
    pub outcome: PlanOutcome,
    /// What it optimised.
    pub objective: PlanObjective,
    /// What it proved.
    pub proof: PlanProof,
    /// The plans, best first; empty unless solved.
    pub plans: Vec<PlanSequence>,
    /// The problem, so that the file stands on its own.
    pub problem: Problem,
    /// What the search did.
    pub statistics: PlanStatistics,
}
