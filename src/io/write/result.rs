//! Records of jobs to `result/1`.

use super::super::wire::{self, Bound, NonNegative, Real};
use super::bracket;
use super::outcome::limit;
use super::plan::statistics;
use crate::generate::{Family, GoalKind, Setting};
use crate::reconfigure::Objective;
use crate::suite::{Check, Ending, Job, Planner, Point, Record};

/// What a job found.
pub(super) fn wire(job: &Job, record: &Record) -> wire::JobResult {
    let (ending, stopped_by, because) = match &record.ending {
        Ending::Solved => (wire::JobEnding::Solved, None, None),
        Ending::Impossible => (wire::JobEnding::Impossible, None, None),
        Ending::Stopped(by) => (wire::JobEnding::Stopped, Some(limit(*by)), None),
        Ending::Overran => (wire::JobEnding::Overran, None, None),
        Ending::Crashed(how) => (wire::JobEnding::Crashed, None, Some(how.clone())),
        Ending::Refused(why) => (wire::JobEnding::Refused, None, Some(why.clone())),
    };
    wire::JobResult {
        format: wire::ResultFormat::V1,
        job: record.job.clone(),
        asked: asked(job),
        ending,
        stopped_by,
        because,
        seconds: NonNegative(record.seconds),
        plan: record.found.as_ref().map(|found| wire::FoundPlan {
            moves: found.moves,
            actions: found.actions as u64,
            margin: found.margin.map(bracket),
            optimal: found.optimal,
        }),
        replay: record.check.as_ref().map(replay),
        margin_at_most: bound(record.margin_at_most),
        moves_at_least: at_least(record.moves_at_least),
        trace: record.trace.iter().map(point).collect(),
        statistics: statistics(&record.statistics),
        peak_memory_bytes: record.peak_bytes,
    }
}

/// A moment at which something became known.
pub(super) fn point(point: &Point) -> wire::TracePoint {
    wire::TracePoint {
        seconds: NonNegative(point.seconds),
        margin: point.margin.map(Real),
        moves: point.moves,
        margin_at_most: bound(point.margin_at_most),
        moves_at_least: at_least(point.moves_at_least),
    }
}

fn asked(job: &Job) -> wire::Asked {
    let request = &job.request;
    wire::Asked {
        family: match request.family {
            Family::Cubes => wire::RobotFamily::Cubes,
            Family::Freesn => wire::RobotFamily::Freesn,
            Family::Rofi => wire::RobotFamily::Rofi,
        },
        modules: u32::try_from(request.modules).unwrap_or(u32::MAX),
        seed: request.seed,
        terrain: match request.setting {
            Setting::Space => wire::TerrainKind::Space,
            Setting::Mounted => wire::TerrainKind::Mounted,
            Setting::Flat => wire::TerrainKind::Flat,
            Setting::Slope => wire::TerrainKind::Slope,
            Setting::Steps => wire::TerrainKind::Steps,
            Setting::Rough => wire::TerrainKind::Rough,
        },
        held: request.held,
        goal: match request.goal {
            GoalKind::Grown => wire::GoalOrigin::Grown,
            GoalKind::Walk => wire::GoalOrigin::Walk,
        },
        difficulty: request.difficulty.and_then(|difficulty| u32::try_from(difficulty).ok()),
        margin: Real(request.margin),
        min_margin: Real(job.min_margin),
        objective: match job.objective {
            Objective::Margin => wire::Objective::Margin,
            Objective::Moves => wire::Objective::Moves,
            Objective::Pareto => wire::Objective::Pareto,
        },
        planner: match job.planner {
            Planner::Exact => wire::PlannerName::Exact,
            Planner::Decompose => wire::PlannerName::Decompose,
            Planner::Primitive => wire::PlannerName::Primitive,
            Planner::IgnoreStability => wire::PlannerName::IgnoreStability,
        },
    }
}

fn replay(check: &Check) -> wire::ReplayOf {
    wire::ReplayOf {
        flaw: check.flaw.as_ref().map(|flaw| wire::PlanFlaw {
            action: flaw.action.map(|action| action as u64),
            phase: flaw.phase.map(Real),
            breaks: flaw.breaks,
            what: flaw.what.clone(),
        }),
        margin: bracket(check.margin),
        falls: check.margin.upper == f64::NEG_INFINITY,
        states: check.states,
    }
}

fn bound(value: f64) -> Bound {
    Bound(value.is_finite().then_some(value))
}

fn at_least(moves: u32) -> Option<u32> {
    (moves != u32::MAX).then_some(moves)
}
