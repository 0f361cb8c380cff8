//! What is wrong with a file, where, and what to do about it.

use std::fmt;

use super::codes::{self, Code};

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
    truncated: bool,
}

impl Diagnostics {
    pub(super) fn new(items: Vec<Diagnostic>, truncated: bool) -> Self {
        Self { items, truncated }
    }

    /// Why the planner or the oracle refuses what files of good form say, one
    /// problem for each reason; `file` is what messages blame. `None` without reasons.
    pub fn refused(file: &str, reasons: impl IntoIterator<Item = String>) -> Option<Self> {
        let refused = |message| Diagnostic {
            code: codes::REFUSED,
            file: file.to_string(),
            path: String::new(),
            line: 1,
            column: 1,
            message,
            hint: None,
            excerpt: String::new(),
        };
        let items: Vec<_> = reasons.into_iter().map(refused).collect();
        (!items.is_empty()).then_some(Self { items, truncated: false })
    }

    /// The problems, file by file, each file's in the order of its text.
    pub fn items(&self) -> &[Diagnostic] {
        &self.items
    }

    /// Whether there are further problems, left out because the list grew too long.
    pub fn is_truncated(&self) -> bool {
        self.truncated
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
        match (self.items.len(), self.truncated) {
            (1, false) => writeln!(f, "1 problem"),
            (count, false) => writeln!(f, "{count} problems"),
            (count, true) => writeln!(f, "more than {count} problems"),
        }
    }
}

impl std::error::Error for Diagnostics {}
