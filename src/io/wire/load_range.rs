//! `load-range/1`: the range of a force that a structure withstands.

use schemars::JsonSchema;
use serde::Serialize;

use super::check::Verdict;
use super::gives_way::GivesWay;
use super::number::Real;
use super::plan::Bracket;

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub(crate) enum LoadRangeFormat {
    /// The first version.
    #[serde(rename = "load-range/1")]
    V1,
}

/// The forces along a line that a structure withstands, beside its loads. SI units.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct LoadRange {
    /// Name and version of the format.
    pub(crate) format: LoadRangeFormat,
    /// The body or module that the force acts on.
    pub(crate) body: String,
    /// Its direction in the world, of length 1.
    pub(crate) direction: [Real; 3],
    /// Its point of action in the world.
    pub(crate) at_m: [Real; 3],
    /// Margin that is to be left at the ends.
    pub(crate) margin: Real,
    /// What was found.
    pub(crate) outcome: RangeOutcome,
    /// The least force; null unless there is a range.
    pub(crate) lowest: Option<RangeEnd>,
    /// The largest force; null unless there is a range.
    pub(crate) highest: Option<RangeEnd>,
    /// Whether it stands without the force: null when that is not known.
    pub(crate) stands_without: Option<bool>,
    /// Where no force helps: the least utilisation over all forces along the line, null when whole-body unstable under all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) least_utilisation: Option<Bracket>,
    /// Where no force helps: what gives way in the best of all states.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) gives_way: Option<GivesWay>,
    /// Why nothing was decided.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) undecided_because: Option<String>,
    /// Wall-clock time in s.
    pub(crate) seconds: Real,
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum RangeOutcome {
    /// A range, both ends known.
    Range,
    /// A range, an end of which is known roughly only.
    RoughRange,
    /// Proved: no force along the line is enough.
    Nowhere,
    /// Neither could be proved.
    Undecided,
}

/// One end of the range.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct RangeEnd {
    /// Bracket on it; a side where nothing was proved, or where there is no end, is null.
    pub(crate) force_n: Bracket,
    /// Whether it is proved that there is no end.
    pub(crate) unlimited: bool,
    /// What fails beyond it; null where there is no end, or none was found.
    pub(crate) fails: Option<Failure>,
}

/// What fails.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Failure {
    /// How: internally, or as a whole. Stable where only the margin is used up.
    pub(crate) verdict: Verdict,
    /// What moves.
    pub(crate) gives_way: GivesWay,
}
