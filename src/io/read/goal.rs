//! A goal, and what it must have in common with its start.

use std::sync::Arc;

use super::super::codes;
use super::super::document::{Problem, Resolve};
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::configuration::{Surroundings, build, module_names, read_start};
use super::decode::decode;
use super::names::Names;
use super::rotation::vector;
use super::{catalogue, environment, matching};
use crate::robot::{Configuration, Goal, Matching, Requirement};
use crate::spatial::Vec3;

/// Reads a start and a goal; either may be missing because its text was no JSON.
pub(super) fn read_problem(
    start: Option<&Place<'_>>,
    goal: Option<&Place<'_>>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Problem> {
    let start = start.and_then(|place| {
        if place.key("match").node().is_some() {
            let message = "a start is not compared with anything";
            findings.add(
                &place.key("match"),
                codes::START_AND_GOAL,
                message,
                "`match` belongs into the goal".to_string(),
            );
        }
        read_start(place, resolve, findings)
    });
    let goal = goal.and_then(|place| read_goal(place, start.as_ref(), resolve, findings));
    Some(Problem { start: start?, goal: goal? })
}

fn read_goal(
    place: &Place<'_>,
    start: Option<&Configuration>,
    resolve: Resolve<'_>,
    findings: &mut Findings,
) -> Option<Goal> {
    let wire: wire::Configuration = decode("configuration", place, findings)?;
    let matching = matching_of(wire.matching.as_ref());
    let own = wire.catalogue.as_ref().map(|c| catalogue::referred(c, &place.key("catalogue"), resolve, findings));
    let (own_known, own) = (own != Some(None), own.flatten());
    if !own_known {
        return None;
    }
    let catalogue = match (start, own) {
        (Some(start), Some(own)) => {
            if (&own.connectors, &own.module_types) != (&start.catalogue.connectors, &start.catalogue.module_types) {
                differs("catalogue", place, findings);
            }
            Arc::clone(&start.catalogue)
        }
        (Some(start), None) => Arc::clone(&start.catalogue),
        (None, own) => own?,
    };
    let names = module_names(&wire, place, findings);
    let mut configuration = {
        let environment =
            environment::environment(wire.environment.as_ref(), &place.key("environment"), resolve, findings)?;
        let surroundings = Surroundings {
            gravity: wire.gravity_m_s2.map_or_else(Vec3::zeros, vector),
            environment: start.filter(|_| wire.environment.is_none()).map_or(environment, |s| s.environment.clone()),
            loads: Vec::new(),
            require: start.map_or_else(Requirement::default, |start| start.require.clone()),
        };
        build(&wire, &names, catalogue, surroundings, place, findings)?
    };
    let start = start?;
    compare_surroundings(&wire, &configuration, start, place, findings);
    compare_loads(&wire, start, place, findings);
    configuration = matching::in_order_of(start, configuration, matching, place, findings)?;
    configuration.gravity = start.gravity;
    configuration.environment = start.environment.clone();
    configuration.loads = start.loads.clone();
    Some(Goal { configuration, matching })
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

fn compare_surroundings(
    wire: &wire::Configuration,
    goal: &Configuration,
    start: &Configuration,
    place: &Place<'_>,
    findings: &mut Findings,
) {
    if wire.gravity_m_s2.is_some() && goal.gravity != start.gravity {
        differs("gravity_m_s2", place, findings);
    }
    if wire.environment.is_some() && goal.environment != start.environment {
        differs("environment", place, findings);
    }
    if wire.require.is_some() && environment::requirement(wire.require.as_ref()) != start.require {
        differs("require", place, findings);
    }
}

/// A goal's loads, if it lists them, must be the start's.
fn compare_loads(wire: &wire::Configuration, start: &Configuration, place: &Place<'_>, findings: &mut Findings) {
    let Some(list) = &wire.loads else { return };
    let ids = start.modules.iter().map(|module| module.id.as_str()).collect();
    let names = Names::new("modules of the start", ids, |_| place.clone(), findings);
    if environment::loads(list, &names, &place.key("loads"), findings) != start.loads {
        differs("loads", place, findings);
    }
}
