//! From a path of the search space to a plan: explicit actions on the start's own modules, ports and joints, each
//! with its margin.
//!
//! A path names arrangements; which of its modules are which is found by following it with the actual ones: among
//! the moves that they have, one leads to the next arrangement, since what looks the same has the same moves.

use crate::reconfigure::plan::{Bottleneck, Plan, PlannedAction};
use crate::reconfigure::worst::{Instant, Worst};
use crate::robot::linkage::Connection;

use super::action::Action;
use super::assembly::Held;
use super::domain::Domain;
use super::moves::{Step, View};
use super::problem::Described;
use super::saturated;
use super::state::State;

/// The plan that follows a path from the start, with the margin of each action.
pub fn compose(domain: &Domain, path: &[saturated::Action]) -> Plan<Action, Held> {
    let mut run = Run::new(domain);
    for action in path {
        run.follow(action);
    }
    run.plan
}

/// A plan in the making, and where it has come to.
struct Run<'a> {
    domain: &'a Domain<'a>,
    state: State,
    /// The start's own modules stand for themselves.
    slots: Vec<usize>,
    plan: Plan<Action, Held>,
}

impl<'a> Run<'a> {
    fn new(domain: &'a Domain<'a>) -> Self {
        let plan = Plan::EMPTY;
        let state = State::new(domain.problem.start.clone());
        let slots = (0..domain.problem.start.modules.len()).collect();
        let mut run = Self { domain, state, slots, plan };
        if domain.stability {
            let worst = run.at_rest();
            run.book(None, &worst);
        }
        run
    }

    fn follow(&mut self, action: &saturated::Action) {
        let described = self.domain.problem.described(self.state.linkage());
        let all = self.state.linkage().touching();
        let view = self.domain.problem.view(&described, all);
        if action.is_arrival() {
            let framed = self.domain.arrangements.of(&described);
            let wanted = self.domain.goal.connections(&view, &framed).expect("the path has arrived at the goal");
            self.engage(&wanted);
            return;
        }
        let (step, during) = self.step(&view, action);
        let kept = view.kept(&step);
        self.engage(&kept);
        let view = self.domain.problem.view(&self.domain.problem.described(self.state.linkage()), kept);
        let step = view.once_released(&step, self.domain.rules()).expect("releasing what is torn leaves the move");
        self.state.take(&view, &step);
        self.note(step.action, during);
    }

    /// The move to the next arrangement, and its margin: of several the one with the largest.
    fn step(&self, view: &View, action: &saturated::Action) -> (Step, Option<Worst<Held>>) {
        let leads_there = |step: &Step| {
            let after: Vec<Described> = view.after(step);
            self.domain.arrangements.of(&after).arrangement == action.to.arrangement && self.domain.is_free(view, step)
        };
        let mut steps = view.steps(self.domain.rules()).into_iter().filter(leads_there);
        if !self.domain.stability {
            return (steps.next().expect("equal arrangements have the same moves"), None);
        }
        let judged = steps.map(|step| {
            let engaged = view.kept(&step);
            let worst = self.domain.oracle.of_move(view, &self.slots, &engaged, &step, f64::NEG_INFINITY);
            (step, Some(worst))
        });
        let lower = |worst: &Option<Worst<Held>>| worst.as_ref().map_or(f64::NEG_INFINITY, |worst| worst.margin.lower);
        judged
            .reduce(|best, next| if lower(&next.1) > lower(&best.1) { next } else { best })
            .expect("equal arrangements have the same moves")
    }

    /// Attaches and then detaches until these connections are engaged.
    fn engage(&mut self, wanted: &[Connection]) {
        let engaged = self.state.linkage().connections.clone();
        let lacks = |set: &[Connection], connection: &Connection| set.binary_search(connection).is_err();
        for &connection in wanted.iter().filter(|connection| lacks(&engaged, connection)) {
            self.state.attach(connection);
            self.note(Action::Attach(connection), None);
        }
        for &connection in engaged.iter().filter(|connection| lacks(wanted, connection)) {
            self.state.detach(connection);
            self.note(Action::Detach(connection), None);
        }
    }

    /// Notes an action that was taken, the states on its way having this worst one.
    fn note(&mut self, action: Action, during: Option<Worst<Held>>) {
        let worst = self.domain.stability.then(|| {
            let rest = self.at_rest();
            during.map_or(rest, |during| during.or_worse(rest))
        });
        if let Some(worst) = &worst {
            self.book(Some(self.plan.actions.len()), worst);
        }
        self.plan.moves += u32::from(action.is_move());
        let phase = worst.map(|worst| phase(worst.instant));
        self.plan.actions.push(PlannedAction { action, margin: worst.map(|worst| worst.margin), phase });
    }

    fn at_rest(&self) -> Worst<Held> {
        let linkage = self.state.linkage();
        let described = self.domain.problem.described(linkage);
        let view = self.domain.problem.view(&described, Vec::new());
        self.domain.oracle.of_state(&view, &self.slots, &linkage.connections)
    }

    /// Books the worst state of an action (`None`: of the start).
    fn book(&mut self, action: Option<usize>, worst: &Worst<Held>) {
        let so_far = self.plan.margin;
        if so_far.is_none_or(|margin| worst.margin.lower < margin.lower) {
            let phase = phase(worst.instant);
            self.plan.bottleneck = Some(Bottleneck { action, phase, connection: worst.weakest });
        }
        self.plan.margin = Some(so_far.map_or(worst.margin, |margin| margin.min(worst.margin)));
    }
}

/// The phase that a plan names for an instant.
fn phase(instant: Instant) -> f64 {
    match instant {
        Instant::Phase(phase) => phase,
        Instant::Rest => 1.0,
    }
}
