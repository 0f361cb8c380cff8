//! An assessment to `check/1`.

use super::super::check_report::CheckReport;
use super::super::document::NamedStructure;
use super::super::wire::{self, Real};
use super::{bracket, gives_way, vector};
use crate::statics::{
    ConnectionState, Distribution, Explanation, FailureLevel, FailureOrder, InSpace, Remaining, SelfStress, Verdict,
};

/// What a margin is found without.
const NOT_ASKED_FOR: [&str; 2] = ["secondary objective", "distribution of stress"];

/// A wire type that takes counts of the same names from a core type, and other fields beside.
macro_rules! counted {
    ($wire:ident, $from:expr, [$($count:ident),* $(,)?] $(, $field:ident: $value:expr)* $(,)?) => {
        wire::$wire { $($count: $from.$count as u64,)* $($field: $value),* }
    };
}

pub(super) fn wire(named: &NamedStructure, report: &CheckReport<'_>) -> wire::Check {
    let CheckReport { assessment, explanation, self_stress, order, seconds } = *report;
    let held = assessment.verdict != Verdict::WholeBodyUnstable;
    let upper = assessment.utilisation.upper;
    let strengths = || {
        let connectors = named.structure.connectors.iter();
        connectors.map(|connector| (connector.name.clone(), Real(connector.strength * upper))).collect()
    };
    let connections = assessment.connections.iter().zip(&named.connections).filter(|_| held);
    let contacts = assessment.contacts.iter().zip(&named.contacts).filter(|_| held);
    wire::Check {
        format: wire::CheckFormat::V1,
        verdict: verdict(assessment.verdict),
        undecided_because: assessment.undecided_because.clone(),
        utilisation: held.then(|| bracket(assessment.utilisation)),
        margin: held.then(|| bracket(assessment.margin())),
        required_strength_n: (held && upper.is_finite()).then(strengths),
        distribution: distribution(assessment.distribution),
        connections: connections
            .enumerate()
            .map(|(i, (state, id))| connection(id, state, assessment.is_at_limit(i)))
            .collect(),
        contacts: contacts
            .map(|(force, id)| wire::CheckedContact { id: id.clone(), force_n: vector(*force) })
            .collect(),
        gives_way: gives_way::wire(named, assessment),
        relies_on_contact_self_stress: self_stress.and_then(SelfStress::is_relied_on),
        order: order.map(|order| ordered(named, order)),
        left_out: counted!(
            LeftOut,
            assessment.left_out,
            [
                fixed_bodies,
                merged_bodies,
                closed_form_connections,
                closed_form_contacts,
                solved_blocks,
                largest_block_bodies
            ]
        ),
        explanation: explanation.map(|explanation| explained(named, explanation, assessment.distribution)),
        seconds: Real(seconds),
    }
}

fn ordered(named: &NamedStructure, order: &FailureOrder) -> wire::Order {
    let ids = |connections: &[usize]| connections.iter().map(|&i| named.connections[i].clone()).collect();
    let level = |level: &FailureLevel| wire::Level {
        utilisation: bracket(level.utilisation),
        connections: ids(&level.connections),
    };
    wire::Order { levels: order.levels.iter().map(level).collect(), idle: ids(&order.idle), open: ids(&order.open) }
}

fn explained(named: &NamedStructure, explanation: &Explanation, shown: Distribution) -> wire::Explanation {
    let margin_only = shown == Distribution::Proof;
    counted!(
        Explanation,
        explanation,
        [
            fixed_bodies,
            merged_bodies,
            unlimited_connections,
            idle_links,
            afloat,
            closed_form_connections,
            closed_form_contacts,
            unloaded_blocks
        ],
        linear: explanation.is_linear(),
        not_asked_for: NOT_ASKED_FOR.iter().filter(|_| margin_only).map(|what| (*what).to_owned()).collect(),
        remaining: explanation.remaining.iter().map(|block| remaining(named, block)).collect(),
    )
}

fn remaining(named: &NamedStructure, block: &Remaining) -> wire::RemainingBlock {
    counted!(
        RemainingBlock,
        block,
        [
            bodies,
            connections,
            contacts,
            chains,
            bodies_in_chains,
            unknown_wrenches,
            equations,
            friction_cones,
            connector_cones,
            inequalities
        ],
        planar: block.is_planar(),
        in_space_because: block.in_space.map(|why| in_space_because(named, why)),
    )
}

/// Why a block is solved in space, in words.
pub fn in_space_because(named: &NamedStructure, why: InSpace) -> String {
    let without_image = |kind: &str, id: &str| {
        format!("{kind} {id} stands askew to the plane, or beside it without its mirror image opposite")
    };
    match why {
        InSpace::NotAskedFor => "planar blocks are solved like all others".to_owned(),
        InSpace::Chains => "its long chains are condensed, which leaves less".to_owned(),
        InSpace::Bodies => "no plane holds all its centres of mass".to_owned(),
        InSpace::Loads => "a load or a preload acts across the plane of its centres of mass".to_owned(),
        InSpace::Connection(i) => without_image("connection", &named.connections[i]),
        InSpace::Contact(i) => without_image("contact", &named.contacts[i]),
    }
}

pub(super) fn verdict(verdict: Verdict) -> wire::Verdict {
    match verdict {
        Verdict::Stable => wire::Verdict::Stable,
        Verdict::InternallyUnstable => wire::Verdict::InternallyUnstable,
        Verdict::WholeBodyUnstable => wire::Verdict::WholeBodyUnstable,
        Verdict::Undecided => wire::Verdict::Undecided,
    }
}

fn distribution(distribution: Distribution) -> wire::Distribution {
    match distribution {
        Distribution::Proof => wire::Distribution::Proof,
        Distribution::Least => wire::Distribution::Least,
        Distribution::LeastExcept { .. } => wire::Distribution::LeastInPart,
    }
}

// A latch that cannot carry a component at all demands an infinite strength for it.
fn connection(id: &str, state: &ConnectionState, at_limit: bool) -> wire::CheckedConnection {
    let finite = |value: f64| (value != f64::INFINITY).then_some(Real(value));
    wire::CheckedConnection {
        id: id.to_string(),
        strength_n: finite(state.strength),
        utilisation: finite(state.utilisation),
        wrench: wire::Wrench { force_n: vector(state.wrench.force), torque_nm: vector(state.wrench.torque) },
        critical: state.critical,
        at_limit,
    }
}
