//! Checks a plan from the definitions, sharing no decision with the planner.
//!
//! It has its own legality of actions, checks collisions among all bodies by
//! continuous sweeps of the solids, and asks the oracle about every transient state on
//! a fixed grid that is denser than the planner's. It uses neither the
//! move generator nor canonical layouts; it shares with the planner the robot data, the
//! assembly of structures and the oracle.

mod arrival;
mod bounded;
pub(super) mod claims;
pub(super) mod failure;
pub(super) mod judge;
pub(super) mod legality;
mod transit;

use std::ops::Range;

use rayon::prelude::*;

use crate::robot::{Configuration, FaceConnection, Goal};
use crate::statics::Bracket;

use super::action::Action;
use super::assembly::Touched;
use super::plan::{IfStronger, Moment, Plan, PlannedAction};
use super::refusal::{Refusal, check};
pub use failure::{Failure, Fault};
use judge::Found;
use legality::{Transition, transition};
use transit::{Checker, Scene};

/// What a replay found.
#[derive(Clone, Debug, PartialEq)]
pub struct Replay<C = FaceConnection, T = Touched> {
    /// Everything that is wrong, in the order of the actions; the plan's
    /// own claims and the goal come last. Empty for a plan that verifies.
    pub failures: Vec<Failure<C, T>>,
    /// Smallest margin over all states that were reached.
    pub margin: Bracket,
    /// All states that were assessed, in the order of the plan.
    pub states: Vec<State<C>>,
    /// Actions that could be carried out.
    pub actions_replayed: usize,
    /// Structures that the oracle assessed.
    pub oracle_solves: u64,
}

/// A state that was assessed.
#[derive(Clone, Debug, PartialEq)]
pub struct State<C = FaceConnection> {
    /// When, and its margin.
    pub moment: Moment,
    /// The connection that is weakest then, if any holds at all.
    pub weakest: Option<C>,
}

impl<C, T> Replay<C, T> {
    /// Whether nothing is wrong.
    pub fn is_verified(&self) -> bool {
        self.failures.is_empty()
    }
}

/// Replays a plan from `start` and checks everything that it claims.
///
/// `required` is the margin that every transient state must have. The planner samples a move at
/// other phases, so on this grid a move may fall below a positive requirement by 5 % of the
/// utilisation that it allows, but never below 0; a state at rest may not at all.
/// A plan that claims no margins (made by geometry alone) is held to the same requirement.
///
/// After an action that is not legal the rest cannot be replayed, and is not.
///
/// # Errors
/// [`Refusal`] when start and goal themselves are unsound.
pub fn replay(start: &Configuration, goal: &Goal, plan: &Plan, required: f64) -> Result<Replay, Refusal> {
    run(start, goal, plan, required, None)
}

/// The plan with its margins over time, from a replay of it, and with what it would be worth if its bottleneck were
/// twice as strong, from another one. The latter is left out for a plan that claims bounds only.
///
/// # Errors
/// [`Refusal`] when start and goal themselves are unsound.
pub fn appraise(start: &Configuration, goal: &Goal, plan: &Plan, replay: &Replay) -> Result<Plan, Refusal> {
    // Of a plan that claims bounds only, nothing says how much of the margin is its bottleneck's.
    let is_value = |planned: &PlannedAction| {
        planned.margin.is_none_or(|claim| claims::bound(&claim, planned.action.is_move()).is_none())
    };
    let bottleneck = plan.bottleneck.as_ref().filter(|_| plan.actions.iter().all(is_value));
    let weakest = bottleneck.and_then(|bottleneck| bottleneck.connection);
    let again = weakest.map(|held| run(start, goal, plan, f64::NEG_INFINITY, Some((held, TWICE)))).transpose()?;
    let if_stronger = again.map(|again| IfStronger { factor: TWICE, margin: again.margin });
    Ok(Plan { profile: profile(replay), if_stronger, ..plan.clone() })
}

/// How much stronger a bottleneck is taken to be.
pub(super) const TWICE: f64 = 2.0;

/// The margins of a replay over time.
pub(super) fn profile<C, T>(replay: &Replay<C, T>) -> Vec<Moment> {
    replay.states.iter().map(|state| state.moment).collect()
}

/// Replays a plan, one connection being so many times as strong as it is.
fn run(
    start: &Configuration,
    goal: &Goal,
    plan: &Plan,
    required: f64,
    stronger: Option<(FaceConnection, f64)>,
) -> Result<Replay, Refusal> {
    check(start, goal)?;
    let scene = Scene::new(start, required, stronger);
    let mut checker = Checker::new(&scene);
    let mut state = start.clone();
    state.connections.sort_unstable();

    let at_start = checker.rest(None, &state, None)?;
    // Where actions lead is quickly told. So blocks of them can be looked at independently, each from its first state.
    let mut blocks: Vec<Block> = Vec::new();
    let mut illegal = None;
    for (index, planned) in plan.actions.iter().enumerate() {
        match transition(&state, &planned.action) {
            Err(fault) => {
                illegal = Some((index, fault));
                break;
            }
            Ok(next) => {
                if index % BLOCK == 0 {
                    blocks.push(Block { from: state, actions: index..index });
                }
                blocks.last_mut().expect("the first action begins a block").actions.end = index + 1;
                state = next.after;
            }
        }
    }
    let movers = neighbouring_movers(plan);
    let of_block = |block: &Block| {
        let mut checker = Checker::new(&scene);
        let found = check_block(&mut checker, block, plan, stronger.is_none(), &movers)?;
        Ok((found, checker.judged()))
    };
    let checked: Vec<_> = blocks.par_iter().map(of_block).collect::<Result<_, Refusal>>()?;
    let mut found = vec![at_start];
    for (of_block, by) in checked {
        found.extend(of_block);
        checker.join(by);
    }
    let is_legal = illegal.is_none();
    if let Some((index, fault)) = illegal {
        checker.judge.fail(Some(index), None, fault, None);
    }
    let actions_replayed = found.len() - 1;
    let moves = plan.actions.iter().filter(|planned| planned.action.is_move()).count();
    claims::check(&mut checker.judge, plan, moves, &found);
    if is_legal && let Some(fault) = arrival::missing(start, &state, goal) {
        checker.judge.fail(None, None, fault, None);
    }
    let margin = found.iter().map(|f| f.margin).reduce(Bracket::min).expect("the start was checked");
    let states = judge::states(&found);
    let oracle_solves = checker.solves();
    Ok(Replay { margin, states, actions_replayed, oracle_solves, failures: checker.judge.failures })
}

/// Actions that are looked at one after the other, with what was found for those before. Fewer would know less, more
/// would leave threads idle at the end.
const BLOCK: usize = 256;

/// Legal actions from a state on.
struct Block {
    from: Configuration,
    actions: Range<usize>,
}

/// Checks the actions of a block; `with_claims` says whether by what the plan claims of them.
fn check_block(
    checker: &mut Checker,
    block: &Block,
    plan: &Plan,
    with_claims: bool,
    movers: &[[Option<usize>; 2]],
) -> Result<Vec<Found<FaceConnection>>, Refusal> {
    let mut state = block.from.clone();
    let mut found = Vec::with_capacity(block.actions.len());
    for index in block.actions.clone() {
        let planned = &plan.actions[index];
        let next = transition(&state, &planned.action).expect("all actions of a block are legal");
        let claim = planned.margin.filter(|_| with_claims);
        let bound = claim.and_then(|claim| claims::bound(&claim, planned.action.is_move()));
        let bottleneck = plan.bottleneck.as_ref().filter(|b| b.action == Some(index)).map(|b| b.phase);
        let claimed: Vec<f64> = planned.phase.into_iter().chain(bottleneck).collect();
        let by = Hint { claimed: &claimed, bound, hanging: movers[index] };
        found.push(take(checker, index, &state, &next, &by)?);
        state = next.after;
    }
    Ok(found)
}

/// What a plan says about an action that tells where and how tightly to look. Wrong hints cost time only.
struct Hint<'a> {
    /// Phases that are spoken of.
    claimed: &'a [f64],
    /// The margin that is to be confirmed, where the plan claims no value.
    bound: Option<f64>,
    /// Modules that may hang on all others, the likeliest first.
    hanging: [Option<usize>; 2],
}

/// For every action the modules that are moved by the last move and by the next one: after a move or attaching the
/// former is likely to hang on the others, before a move the latter.
fn neighbouring_movers(plan: &Plan) -> Vec<[Option<usize>; 2]> {
    let mut last = None;
    let mut movers: Vec<[Option<usize>; 2]> = Vec::with_capacity(plan.actions.len());
    for planned in &plan.actions {
        last = planned.action.moved().or(last);
        movers.push([last, None]);
    }
    let mut next = None;
    for (planned, pair) in plan.actions.iter().zip(&mut movers).rev() {
        pair[1] = next;
        if matches!(planned.action, Action::Detach(_)) {
            pair.swap(0, 1);
        }
        next = planned.action.moved().or(next);
    }
    movers
}

/// The state after actions, each of which must be legal in the state that it is taken in; forces and collisions play no
/// part.
///
/// # Errors
/// The first action that is not legal, with why.
pub fn after<'a>(
    start: &Configuration,
    actions: impl IntoIterator<Item = &'a Action>,
) -> Result<Configuration, (usize, Fault)> {
    let mut state = start.clone();
    state.connections.sort_unstable();
    for (index, action) in actions.into_iter().enumerate() {
        state = transition(&state, action).map_err(|fault| (index, fault))?.after;
    }
    Ok(state)
}

/// Checks one legal action and says what margins it has.
fn take(
    checker: &mut Checker,
    index: usize,
    before: &Configuration,
    next: &Transition,
    by: &Hint,
) -> Result<Found<FaceConnection>, Refusal> {
    let during = match &next.path {
        Some(path) => Some(checker.transit(index, before, path, by.claimed, by.bound)?),
        None => None,
    };
    let bounded = by.bound.map(|bound| (bound, by.hanging));
    let rest = checker.rest(Some(index), &next.after, bounded)?;
    Ok(during.map_or(rest.clone(), |during| during.followed_by(rest)))
}
