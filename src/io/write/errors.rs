//! Diagnostics to `errors/1`.

use super::super::diagnostics::{Diagnostic, Diagnostics};
use super::super::wire;

pub(super) fn wire(diagnostics: &Diagnostics) -> wire::Errors {
    wire::Errors {
        format: wire::ErrorsFormat::V1,
        errors: diagnostics.items().iter().map(error).collect(),
        truncated: diagnostics.is_truncated(),
    }
}

fn error(item: &Diagnostic) -> wire::FileError {
    wire::FileError {
        code: item.code.number.to_string(),
        name: item.code.name.to_string(),
        file: item.file.clone(),
        path: item.path.clone(),
        line: item.line as u64,
        column: item.column as u64,
        message: item.message.clone(),
        hint: item.hint.clone(),
    }
}
