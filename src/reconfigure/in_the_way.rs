//! Why there is no plan, or none was found: what would have to change for there to be one.
//!
//! Knows bounds and paths; does not know what a state is.

use crate::robot::FaceConnection;
use crate::statics::Bracket;

use super::action::Action;
use super::plan::{Limit, Plan};
use super::replay::Replay;

/// What is in the way of a plan, as far as a search of its own could tell.
///
/// It looks for the plan of the largest margin with nothing required, not even that margins are positive.
#[derive(Clone, Debug, PartialEq)]
pub struct InTheWay<A = Action, C = FaceConnection> {
    /// Holds the largest margin that could be required so that there is a plan. The lower end is that of `plan`, minus
    /// infinity without one; at minus infinity on both ends it is proved that no requirement helps: nothing
    /// leads to the goal, or whatever does tips, slides or falls as a whole.
    pub margin: Bracket,
    /// Holds the smallest factor such that there is a plan with the required margin if every connector, hinge and joint is so many
    /// times as strong. Utilisation goes with one over strength, so this is the utilisation of the best plan over
    /// the one that is allowed. Infinite where strength does not help, or nothing is known.
    pub strength_factor: Bracket,
    /// The plan of the largest margin that was found. It does *not* have the margin required.
    pub plan: Option<Plan<A, C>>,
    /// Connections that would have to be stronger for that plan: the weakest one of each state whose margin is too small, with the
    /// smallest margin at which it was, the weakest first. Filled by [`InTheWay::weigh`].
    pub too_weak: Vec<(C, Bracket)>,
    /// Modules of the start, not fixed, that stay where they are in every state that can be reached with the required
    /// margin; `None` where not all of them were seen.
    pub never_move: Option<Vec<usize>>,
    /// How close a decomposition came to the goal with the margin required. It looks for nothing else, so that the
    /// rest is what start and goal alone tell.
    pub nearest: Option<Nearest>,
    /// What ended this search before it was done.
    pub cut_by: Option<Limit>,
}

/// The state at a dead end with the fewest modules missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Nearest {
    /// Modules of the robot.
    pub modules: usize,
    /// Those that were where the goal wants one of their kind.
    pub in_place: usize,
    /// Of the others, those that could not leave their cells at all: buried, needed to hold the robot together, held, or with loads of
    /// their own. The rest found no way, with the margin required, to a cell that could be filled.
    pub stuck: usize,
}

impl<A, C: Copy + PartialEq> InTheWay<A, C> {
    /// What bounds on the largest margin say. `required` is the margin that every transient state must have.
    pub(super) fn new(plan: Option<Plan<A, C>>, at_most: f64, required: f64) -> Self {
        let lower = plan.as_ref().and_then(|plan| plan.margin).map_or(f64::NEG_INFINITY, |margin| margin.lower);
        let margin = Bracket::new(lower, at_most.max(lower));
        // Stronger connectors lower every utilisation, and leave the rest of a requirement of 1 or more unmet.
        let allowed = 1.0 - required;
        let factor = |margin: f64| if allowed > 0.0 { ((1.0 - margin) / allowed).max(1.0) } else { f64::INFINITY };
        let strength_factor = Bracket::new(factor(margin.upper), factor(margin.lower));
        Self { margin, strength_factor, plan, too_weak: Vec::new(), never_move: None, nearest: None, cut_by: None }
    }

    /// What a decomposition without a plan knows.
    pub(super) fn of_decomposition(nearest: Nearest, at_most: f64, required: f64) -> Self {
        Self { nearest: Some(nearest), ..Self::new(None, at_most, required) }
    }

    /// Notes which connections are too weak for `required`, as a replay of the plan found them.
    pub fn weigh<T>(&mut self, replay: &Replay<C, T>, required: f64) {
        for state in replay.states.iter().filter(|state| !(state.moment.margin.lower >= required)) {
            let Some(weakest) = state.weakest else { continue };
            let margin = state.moment.margin;
            match self.too_weak.iter_mut().find(|(known, _)| *known == weakest) {
                Some((_, known)) => *known = known.min(margin),
                None => self.too_weak.push((weakest, margin)),
            }
        }
        self.too_weak.sort_by(|(_, a), (_, b)| a.lower.total_cmp(&b.lower));
    }
}
