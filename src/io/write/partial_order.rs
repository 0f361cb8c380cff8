//! The partial order of a plan to `partial-order/1`.

use petgraph::visit::EdgeRef;

use super::super::partial_order_report::PartialOrderReport;
use super::super::plan_document::PlanDocument;
use super::super::wire::{self, NonNegative, Real};
use super::lattice_plan::LatticePlans;
use super::sequence::sequence;
use super::{Unwritable, bracket};

pub(super) fn wire(document: &PlanDocument, report: &PartialOrderReport<'_>) -> Result<wire::PartialOrder, Unwritable> {
    let PartialOrderReport { options, order, times } = *report;
    let plan = document.report.plan.as_ref().ok_or_else(|| Unwritable::new("the order of no plan"))?;
    let plan = sequence(&mut LatticePlans::new(document), 0, plan)?;
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
