//! Random walks of linkages over admissible states, as [`wander`](crate::reconfigure::wander()) is for lattices.

use crate::reconfigure::refusal::{Refusal, Rejection};
use crate::reconfigure::wander::Walk;
use crate::robot::Matching;
use crate::robot::linkage::{Goal, Linkage};

use super::arrangement::Arrangement;
use super::domain::Domain;
use super::moves::{Step, View};
use super::problem::Problem;
use super::state::State;

/// Walks from `start` by random moves through admissible states, never to an arrangement that it has had: see
/// [`wander`](crate::reconfigure::wander()).
///
/// # Errors
/// [`Refusal`] for data that no robot can have.
pub fn wander(start: &Linkage, moves: usize, choose: &mut dyn FnMut(usize) -> usize) -> Result<Walk<Linkage>, Refusal> {
    let goal = Goal { linkage: start.clone(), matching: Matching::default() };
    let problem = match Problem::new(start, &goal) {
        Ok(problem) => problem,
        Err(Rejection::Refused(refusal)) => return Err(refusal),
        Err(Rejection::Impossible(_)) => return Ok(Walk { end: start.clone(), moves: 0 }),
    };
    let domain = Domain::new(&problem, true);
    let mut run = Run::new(&domain);
    while run.seen.len() <= moves && run.go_on(choose) {}
    match domain.oracle.fault() {
        Some(fault) => Err(Refusal::Structure(fault)),
        None => Ok(Walk { end: run.state.linkage().clone(), moves: run.seen.len() - 1 }),
    }
}

/// A walk and where it has come to.
struct Run<'a> {
    domain: &'a Domain<'a>,
    state: State,
    seen: Vec<Arrangement>,
    /// The start's own modules stand for themselves.
    slots: Vec<usize>,
}

impl<'a> Run<'a> {
    fn new(domain: &'a Domain<'a>) -> Self {
        let mut start = domain.problem.start.clone();
        start.connections = start.touching();
        let here = domain.arrangements.of(&domain.problem.described(&start)).arrangement;
        let slots = (0..start.modules.len()).collect();
        Self { domain, state: State::new(start), seen: vec![here], slots }
    }

    /// Takes one move, if there is one.
    fn go_on(&mut self, choose: &mut dyn FnMut(usize) -> usize) -> bool {
        let view = self.view();
        let leads_to = |step: &Step| self.domain.arrangements.of(&view.after(step)).arrangement;
        let steps = view.steps(self.domain.rules()).into_iter().map(|step| (leads_to(&step), step));
        let mut open: Vec<(Arrangement, Step)> = steps.filter(|(to, _)| !self.seen.contains(to)).collect();
        while !open.is_empty() {
            let (to, step) = open.swap_remove(choose(open.len()));
            if !self.is_admissible(&view, &step) {
                continue;
            }
            let mut next = self.state.clone();
            if self.take(&mut next, &view, &step) {
                self.state = next;
                self.seen.push(to);
                return true;
            }
        }
        false
    }

    /// The robot as it stands.
    fn view(&self) -> View {
        let linkage = self.state.linkage();
        self.domain.problem.view(&self.domain.problem.described(linkage), linkage.connections.clone())
    }

    fn is_admissible(&self, view: &View, step: &Step) -> bool {
        let floor = self.domain.problem.start.require.margin;
        self.domain.is_free(view, step)
            && self.domain.oracle.of_move(view, &self.slots, &view.kept(step), step, floor).margin.lower >= floor
    }

    /// Releases what a move would tear, makes it and engages all that then meets; false where the state that it
    /// leads to is not admissible.
    fn take(&self, state: &mut State, view: &View, step: &Step) -> bool {
        let kept = view.kept(step);
        for connection in state.linkage().connections.clone() {
            if kept.binary_search(&connection).is_err() {
                state.detach(connection);
            }
        }
        let problem = self.domain.problem;
        let released = problem.view(&problem.described(state.linkage()), kept);
        let Some(step) = released.once_released(step, self.domain.rules()) else { return false };
        state.take(&released, &step);
        for connection in state.linkage().touching() {
            if state.linkage().connections.binary_search(&connection).is_err() {
                state.attach(connection);
            }
        }
        let after = problem.view(&problem.described(state.linkage()), Vec::new());
        let settled = self.domain.oracle.of_state(&after, &self.slots, &state.linkage().connections);
        settled.margin.lower >= problem.start.require.margin
    }
}
