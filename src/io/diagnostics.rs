//! What is wrong with a file, where, and what to do about it.

use std::fmt;

/// What kind of problem it is. The number never changes once released.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Code {
    /// Number as shown, e.g. `E012`.
    pub number: &'static str,
    /// Name as shown, e.g. `unknown-key`.
    pub name: &'static str,
}

/// One problem of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// What kind of problem.
    pub code: Code,
    /// Name of the file.
    pub file: String,
    /// Path of the value within the file, e.g. `modules[3].rotation_xyzw`; empty for the whole file.
    pub path: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// What was expected and what was found.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
    /// The source line with the place underlined, clipped to a readable width.
    pub excerpt: String,
}

/// All problems of a file, at least one, in the order of the file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    items: Vec<Diagnostic>,
    omitted: usize,
}

impl Diagnostics {
    /// The problems, in the order of the file; long lists are cut.
    pub fn items(&self) -> &[Diagnostic] {
        &self.items
    }

    /// How many further problems were cut from the list.
    pub fn omitted(&self) -> usize {
        self.omitted
    }

    /// The problems as a JSON document, for programs.
    pub fn to_json(&self) -> String {
        todo!()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, _f: &mut fmt::Formatter<'_>) -> fmt::Result {
        todo!()
    }
}

impl std::error::Error for Diagnostics {}
