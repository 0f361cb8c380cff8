//! `errors/1`: the problems of a file, for programs.

use schemars::JsonSchema;
use serde::Serialize;

/// Name and version of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub(crate) enum ErrorsFormat {
    /// The first version.
    #[serde(rename = "errors/1")]
    V1,
}

/// All problems of a command's input files.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct Errors {
    /// Name and version of the format.
    pub(crate) format: ErrorsFormat,
    /// The problems, file by file, in the order of the text.
    pub(crate) errors: Vec<FileError>,
    /// Whether there are further ones, left out of a long list.
    pub(crate) truncated: bool,
}

/// One problem.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct FileError {
    /// Number of its kind, e.g. `E012`.
    pub(crate) code: String,
    /// Name of its kind, e.g. `unknown-key`.
    pub(crate) name: String,
    /// The file.
    pub(crate) file: String,
    /// Path of the value within the file; empty for the whole file.
    pub(crate) path: String,
    /// Line, from 1.
    pub(crate) line: u64,
    /// Column in characters, from 1.
    pub(crate) column: u64,
    /// What was expected and what was found.
    pub(crate) message: String,
    /// What to do about it; null when there is nothing to say.
    pub(crate) hint: Option<String>,
}
