//! `suite/1` to a suite.

use std::time::Duration;

use super::super::codes;
use super::super::findings::{Findings, Place};
use super::super::wire;
use super::decode::decode;
use crate::generate::{Family, GoalKind, Request, Setting};
use crate::reconfigure::Objective;
use crate::suite::{Case, Limits, Planner, Suite};

/// The suite that stands at `place`.
pub(super) fn read(place: &Place<'_>, findings: &mut Findings) -> Option<Suite> {
    let wire: wire::Suite = decode("suite", place, findings)?;
    let cases = wire.case.iter().enumerate();
    let cases: Vec<Case> = cases.map(|(index, wire)| case(wire, &place.key("case").index(index), findings)).collect();
    let limits = &wire.limits;
    Some(Suite {
        name: wire.name.clone(),
        limits: Limits {
            job_time: seconds(limits.job_time_s.0),
            job_bytes: bytes(limits.job_memory_mb),
            total_time: limits.total_time_s.map(|time| seconds(time.0)),
            total_bytes: limits.total_memory_mb.map(bytes),
        },
        cases,
    })
}

/// A time in s; a century at most, which is as good as no limit. One that is below 0 has been found wrong already.
fn seconds(seconds: f64) -> Duration {
    Duration::from_secs_f64(seconds.clamp(0.0, 3.2e9))
}

fn bytes(megabytes: u32) -> u64 {
    u64::from(megabytes) << 20
}

fn case(wire: &wire::SuiteCase, place: &Place<'_>, findings: &mut Findings) -> Case {
    let family = family(wire.family);
    let usual = Request::new(family, 2, 1);
    let case = Case {
        family,
        modules: wire.modules.iter().map(|&modules| modules as usize).collect(),
        seeds: match &wire.seeds {
            wire::Seeds::Count(count) => (1..=u64::from(*count)).collect(),
            wire::Seeds::List(seeds) => seeds.iter().map(|&seed| u64::from(seed)).collect(),
        },
        settings: match &wire.terrain {
            Some(terrain) => terrain.iter().copied().map(setting).collect(),
            None => vec![usual.setting],
        },
        held: wire.held.unwrap_or(usual.held),
        goal: wire.goal.map_or(usual.goal, goal),
        difficulty: wire.difficulty.map(|difficulty| difficulty as usize),
        margin: wire.margin.map_or(usual.margin, |margin| margin.0),
        min_margin: wire.min_margin.map_or(0.0, |margin| margin.0),
        objectives: match &wire.objectives {
            Some(objectives) => objectives.iter().copied().map(objective).collect(),
            None => vec![Objective::Margin],
        },
        planners: wire.planners.iter().copied().map(planner).collect(),
        job_time: wire.job_time_s.map(|time| seconds(time.0)),
        job_bytes: wire.job_memory_mb.map(bytes),
    };
    check(&case, place, findings);
    case
}

/// What a case asks for that cannot be had.
fn check(case: &Case, place: &Place<'_>, findings: &mut Findings) {
    let [least, most] = case.family.sizes();
    for (index, modules) in case.modules.iter().enumerate().filter(|(_, size)| !(least..=most).contains(*size)) {
        let message = format!("there are no problems of {modules} modules in this family");
        let hint = format!("it has problems of {least} to {most}");
        findings.add(&place.key("modules").index(index), codes::OUT_OF_RANGE, message, hint);
    }
    if case.min_margin > case.margin {
        let message = format!("start and goal have a margin of {} at least, less than is required", case.margin);
        let hint = "raise `margin` to `min_margin`, or no plan need exist".to_string();
        findings.add(&place.key("min_margin"), codes::OUT_OF_RANGE, message, hint);
    }
    if case.family != Family::Cubes && case.goal == GoalKind::Grown && case.difficulty.is_some() {
        let message = "how far a grown goal of this family is cannot be chosen";
        findings.add(
            &place.key("difficulty"),
            codes::UNSUPPORTED,
            message,
            "leave it out, or let goals walk".to_string(),
        );
    }
    if case.family != Family::Cubes
        && let Some(index) = case.planners.iter().position(|p| matches!(p, Planner::Primitive | Planner::Decompose))
    {
        let message = "this planner is for cubes only";
        let hint = "choose \"exact\"".to_string();
        findings.add(&place.key("planners").index(index), codes::UNSUPPORTED, message, hint);
    }
}

fn family(wire: wire::RobotFamily) -> Family {
    match wire {
        wire::RobotFamily::Cubes => Family::Cubes,
        wire::RobotFamily::Freesn => Family::Freesn,
        wire::RobotFamily::Rofi => Family::Rofi,
    }
}

fn setting(wire: wire::TerrainKind) -> Setting {
    match wire {
        wire::TerrainKind::Space => Setting::Space,
        wire::TerrainKind::Mounted => Setting::Mounted,
        wire::TerrainKind::Flat => Setting::Flat,
        wire::TerrainKind::Slope => Setting::Slope,
        wire::TerrainKind::Steps => Setting::Steps,
        wire::TerrainKind::Rough => Setting::Rough,
    }
}

fn goal(wire: wire::GoalOrigin) -> GoalKind {
    match wire {
        wire::GoalOrigin::Grown => GoalKind::Grown,
        wire::GoalOrigin::Walk => GoalKind::Walk,
    }
}

fn objective(wire: wire::Objective) -> Objective {
    match wire {
        wire::Objective::Margin => Objective::Margin,
        wire::Objective::Moves => Objective::Moves,
        wire::Objective::Pareto => Objective::Pareto,
    }
}

fn planner(wire: wire::PlannerName) -> Planner {
    match wire {
        wire::PlannerName::Exact => Planner::Exact,
        wire::PlannerName::Decompose => Planner::Decompose,
        wire::PlannerName::Primitive => Planner::Primitive,
        wire::PlannerName::IgnoreStability => Planner::IgnoreStability,
    }
}
