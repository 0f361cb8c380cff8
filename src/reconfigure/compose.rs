//! From a path of a search space to a plan: explicit actions on modules, each
//! with its margin.

use crate::robot::{Configuration, FaceConnection, Port};

use super::domain::{Domain, bonds_after};
use super::layout::{Bond, Layout};
use super::oracle::{Instant, Seam, Worst};
use super::plan::{Bottleneck, Plan, PlannedAction};
use super::problem::{Problem, module_at};
use super::saturated::{self, kept};
use super::step::Step;

/// The primitive steps of a path of the saturated space.
///
/// Between two moves it goes straight from the connections after the first to
/// those that the second needs, attaching before detaching: every state on
/// the way has all connections of one of the two ends, so none is worse than both.
pub fn expand(problem: &Problem, path: &[saturated::Action]) -> Vec<Step> {
    let (mut layout, mut bonds) = (problem.start_layout().clone(), problem.start_bonds().to_vec());
    let mut steps = Vec::new();
    for action in path {
        let wanted = match *action {
            saturated::Action::Move(step) => kept(&layout, step),
            saturated::Action::Finish(arrival) => problem.goal().bonds(arrival),
        };
        let lacks = |set: &[Bond], bond: &Bond| set.binary_search(bond).is_err();
        steps.extend(wanted.iter().copied().filter(|bond| lacks(&bonds, bond)).map(Step::Attach));
        steps.extend(bonds.iter().copied().filter(|bond| lacks(&wanted, bond)).map(Step::Detach));
        bonds = wanted;
        if let saturated::Action::Move(step) = *action {
            steps.push(Step::Move(step));
            bonds = bonds_after(&layout, &bonds, step);
            layout = step.applied(&layout, false);
        }
    }
    steps
}

/// The plan that takes these steps from the start, with the margin of each.
pub fn compose(domain: &Domain, steps: &[Step]) -> Plan {
    let mut run = Run::new(domain);
    for &step in steps {
        run.take(step);
    }
    run.plan
}

/// A plan in the making, and where it has come to.
struct Run<'a> {
    domain: &'a Domain<'a>,
    configuration: Configuration,
    layout: Layout,
    bonds: Vec<Bond>,
    plan: Plan,
}

impl<'a> Run<'a> {
    fn new(domain: &'a Domain<'a>) -> Self {
        let problem = domain.problem;
        let plan = Plan::EMPTY;
        let (layout, bonds) = (problem.start_layout().clone(), problem.start_bonds().to_vec());
        let mut run = Self { domain, configuration: problem.start().clone(), layout, bonds, plan };
        if domain.stability {
            let worst = domain.of_state(&run.layout, &run.bonds);
            run.book(None, &worst, &run.configuration.clone());
        }
        run
    }

    fn take(&mut self, step: Step) {
        let before = self.configuration.clone();
        let Some(action) = step.action(&before) else { unreachable!("a path takes steps that its states have") };
        step.apply(&mut self.configuration);
        let (layout, bonds) = self.next(step);
        let worst = self.domain.stability.then(|| match step {
            Step::Move(step) => self.domain.of_move(&self.layout, &self.bonds, step, f64::NEG_INFINITY),
            Step::Attach(_) | Step::Detach(_) => self.domain.of_state(&layout, &bonds),
        });
        if let Some(worst) = &worst {
            self.book(Some(self.plan.actions.len()), worst, &before);
        }
        (self.layout, self.bonds) = (layout, bonds);
        self.plan.moves += u32::from(action.is_move());
        let phase = worst.map(|worst| phase(worst.instant));
        self.plan.actions.push(PlannedAction { action, margin: worst.map(|worst| worst.margin), phase });
    }

    fn next(&self, step: Step) -> (Layout, Vec<Bond>) {
        match step {
            Step::Attach(bond) => {
                let mut bonds: Vec<Bond> = self.bonds.iter().copied().chain([bond]).collect();
                bonds.sort_unstable();
                (self.layout.clone(), bonds)
            }
            Step::Detach(bond) => {
                (self.layout.clone(), self.bonds.iter().copied().filter(|&other| other != bond).collect())
            }
            Step::Move(step) => (self.domain.after(&self.layout, step), bonds_after(&self.layout, &self.bonds, step)),
        }
    }

    /// Books the worst state of an action (`None`: of the start).
    fn book(&mut self, action: Option<usize>, worst: &Worst, before: &Configuration) {
        let so_far = self.plan.margin;
        if so_far.is_none_or(|margin| worst.margin.lower < margin.lower) {
            let modules = match worst.instant {
                Instant::Phase(_) => before,
                Instant::Rest => &self.configuration,
            };
            let connection = worst.weakest.and_then(|seam| ports(modules, seam));
            self.plan.bottleneck = Some(Bottleneck { action, phase: phase(worst.instant), connection });
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

/// The ports of two modules that hold each other.
pub fn ports(configuration: &Configuration, seam: Seam) -> Option<FaceConnection> {
    let port = |cell, towards| {
        let module = module_at(configuration, cell)?;
        Some(Port { module, face: configuration.modules[module].face_towards(towards) })
    };
    Some(FaceConnection::new(port(seam.cells[0], seam.towards)?, port(seam.cells[1], seam.towards.opposite())?))
}
