//! What is wrong with a file, where, and what to do about it.

use std::fmt;

use super::codes::Code;

/// One problem of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostic {
    /// What kind of problem.
    pub code: Code,
    /// Name of the file.
    pub file: String,
    /// Path of the value within the file, e.g. `modules[3].rotation_xyzw`;
    /// empty for the whole file. A missing key has the path that it should have.
    pub path: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1. A missing key is placed at the opening brace.
    pub column: usize,
    /// What was expected and what was found.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
    /// The source line, clipped to a readable width, and the place underlined.
    pub excerpt: String,
}

/// All problems of one or several files, at least one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Diagnostics {
    items: Vec<Diagnostic>,
    omitted: usize,
}

impl Diagnostics {
    pub(super) fn new(items: Vec<Diagnostic>, omitted: usize) -> Self {
        Self { items, omitted }
    }

    /// The problems, file by file, each file's in the order of its text.
    pub fn items(&self) -> &[Diagnostic] {
        &self.items
    }

    /// How many further problems were left out because the list grew too long.
    pub fn omitted(&self) -> usize {
        self.omitted
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { code, file, line, column, message, .. } = self;
        writeln!(f, "{file}:{line}:{column}: error[{}]: {message}", code.number)?;
        for line in self.excerpt.lines() {
            writeln!(f, "  {line}")?;
        }
        match &self.hint {
            Some(hint) => writeln!(f, "  hint: {hint}"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for item in &self.items {
            writeln!(f, "{item}")?;
        }
        let count = self.items.len() + self.omitted;
        match (count, self.omitted) {
            (1, _) => writeln!(f, "1 problem"),
            (_, 0) => writeln!(f, "{count} problems"),
            (_, omitted) => writeln!(f, "{count} problems, the last {omitted} of them not shown"),
        }
    }
}

impl std::error::Error for Diagnostics {}
