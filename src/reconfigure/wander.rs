//! Random walks over admissible states: whatever a walk reaches, some plan reaches.
//!
//! Draws no random numbers itself: a closure of the caller chooses.

use crate::robot::{Configuration, Goal, Matching};

use super::domain::Domain;
use super::layout::Layout;
use super::moves::Move;
use super::problem::Problem;
use super::refusal::{Refusal, Rejection};
use super::saturated::{self, kept};
use super::step::Step;

/// Where a walk came to.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk<R> {
    /// The robot at its end, with every possible connection engaged.
    pub end: R,
    /// How many moves it took: fewer than asked for where every further one is inadmissible or leads back.
    pub moves: usize,
}

/// Walks from `start`, all possible connections engaged, by random moves through states whose margins are all proved
/// to be at least what the start requires, never to a placement that it has had.
///
/// `choose(n)` is asked for a number below n. What is returned depends on its answers alone, and a
/// walk of more moves begins with the shorter one.
///
/// # Errors
/// [`Refusal`] for data that no robot can have.
pub fn wander(
    start: &Configuration,
    moves: usize,
    choose: &mut dyn FnMut(usize) -> usize,
) -> Result<Walk<Configuration>, Refusal> {
    let goal = Goal { configuration: start.clone(), matching: Matching::default() };
    let problem = match Problem::new(start, &goal) {
        Ok(problem) => problem,
        Err(Rejection::Refused(refusal)) => return Err(refusal),
        Err(Rejection::Impossible(_)) => return Ok(Walk { end: start.clone(), moves: 0 }),
    };
    let domain = Domain::new(&problem, true);
    let floor = start.require.margin;
    let mut seen = vec![problem.start_layout().clone()];
    let mut end = start.clone();
    while seen.len() <= moves {
        let here = seen.last().expect("the start at least");
        let mut open: Vec<(Move, Layout)> = domain
            .moves(here)
            .into_iter()
            .map(|step| (step, domain.after(here, step)))
            .filter(|(_, after)| !seen.contains(after))
            .collect();
        let taken = loop {
            if open.is_empty() {
                break None;
            }
            let (step, after) = open.swap_remove(choose(open.len()));
            if is_admissible(&domain, here, step, &after, floor) {
                break Some((step, after));
            }
        };
        let Some((step, after)) = taken else { break };
        Step::Move(step).apply(&mut end);
        seen.push(after);
    }
    end.connections = end.touching_connections();
    match domain.oracle.fault() {
        Some(fault) => Err(Refusal::Structure(fault)),
        None => Ok(Walk { end, moves: seen.len() - 1 }),
    }
}

/// Whether a move out of a state with everything engaged keeps the margin, and so does the state that it leads to.
fn is_admissible(domain: &Domain, here: &Layout, step: Move, after: &Layout, floor: f64) -> bool {
    let bonds = kept(here, step);
    domain.is_connected(here, &bonds)
        && domain.stays_connected(here, &bonds, step)
        && domain.of_state(after, &after.touching()).margin.lower >= floor
        && saturated::of_move(domain, here, step, floor).margin.lower >= floor
}
