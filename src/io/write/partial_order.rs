//! The partial order of a plan to `partial-order/1`.

use std::fmt;

use petgraph::visit::EdgeRef;

use super::super::partial_order_report::PartialOrderReport;
use super::super::plan_document::{LinkagePlanDocument, PlanDocument};
use super::super::wire::{self, NonNegative, Real};
use super::lattice_plan::LatticePlans;
use super::linkage_plan::LinkagePlans;
use super::sequence::{Family, sequence};
use super::{Unwritable, bracket};
use crate::reconfigure::Plan;
use crate::reconfigure::linkage::assembly::Touched;

pub(super) fn of_lattice(
    document: &PlanDocument,
    report: &PartialOrderReport<'_>,
) -> Result<wire::PartialOrder, Unwritable> {
    wire(&mut LatticePlans::new(document), document.report.plan.as_ref(), report)
}

pub(super) fn of_linkage(
    document: &LinkagePlanDocument,
    report: &PartialOrderReport<'_, Touched>,
) -> Result<wire::PartialOrder, Unwritable> {
    wire(&mut LinkagePlans { problem: &document.problem }, document.report.plan.as_ref(), report)
}

/// Of a plan whose actions `family` writes.
fn wire<F: Family, T: fmt::Display>(
    family: &mut F,
    plan: Option<&Plan<F::Action, F::Connection>>,
    report: &PartialOrderReport<'_, T>,
) -> Result<wire::PartialOrder, Unwritable> {
    let PartialOrderReport { options, order, times } = *report;
    let plan = plan.ok_or_else(|| Unwritable::new("the order of no plan"))?;
    let plan = sequence(family, 0, plan)?;
    let actions = plan.actions.into_iter().enumerate().map(|(index, action)| {
        let incoming = order.graph.edges_directed(petgraph::graph::NodeIndex::new(index), petgraph::Incoming);
        let mut waits_for: Vec<wire::Wait> = incoming
            .map(|edge| wire::Wait { action: edge.source().index() as u64, because: edge.weight().to_string() })
            .collect();
        waits_for.sort_by_key(|wait| wait.action);
        let [begins, ends] = times.spans[index].map(NonNegative);
        wire::OrderedAction { action, waits_for, begins, ends }
    });
    Ok(wire::PartialOrder {
        format: wire::PartialOrderFormat::V1,
        required_margin: Real(options.required),
        margin: bracket(order.margin),
        most_at_once: options.most_at_once as u64,
        complete: order.is_complete,
        actions: actions.collect(),
        makespan: NonNegative(times.makespan),
        one_by_one: NonNegative(times.one_by_one),
        checked: wire::CheckedMoments {
            states: order.checked.states,
            overlaps: order.checked.overlaps,
            by_monotony: order.checked.by_monotony,
            oracle_solves: order.checked.oracle_solves,
        },
    })
}
