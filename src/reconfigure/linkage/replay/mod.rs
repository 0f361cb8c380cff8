//! Checks a plan for a linkage from the definitions, sharing no decision with the planner.
//!
//! It has its own legality of actions, moves poses rather than integers, checks collisions among all bodies by
//! continuous sweeps of the solids, asks the oracle about every transient state on a fixed grid that is denser
//! than the planner's, and compares the end with the goal by where ports and masses are. It shares with the
//! planner the robot data, the assembly of structures and the oracle.

mod arrival;
pub(in crate::reconfigure) mod legality;
pub(in crate::reconfigure) mod transit;

use crate::reconfigure::plan::{IfStronger, Plan};
use crate::reconfigure::refusal::Refusal;
use crate::reconfigure::replay::judge::{Found, Judge, Sample, phases, states};
use crate::reconfigure::replay::{Replay, TWICE, claims, profile};
use crate::robot::linkage::{Goal, Linkage};
use crate::statics::Bracket;

use super::action::Action;
use super::assembly::{Assembler, Held, Touched};
use super::state::State;
use legality::{Transition, transition};
use transit::Checker;

/// What can be wrong with an action.
type Fault = crate::reconfigure::replay::Fault<Touched>;

/// Replays a plan from `start` and checks everything that it claims.
///
/// `required` is the margin that every transient state must have, with the tolerance for moves that
/// [`replay`](crate::reconfigure::replay::replay) has for lattices. After an action that is not legal the rest
/// cannot be replayed, and is not. Start and goal must be sound.
///
/// # Errors
/// [`Refusal::Structure`] when the oracle refuses a structure.
pub fn replay(
    start: &Linkage,
    goal: &Goal,
    plan: &Plan<Action, Held>,
    required: f64,
) -> Result<Replay<Held, Touched>, Refusal> {
    run(start, goal, plan, required, None)
}

/// The plan with its margins over time and with what a stronger bottleneck would gain, like
/// [`appraise`](crate::reconfigure::replay::appraise) does for lattices.
///
/// # Errors
/// [`Refusal::Structure`] when the oracle refuses a structure.
pub fn appraise(
    start: &Linkage,
    goal: &Goal,
    plan: &Plan<Action, Held>,
    replay: &Replay<Held, Touched>,
) -> Result<Plan<Action, Held>, Refusal> {
    let weakest = plan.bottleneck.as_ref().and_then(|bottleneck| bottleneck.connection);
    let again = weakest.map(|held| run(start, goal, plan, f64::NEG_INFINITY, Some((held, TWICE)))).transpose()?;
    let if_stronger = again.map(|again| IfStronger { factor: TWICE, margin: again.margin });
    Ok(Plan { profile: profile(replay), if_stronger, ..plan.clone() })
}

/// Replays a plan, one connection or joint being so many times as strong as it is.
fn run(
    start: &Linkage,
    goal: &Goal,
    plan: &Plan<Action, Held>,
    required: f64,
    stronger: Option<(Held, f64)>,
) -> Result<Replay<Held, Touched>, Refusal> {
    let assembler = Assembler::new(start);
    let mut checker = Checker::new(start, &assembler, required, stronger);
    let mut state = start.clone();
    state.connections.sort_unstable();

    let mut found = vec![checker.rest(None, &state)?];
    let mut legal = true;
    for (index, planned) in plan.actions.iter().enumerate() {
        match transition(&state, &planned.action) {
            Err(fault) => {
                checker.judge.fail(Some(index), None, fault, None);
                legal = false;
                break;
            }
            Ok(next) => {
                let bottleneck = plan.bottleneck.as_ref().filter(|b| b.action == Some(index)).map(|b| b.phase);
                let claimed: Vec<f64> = planned.phase.into_iter().chain(bottleneck).collect();
                found.push(take(&mut checker, index, &state, &next, &claimed)?);
                state = next.after;
            }
        }
    }
    let actions_replayed = found.len() - 1;
    let moves = plan.actions.iter().filter(|planned| planned.action.is_move()).count();
    claims::check(&mut checker.judge, plan, moves, &found);
    if legal && let Some(fault) = arrival::missing(start, &state, goal) {
        checker.judge.fail(None, None, fault, None);
    }
    let margin = found.iter().map(|f| f.margin).reduce(Bracket::min).expect("the start was checked");
    let Judge { failures, solves, .. } = checker.judge;
    let states = states(&found);
    Ok(Replay { margin, states, actions_replayed, oracle_solves: solves, failures })
}

/// The state after actions, each of which must be legal in the state that it is taken in; forces and collisions play no
/// part. Its modules are where its connections and joints place them, to a micro-degree, however many actions there were.
///
/// # Errors
/// The first action that is not legal, with why.
pub fn after<'a>(start: &Linkage, actions: impl IntoIterator<Item = &'a Action>) -> Result<Linkage, (usize, Fault)> {
    let mut state = start.clone();
    state.connections.sort_unstable();
    for (index, action) in actions.into_iter().enumerate() {
        state = transition(&state, action).map_err(|fault| (index, fault))?.after;
    }
    Ok(State::new(state).linkage().clone())
}

/// Checks one legal action and says what margins it has.
fn take(
    checker: &mut Checker,
    index: usize,
    before: &Linkage,
    next: &Transition,
    claimed: &[f64],
) -> Result<Found<Held>, Refusal> {
    let during = match &next.path {
        Some(path) => Some(checker.transit(index, before, path, claimed)?),
        None => None,
    };
    let rest = checker.rest(Some(index), &next.after)?;
    Ok(during.map_or(rest.clone(), |during| during.followed_by(rest)))
}
