//! From carries to a plan, with what was proved of every action.

use crate::reconfigure::compose::{expand, ports};
use crate::reconfigure::domain::Domain;
use crate::reconfigure::layout::{Layout, displaced};
use crate::reconfigure::moves::Move;
use crate::reconfigure::oracle::{Seam, Worst};
use crate::reconfigure::plan::{Bottleneck, Plan, PlannedAction};
use crate::reconfigure::replay::claims;
use crate::reconfigure::saturated;
use crate::reconfigure::step::Step;
use crate::robot::{Cell, Configuration, Face};
use crate::statics::Bracket;

use super::builder::Carry;
use super::ways::Ways;

/// Margins of the start and of the goal as it is written, where they are known.
#[derive(Clone, Copy, Debug)]
pub struct Ends {
    /// Of the start.
    pub start: Option<Worst>,
    /// Of the goal.
    pub goal: Option<Worst>,
}

impl Ends {
    /// No plan has a larger margin.
    pub fn at_most(&self) -> f64 {
        let uppers = [self.start, self.goal].into_iter().flatten().map(|worst| worst.margin.upper);
        uppers.fold(f64::INFINITY, f64::min)
    }
}

/// What is known of a move and the states at rest before and after it.
struct Proved {
    margin: Bracket,
    phase: f64,
    /// The cell of the module that holds the moving one, where that decides.
    weakest: Option<Cell>,
}

/// The plan that carries these modules and then releases what the goal does not connect.
pub fn write(domain: &Domain, ways: &mut Ways, carries: &[Carry], ends: &Ends) -> Plan {
    let problem = domain.problem;
    let mut layout = problem.start_layout().clone();
    let mut path = Vec::new();
    let mut proved = Vec::new();
    for carry in carries {
        for &step in &carry.path {
            proved.push(prove(domain, ways, &layout, step, carry.margin));
            path.push(saturated::Action::Move(step));
            layout = step.applied(&layout, false);
        }
    }
    let arrival = problem.goal().arrival(&layout);
    path.extend(arrival.map(saturated::Action::Finish));
    let arrived = arrival.filter(|_| domain.stability).map(|arrival| {
        let elsewhere = || domain.of_state(&layout, &problem.goal().bonds(arrival));
        ends.goal.unwrap_or_else(elsewhere)
    });
    let at_the_end = arrived.map_or(f64::NEG_INFINITY, |worst| worst.margin.lower);

    let mut configuration = problem.start().clone();
    let start = ends.start.filter(|_| domain.stability).map(|worst| worst.margin);
    let at_rest = |action: Option<usize>, worst: Option<Worst>, configuration: &Configuration| Bottleneck {
        action,
        phase: 1.0,
        connection: worst.and_then(|worst| worst.weakest).and_then(|seam| ports(configuration, seam)),
    };
    let at_start = start.map(|_| at_rest(None, ends.start, &configuration));
    let bottleneck = at_start.clone();
    let mut plan =
        Plan { margin: start, moves: 0, bottleneck, actions: Vec::new(), profile: Vec::new(), if_stronger: None };
    let steps = expand(problem, &path);
    let last = steps.len().saturating_sub(1);
    let mut before = start.map_or(f64::NEG_INFINITY, |margin| margin.lower);
    for (index, step) in steps.into_iter().enumerate() {
        let action = step.action(&configuration).expect("a path takes steps that its states have");
        let (mut margin, mut phase, weakest) = match step {
            Step::Move(_) => {
                let Proved { margin, phase, weakest } = &proved[plan.moves as usize];
                before = margin.lower;
                plan.moves += 1;
                (*margin, *phase, *weakest)
            }
            // Between two moves every state has all connections of one of the two ends.
            Step::Attach(_) | Step::Detach(_) => {
                let after = proved.get(plan.moves as usize).map_or(at_the_end, |next| next.margin.lower);
                (Bracket::new(before.min(after), 1.0), 1.0, None)
            }
        };
        if let Some(arrived) = arrived.filter(|_| index == last) {
            // The goal itself bounds it from above, and where it does not reach that, nothing says when it is least.
            margin.upper = margin.upper.min(arrived.margin.upper).max(margin.lower);
            phase = 1.0;
        }
        if let Some(so_far) = plan.margin {
            if margin.lower < so_far.lower {
                let connection = weakest.and_then(|holder| held(&configuration, step, holder));
                plan.bottleneck = Some(Bottleneck { action: Some(plan.actions.len()), phase, connection });
            }
            plan.margin = Some(so_far.min(margin));
        }
        step.apply(&mut configuration);
        let known = plan.margin.is_some();
        plan.actions.push(PlannedAction { action, margin: known.then_some(margin), phase: known.then_some(phase) });
    }
    // Only the two ends have values. Where one of them is all that the bounds leave of the plan's margin, it is
    // attained there, and not where a bound is as low.
    if let (Some(margin), Some(start), Some(arrived), Some(last)) =
        (plan.margin, start, arrived, plan.actions.len().checked_sub(1))
        && claims::bound(&margin, false).is_none()
    {
        let is_start = start.upper <= arrived.margin.upper;
        plan.bottleneck = if is_start { at_start } else { Some(at_rest(Some(last), Some(arrived), &configuration)) };
    }
    plan
}

/// What is known of a move out of a layout with all else connected; `carried` is the margin of the others.
fn prove(domain: &Domain, ways: &mut Ways, layout: &Layout, step: Move, carried: f64) -> Proved {
    let unknown = |least| Proved { margin: Bracket::new(least, 1.0), phase: 1.0, weakest: None };
    if !domain.stability {
        return unknown(carried);
    }
    let mover = layout.placed()[layout.at(step.from).expect("a move has a module")];
    let rest = Layout::new(layout.placed().iter().copied().filter(|placed| placed.cell != step.from).collect());
    let Some(way) = ways.of(&rest, mover.class, step) else { return unknown(f64::NEG_INFINITY) };
    let weakest = (way.margin.lower <= carried).then(|| displaced(way.weakest, step.from));
    Proved { margin: Bracket::new(way.margin.lower.min(carried), 1.0), phase: way.phase, weakest }
}

/// The faces by which `holder` holds the module that moves.
fn held(configuration: &Configuration, step: Step, holder: Cell) -> Option<crate::robot::FaceConnection> {
    let Step::Move(step) = step else { return None };
    let towards = Face::from_step(std::array::from_fn(|i| step.from[i] - holder[i]))?;
    ports(configuration, Seam { cells: [holder, step.from], towards })
}
