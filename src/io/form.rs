//! What a file is, by its content.

use super::json::{Node, Value};

/// What a file is, by its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A format of this program, by its `format`.
    Own,
    /// A format of this program that is written in TOML.
    Tables,
    /// A JSON world: modules, the joints between them, and where they are.
    RofiWorld,
    /// Text: a line for every module (`M`) and every joint (`E`).
    RofiText,
    /// Voxels: the cell, direction and position of every shoe.
    RofiVoxels,
}

impl Form {
    /// What messages call it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Own => "this program's own format",
            Self::Tables => "TOML",
            Self::RofiWorld => "a RoFI world",
            Self::RofiText => "RoFI text",
            Self::RofiVoxels => "RoFI voxels",
        }
    }

    /// What a text that is no JSON was taken for.
    pub(super) fn of_text(text: &str) -> Option<Self> {
        let line = text.lines().map(str::trim_start).find(|line| !line.is_empty())?;
        let word = line.split_whitespace().next()?;
        (word.starts_with('#') || matches!(word, "C" | "M" | "E")).then_some(Self::RofiText)
    }

    /// What a JSON value was taken for.
    pub(super) fn of_json(root: &Node) -> Self {
        let has = |key: &str| root.get(key).is_some();
        if !matches!(root.value, Value::Object(_)) || has("format") {
            return Self::Own;
        }
        let is_structure = ["connections", "connectors", "contacts", "gravity_m_s2"].into_iter().any(has);
        if has("modules") && (has("moduleJoints") || has("spaceJoints")) {
            Self::RofiWorld
        } else if has("bodies") && !is_structure {
            Self::RofiVoxels
        } else {
            Self::Own
        }
    }
}
