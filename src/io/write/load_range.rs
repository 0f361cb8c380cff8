//! The range of a force to `load-range/1`.

use super::super::document::NamedStructure;
use super::super::load_range_report::LoadRangeReport;
use super::super::wire::{self, Real};
use super::{bracket, check, gives_way, vector};
use crate::statics::{Assessment, LoadRange, RangeEnd, Verdict};

pub(super) fn wire(named: &NamedStructure, report: &LoadRangeReport<'_>) -> wire::LoadRange {
    let LoadRangeReport { force, range, margin, seconds } = *report;
    let at = force.at.unwrap_or(named.structure.bodies[force.body].com);
    let mut wire = wire::LoadRange {
        format: wire::LoadRangeFormat::V1,
        body: named.bodies[force.body].clone(),
        direction: vector(force.direction.normalize()),
        at_m: vector(at),
        margin: Real(margin),
        outcome: wire::RangeOutcome::Undecided,
        lowest: None,
        highest: None,
        stands_without: range.contains(0.0),
        least_utilisation: None,
        gives_way: None,
        undecided_because: None,
        seconds: Real(seconds),
    };
    match range {
        LoadRange::Between { lowest, highest } => {
            let known = lowest.is_decided() && highest.is_decided();
            wire.outcome = if known { wire::RangeOutcome::Range } else { wire::RangeOutcome::RoughRange };
            (wire.lowest, wire.highest) = (Some(end(named, lowest)), Some(end(named, highest)));
        }
        LoadRange::Nowhere { best } => {
            wire.outcome = wire::RangeOutcome::Nowhere;
            let held = best.verdict != Verdict::WholeBodyUnstable;
            wire.least_utilisation = held.then(|| bracket(best.utilisation));
            wire.gives_way = Some(gives_way::wire(named, best));
        }
        LoadRange::Undecided { because } => wire.undecided_because = Some(because.clone()),
    }
    wire
}

fn end(named: &NamedStructure, end: &RangeEnd) -> wire::RangeEnd {
    let fails = |beyond: &Assessment| wire::Failure {
        verdict: check::verdict(beyond.verdict),
        gives_way: gives_way::wire(named, beyond),
    };
    wire::RangeEnd {
        force_n: bracket(end.force),
        unlimited: end.is_unlimited(),
        fails: end.beyond.as_deref().map(fails),
    }
}
