//! The saturated space against a search over single actions, which takes nothing from monotony.

use std::sync::Arc;

use planners::{Outcome, Search, Space, Transition, Width};

use crate::reconfigure::linkage::arrangement::{Arrangement, Framed};
use crate::reconfigure::linkage::domain::{Domain, framed, width};
use crate::reconfigure::linkage::goal::bonds;
use crate::reconfigure::linkage::moves::{Step, View};
use crate::reconfigure::linkage::problem::Problem;
use crate::reconfigure::linkage::saturated::Saturated;
use crate::robot::Catalogue;
use crate::robot::linkage::{Connection, Linkage};
use crate::robot::rofi::CELL;
use crate::spatial::Pose;

use super::{goal, module, robot, standing, string};

/// An arrangement and the engaged connections of its modules, sorted.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct State {
    arrangement: Arrangement,
    engaged: Arc<[Connection]>,
}

#[derive(Clone, Debug)]
enum Action {
    Engage,
    Move(Step),
}

struct Primitive<'a> {
    domain: &'a Domain<'a>,
}

impl Primitive<'_> {
    /// The state of a robot with these connections engaged.
    fn state(&self, view: &View, at: &Framed) -> State {
        let all = self.domain.saturated(&at.arrangement);
        let here = bonds(&all, &framed(&at.arrangement));
        let find = |wanted: &super::super::goal::Bond| {
            let index = here.iter().position(|bond| bond.is_at(wanted, 1e-6)).expect("what is engaged meets");
            all.connections[index]
        };
        let mut engaged: Vec<Connection> = bonds(view, at).iter().map(find).collect();
        engaged.sort_unstable();
        State { arrangement: at.arrangement.clone(), engaged: engaged.into() }
    }

    fn of_linkage(&self, linkage: &Linkage, described: &[super::super::problem::Described]) -> State {
        let view = self.domain.problem.view(described, linkage.connections.clone());
        self.state(&view, &self.domain.arrangements.of(described))
    }

    fn view(&self, state: &State) -> View {
        View { connections: state.engaged.to_vec(), ..self.domain.saturated(&state.arrangement) }
    }
}

impl Space for Primitive<'_> {
    type State = State;
    type Action = Action;

    fn start(&self) -> State {
        let problem = self.domain.problem;
        self.of_linkage(&problem.start, &problem.described(&problem.start))
    }

    fn is_goal(&self, state: &State) -> bool {
        let problem = self.domain.problem;
        *state == self.of_linkage(&problem.goal, &problem.wanted())
    }

    fn transitions(&self, from: &State) -> Vec<Transition<State, Action>> {
        let all = self.domain.saturated(&from.arrangement);
        let view = self.view(from);
        let mut transitions = Vec::new();
        for &connection in &all.connections {
            let mut engaged: Vec<Connection> = from.engaged.to_vec();
            match engaged.binary_search(&connection) {
                Ok(at) => _ = engaged.remove(at),
                Err(at) => engaged.insert(at, connection),
            }
            if self.domain.is_connected(&view, &engaged) {
                let to = State { arrangement: from.arrangement.clone(), engaged: engaged.into() };
                transitions.push(Transition { action: Action::Engage, to, cost: 0, width_at_most: f64::INFINITY });
            }
        }
        for step in view.steps(self.domain.rules()) {
            if view.kept(&step) == view.connections && self.domain.is_free(&view, &step) {
                let after = view.after(&step);
                let moved = self.domain.problem.view(&after, view.connections.clone());
                let to = self.state(&moved, &self.domain.arrangements.of(&after));
                transitions.push(Transition { action: Action::Move(step), to, cost: 1, width_at_most: f64::INFINITY });
            }
        }
        transitions
    }

    fn certify(&self, from: &State, action: &Action, to: &State, floor: f64) -> Width {
        let rest = width(self.domain.of_state(&self.view(to), &to.engaged).margin);
        match action {
            Action::Engage => rest,
            Action::Move(step) => width(self.domain.of_move(&self.view(from), step, floor).margin).in_series(rest),
        }
    }

    fn remaining_cost(&self, _: &State) -> Option<u32> {
        Some(0)
    }
}

/// Solves a problem in both spaces.
fn agree(start: &Linkage, end: &Linkage) {
    let problem = Problem::new(start, &goal(end.clone())).expect("sound");
    let domain = Domain::new(&problem, true);
    let options = planners::Options::default();
    let primitive = Primitive { domain: &domain };
    let saturated = Saturated::new(&domain, Width::UNLIMITED, f64::INFINITY);
    let single = Search::new(&primitive, options.clone()).margin(f64::NEG_INFINITY);
    let whole = Search::new(&saturated, options).margin(f64::NEG_INFINITY);
    let (Outcome::Solved { found: single, .. }, Outcome::Solved { found: whole, .. }) = (single, whole) else {
        panic!("both find a plan");
    };
    let close = |a: f64, b: f64| a == b || (a - b).abs() <= 1e-5 * a.abs().max(1.0);
    assert!(close(single.width.lower, whole.width.lower), "{} {}", single.width.lower, whole.width.lower);
    assert_eq!(single.cost, whole.cost);
}

#[test]
fn single_actions_do_no_better_with_a_strut() {
    let robot = |azimuth| standing(string(&[[azimuth, 90, 0]]), None);
    agree(&robot(0), &robot(90));
}

#[test]
fn single_actions_do_no_better_where_a_loop_must_open() {
    // Two modules side by side, docked twice: whatever turns, a dock must be released.
    let catalogue = Catalogue::rofi();
    let modules = [0.0, CELL]
        .into_iter()
        .enumerate()
        .map(|(id, x)| module(&catalogue, "universal", id, Pose::translation(x, 0.0, 0.0), &[0, 0, 0]));
    let modules = modules.collect();
    let start = standing(robot(catalogue, modules), None);
    assert_eq!(start.connections.len(), 2);
    let problem = Problem::new(&start, &goal(start.clone())).expect("sound");
    let view = problem.view(&problem.described(&start), start.connections.clone());
    let domain = Domain::new(&problem, true);
    let step = view.steps(domain.rules()).into_iter().find(|step| domain.is_free(&view, step)).expect("a move");
    assert!(view.kept(&step).len() < 2);
    let mut end = start.clone();
    for (module, (_, pose, joints)) in end.modules.iter_mut().zip(view.after(&step)) {
        (module.pose, module.joints) = (pose, joints.to_vec());
    }
    end.connections = end.touching();
    agree(&start, &end);
}
