//! A goal, and what it must have in common with its start.

use std::sync::Arc;

use super::super::codes;
use super::super::document::{LatticeProblem, LinkageProblem, Problem, Resolve};
use super::super::findings::{Document, Findings, Place};
use super::super::form::Form;
use super::super::json::clipped;
use super::super::wire;
use super::configuration::{Draft, Robot, Surroundings, module_names, read_start};
use super::decode::decode;
use super::names::Names;
use super::robots::Compared;
use super::rotation::vector;
use super::{catalogue, environment, lattice, linkage, matching, rofi};
use crate::robot::{self, Configuration, Goal, Matching, Requirement};
use crate::spatial::Vec3;

/// Reads a start and a goal, each of this program's format or of the RoFI platform's; either may be missing because
/// its text could not be parsed.
pub(super) fn read_documents(
    start: Option<&Document<'_>>,
    goal: Option<&Document<'_>>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Problem> {
    let [start_is_own, goal_is_own] =
        [start, goal].map(|document| document.is_none_or(|found| found.form == Form::Own));
    let [start_world, goal_world] =
        [start, goal].map(|document| document.and_then(|document| rofi::parse(document, findings)));
    let robot = match start_is_own {
        true => start.and_then(|start| read_own_start(&start.root(), resolve, findings)),
        false => start_world.and_then(|world| rofi::start(&world, goal_world.as_ref(), findings)).map(Robot::Linkage),
    };
    if goal_is_own {
        let goal = goal.map(Document::root);
        return with_goal(robot, goal.as_ref(), resolve, findings);
    }
    let world = goal_world?;
    match robot {
        Some(Robot::Linkage(start)) => {
            let goal = rofi::goal(&world, &start, findings)?;
            Some(Problem::Linkage(LinkageProblem { start, goal }))
        }
        Some(Robot::Lattice(start)) => {
            let message = format!("the start's catalogue is `{}`", clipped(&start.catalogue.name));
            let hint = "start and goal are robots of one catalogue".to_string();
            findings.add(world.whole.place(), codes::MODULE_TYPES, message, hint);
            None
        }
        // The goal's own problems are told even so.
        None => {
            rofi::start(&world, None, findings);
            None
        }
    }
}

/// Reads a start and a goal of this program's format.
pub(super) fn read_problem(
    start: &Place<'_>,
    goal: &Place<'_>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Problem> {
    let start = read_own_start(start, resolve, findings);
    with_goal(start, Some(goal), resolve, findings)
}

fn read_own_start(place: &Place<'_>, resolve: Resolve<'_>, findings: &mut Findings) -> Option<Robot> {
    if place.key("match").node().is_some() {
        let message = "a start is not compared with anything";
        let hint = "`match` belongs into the goal".to_string();
        findings.add(&place.key("match"), codes::START_AND_GOAL, message, hint);
    }
    read_start(place, resolve, findings, |draft, findings| draft.build(findings))
}

/// Reads the goal of a start, which may be missing after a problem.
fn with_goal(
    start: Option<Robot>,
    goal: Option<&Place<'_>>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Problem> {
    match start {
        Some(Robot::Lattice(start)) => {
            let (configuration, matching) = read_goal(goal?, Some(&start), resolve, findings, lattice::build)?;
            Some(Problem::Lattice(LatticeProblem { start, goal: Goal { configuration, matching } }))
        }
        Some(Robot::Linkage(start)) => {
            let (linkage, matching) = read_goal(goal?, Some(&start), resolve, findings, linkage::build)?;
            Some(Problem::Linkage(LinkageProblem { start, goal: robot::linkage::Goal { linkage, matching } }))
        }
        // The goal's own problems are told even so, whatever robot it is.
        None => {
            let kind = |draft: Draft<'_>, findings: &mut Findings| {
                draft.build(findings);
                None
            };
            goal.and_then(|place| read_goal::<Configuration>(place, None, resolve, findings, kind));
            None
        }
    }
}

/// A goal and how it is compared; its robot is what `build` makes of it.
fn read_goal<R: Compared>(
    place: &Place<'_>,
    start: Option<&R>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
    build: impl FnOnce(Draft<'_>, &mut Findings) -> Option<R>,
) -> Option<(R, Matching)> {
    let wire: wire::Configuration = decode("configuration", place, findings)?;
    let matching = matching_of(wire.matching.as_ref());
    let own = wire.catalogue.as_ref().map(|c| catalogue::referred(c, &place.key("catalogue"), resolve, findings));
    let (own_known, own) = (own != Some(None), own.flatten());
    if !own_known {
        return None;
    }
    let catalogue = match (start, own) {
        (Some(start), Some(own)) => {
            let used = start.catalogue();
            if (&own.connectors, &own.module_types) != (&used.connectors, &used.module_types) {
                differs("catalogue", place, findings);
            }
            Arc::clone(used)
        }
        (Some(start), None) => Arc::clone(start.catalogue()),
        (None, own) => own?,
    };
    let names = module_names(&wire, place, findings);
    let environment =
        environment::environment(wire.environment.as_ref(), &place.key("environment"), resolve, findings)?;
    let surroundings = Surroundings {
        gravity: wire.gravity_m_s2.map_or_else(Vec3::zeros, vector),
        environment: start.filter(|_| wire.environment.is_none()).map_or(environment, |s| s.environment().clone()),
        loads: Vec::new(),
        require: start.map_or_else(Requirement::default, |start| start.require().clone()),
    };
    let goal = build(Draft { wire: &wire, names: &names, catalogue, surroundings, place }, findings)?;
    let start = start?;
    compare_surroundings(&wire, &goal, start, place, findings);
    compare_loads(&wire, start, place, findings);
    let mut goal = matching::in_order_of(start, goal, matching, place, findings)?;
    goal.surround_as(start);
    Some((goal, matching))
}

fn matching_of(wire: Option<&wire::Match>) -> Matching {
    Matching {
        labelled: wire.and_then(|wire| wire.modules) == Some(wire::ModuleMatch::Labelled),
        free_frame: wire.and_then(|wire| wire.frame) == Some(wire::FrameMatch::Free),
    }
}

fn differs(key: &str, place: &Place<'_>, findings: &mut Findings) {
    let hint = "a goal takes it from its start: leave it out here".to_string();
    findings.add(&place.key(key), codes::START_AND_GOAL, "is not what the start says", hint);
}

fn compare_surroundings<R: Compared>(
    wire: &wire::Configuration,
    goal: &R,
    start: &R,
    place: &Place<'_>,
    findings: &mut Findings,
) {
    if wire.gravity_m_s2.is_some() && goal.gravity() != start.gravity() {
        differs("gravity_m_s2", place, findings);
    }
    if wire.environment.is_some() && goal.environment() != start.environment() {
        differs("environment", place, findings);
    }
    if wire.require.is_some() {
        let names = names_of(start, place, findings);
        let own = environment::requirement(wire.require.as_ref(), &names, &place.key("require"), findings);
        if own != *start.require() {
            differs("require", place, findings);
        }
    }
}

/// The start's modules, as a goal calls them.
fn names_of<'a, R: Compared>(start: &'a R, place: &Place<'_>, findings: &mut Findings) -> Names<'a> {
    let ids = (0..start.count()).map(|module| start.id(module)).collect();
    Names::new("modules of the start", ids, |_| place.clone(), findings)
}

/// A goal's loads, if it lists them, must be the start's.
fn compare_loads<R: Compared>(wire: &wire::Configuration, start: &R, place: &Place<'_>, findings: &mut Findings) {
    let Some(list) = &wire.loads else { return };
    let names = names_of(start, place, findings);
    if environment::loads(list, &names, &place.key("loads"), findings) != start.loads() {
        differs("loads", place, findings);
    }
}
