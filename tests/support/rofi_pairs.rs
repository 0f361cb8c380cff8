//! The pairs of worlds that are kept beside the repository, where they are.

use std::path::PathBuf;

use serde_json::Value;

/// All of them by name, in order of their names.
pub fn pairs() -> Vec<(String, Value)> {
    let directory = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../shared/cases/rofi_plan");
    let Ok(entries) = std::fs::read_dir(directory) else { return Vec::new() };
    let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let read = |path: PathBuf| {
        let value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        (path.file_stem().unwrap().to_string_lossy().into_owned(), value)
    };
    paths.into_iter().map(read).collect()
}
