//! An assessment to `check/1`.

use super::super::document::NamedStructure;
use super::super::wire::{self, Real};
use super::{bracket, vector};
use crate::statics::{Assessment, ConnectionState, Distribution, Explanation, InSpace, Remaining, Verdict};

/// What a margin is found without.
const NOT_ASKED_FOR: [&str; 2] = ["secondary objective", "distribution of stress"];

pub(super) fn wire(
    named: &NamedStructure,
    assessment: &Assessment,
    explanation: Option<&Explanation>,
    seconds: f64,
) -> wire::Check {
    let held = assessment.verdict != Verdict::WholeBodyUnstable;
    let (upper, left_out) = (assessment.utilisation.upper, &assessment.left_out);
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
        left_out: wire::LeftOut {
            fixed_bodies: left_out.fixed_bodies as u64,
            merged_bodies: left_out.merged_bodies as u64,
            closed_form_connections: left_out.closed_form_connections as u64,
            closed_form_contacts: left_out.closed_form_contacts as u64,
            solved_blocks: left_out.solved_blocks as u64,
            largest_block_bodies: left_out.largest_block_bodies as u64,
        },
        explanation: explanation.map(|explanation| explained(named, explanation)),
        seconds: Real(seconds),
    }
}

fn explained(named: &NamedStructure, explanation: &Explanation) -> wire::Explanation {
    wire::Explanation {
        fixed_bodies: explanation.fixed_bodies as u64,
        merged_bodies: explanation.merged_bodies as u64,
        unlimited_connections: explanation.unlimited_connections as u64,
        idle_links: explanation.idle_links as u64,
        afloat: explanation.afloat as u64,
        closed_form_connections: explanation.closed_form_connections as u64,
        closed_form_contacts: explanation.closed_form_contacts as u64,
        unloaded_blocks: explanation.unloaded_blocks as u64,
        linear: explanation.is_linear(),
        not_asked_for: NOT_ASKED_FOR.map(str::to_owned).to_vec(),
        remaining: explanation.remaining.iter().map(|block| remaining(named, block)).collect(),
    }
}

fn remaining(named: &NamedStructure, block: &Remaining) -> wire::RemainingBlock {
    wire::RemainingBlock {
        bodies: block.bodies as u64,
        connections: block.connections as u64,
        contacts: block.contacts as u64,
        chains: block.chains as u64,
        bodies_in_chains: block.bodies_in_chains as u64,
        unknown_wrenches: block.unknown_wrenches as u64,
        equations: block.equations as u64,
        planar: block.is_planar(),
        in_space_because: block.in_space.map(|why| in_space_because(named, why)),
        friction_cones: block.friction_cones as u64,
        connector_cones: block.connector_cones as u64,
        inequalities: block.inequalities as u64,
    }
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
