//! `check/1`: what the oracle says of one structure.

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::gives_way::GivesWay;
use super::number::Real;
use super::plan::Bracket;

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub(crate) enum CheckFormat {
    /// The first version.
    #[serde(rename = "check/1")]
    V1,
}

/// What the oracle says of one structure. SI units.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Check {
    /// Name and version of the format.
    pub(crate) format: CheckFormat,
    /// What is proved.
    pub(crate) verdict: Verdict,
    /// Why nothing is proved, for an undecided verdict.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) undecided_because: Option<String>,
    /// Smallest common factor on all rated strengths with which it stands; null when whole-body-unstable.
    pub(crate) utilisation: Option<Bracket>,
    /// 1 less the utilisation; null when whole-body-unstable.
    pub(crate) margin: Option<Bracket>,
    /// Strength by connector with which it is proved to stand; null when none is known.
    pub(crate) required_strength_n: Option<IndexMap<String, Real>>,
    /// Which of the states with this utilisation is shown.
    pub(crate) distribution: Distribution,
    /// The connections in one state with this utilisation; empty when whole-body-unstable.
    pub(crate) connections: Vec<CheckedConnection>,
    /// The contacts in that state; empty when whole-body-unstable.
    pub(crate) contacts: Vec<CheckedContact>,
    /// What would move if it gave way: the mechanism that proves the utilisation from below, or the motion
    /// that no strength prevents.
    pub(crate) gives_way: GivesWay,
    /// Whether it stands only by contacts that press on each other though nothing makes them; null when it is
    /// not stable, or when that was not found out.
    pub(crate) relies_on_contact_self_stress: Option<bool>,
    /// The order in which connections would give way; with `--order`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) order: Option<Order>,
    /// What needed no optimisation.
    pub(crate) left_out: LeftOut,
    /// The same in detail, and what remained; with `--explain`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) explanation: Option<Explanation>,
    /// Wall-clock time in s.
    pub(crate) seconds: Real,
}

/// What is proved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Verdict {
    /// Every connection can hold.
    Stable,
    /// Some connection must break.
    InternallyUnstable,
    /// No connection strength helps: it tips, slides or falls.
    WholeBodyUnstable,
    /// Neither could be proved.
    Undecided,
}

/// Which of the states with one utilisation is shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Distribution {
    /// The one that proved the utilisation.
    Proof,
    /// The one with the least sum of the connections' strengths and the contacts' normal forces.
    Least,
    /// The same, except that some parts show what proved the utilisation.
    LeastInPart,
}

/// A connection in the returned state.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CheckedConnection {
    /// Its name.
    pub(crate) id: String,
    /// Strength that it must provide; null when no strength suffices.
    pub(crate) strength_n: Option<Real>,
    /// That strength over the rated one; null when no strength suffices.
    pub(crate) utilisation: Option<Real>,
    /// Wrench on the child, at the connection point, in the connection frame.
    pub(crate) wrench: Wrench,
    /// Whether it breaks in the collapse mechanism.
    pub(crate) critical: bool,
    /// Whether it is as loaded as the utilisation without being critical: another state may spare it.
    pub(crate) at_limit: bool,
}

/// A force and a torque.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Wrench {
    /// Force.
    pub(crate) force_n: [Real; 3],
    /// Torque.
    pub(crate) torque_nm: [Real; 3],
}

/// A contact in the returned state.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CheckedContact {
    /// Its name.
    pub(crate) id: String,
    /// Force on its `body`, in the world frame.
    pub(crate) force_n: [Real; 3],
}

/// The order in which connections would give way.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Order {
    /// The most loaded first, each once those before it have what they need.
    pub(crate) levels: Vec<Level>,
    /// Connections that nothing has to flow through then.
    pub(crate) idle: Vec<String>,
    /// Connections whose level was not asked for, or could not be proved.
    pub(crate) open: Vec<String>,
}

/// Connections that would give way together.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Level {
    /// What they need at least.
    pub(crate) utilisation: Bracket,
    /// Their names.
    pub(crate) connections: Vec<String>,
}

/// What needed no optimisation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LeftOut {
    /// Fixed bodies, which need no balance.
    pub(crate) fixed_bodies: u64,
    /// Bodies that are held to another one, or to the ground, without limit.
    pub(crate) merged_bodies: u64,
    /// Connections whose wrench follows from balance alone.
    pub(crate) closed_form_connections: u64,
    /// Contacts whose force follows from balance alone.
    pub(crate) closed_form_contacts: u64,
    /// Blocks that a conic program was solved for.
    pub(crate) solved_blocks: u64,
    /// Free bodies in the largest such block.
    pub(crate) largest_block_bodies: u64,
}

/// What was left out of the optimisation and why, and what remained.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Explanation {
    /// Fixed bodies, which need no balance.
    pub(crate) fixed_bodies: u64,
    /// Bodies that unlimited connections hold to another one or to the ground, and that move with it.
    pub(crate) merged_bodies: u64,
    /// Connections without any finite limit: what they carry follows from balance afterwards.
    pub(crate) unlimited_connections: u64,
    /// Other connections and contacts between what cannot move against each other.
    pub(crate) idle_links: u64,
    /// Groups of bodies that nothing leads to from the ground.
    pub(crate) afloat: u64,
    /// Connections whose wrench follows from balance alone.
    pub(crate) closed_form_connections: u64,
    /// Contacts whose force follows from balance alone.
    pub(crate) closed_form_contacts: u64,
    /// Blocks with cycles and nothing to hold.
    pub(crate) unloaded_blocks: u64,
    /// Whether no second-order cone remained: a linear program.
    pub(crate) linear: bool,
    /// What else could be found out, that this question does not ask for.
    pub(crate) not_asked_for: Vec<String>,
    /// The blocks that were optimised.
    pub(crate) remaining: Vec<RemainingBlock>,
}

/// A block that was optimised, and the size of its program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RemainingBlock {
    /// Free bodies.
    pub(crate) bodies: u64,
    /// Connections.
    pub(crate) connections: u64,
    /// Contacts.
    pub(crate) contacts: u64,
    /// Chains of more than one connection that one wrench runs through.
    pub(crate) chains: u64,
    /// Bodies within those chains.
    pub(crate) bodies_in_chains: u64,
    /// Unknown wrenches and contact forces once chains are condensed.
    pub(crate) unknown_wrenches: u64,
    /// Equations of balance that are factorised.
    pub(crate) equations: u64,
    /// Whether it is its own mirror image in a plane, body by body: three equations a body.
    pub(crate) planar: bool,
    /// Why it has six, otherwise.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) in_space_because: Option<String>,
    /// Friction cones of contacts.
    pub(crate) friction_cones: u64,
    /// Second-order cones of connectors.
    pub(crate) connector_cones: u64,
    /// Linear inequalities.
    pub(crate) inequalities: u64,
}
