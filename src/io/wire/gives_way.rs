//! What moves where a structure gives way: part of several reports.

use schemars::JsonSchema;
use serde::Serialize;

/// The parts that are used up in a motion.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct GivesWay {
    /// Connections that break: without more strength there, the utilisation could not fall.
    pub(crate) connections: Vec<String>,
    /// Contacts that slide or open.
    pub(crate) contacts: Vec<MovingContact>,
}

/// A contact that does not rest.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct MovingContact {
    /// Its name.
    pub(crate) id: String,
    /// What it does.
    pub(crate) motion: ContactMotion,
}

/// What a contact does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ContactMotion {
    /// It slides: friction is used up, or there is none.
    Slides,
    /// Its two sides part.
    Opens,
}
