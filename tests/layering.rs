//! The layers of the library, read from its `use` lines: an arrow that runs back,
//! or a foreign library named outside its one place, fails here.

use std::fs;
use std::path::{Path, PathBuf};

/// Each layer with the layers that it may use.
const LAYERS: [(&str, &[&str]); 10] = [
    ("spatial", &[]),
    ("statics", &["spatial"]),
    ("certificate", &["spatial", "statics"]),
    ("robot", &["spatial", "statics"]),
    ("geometry", &["spatial", "robot"]),
    ("reconfigure", &["spatial", "statics", "robot", "geometry"]),
    ("schedule", &["spatial", "statics", "robot", "geometry", "reconfigure"]),
    ("generate", &["spatial", "statics", "robot", "geometry", "reconfigure"]),
    ("suite", &["spatial", "statics", "robot", "geometry", "reconfigure", "generate"]),
    ("io", &["spatial", "statics", "certificate", "robot", "geometry", "reconfigure", "generate", "suite"]),
];

/// Libraries that only one layer may name.
const HOMES: [(&str, &str); 10] = [
    ("clarabel", "statics"),
    ("parry3d_f64", "geometry"),
    ("serde", "io"),
    ("serde_json", "io"),
    ("rand_chacha", "generate"),
    ("schemars", "io"),
    ("sha2", "io"),
    ("stl_io", "io"),
    ("tobj", "io"),
    ("toml", "io"),
];

/// What the checker of certificates may take from the oracle: plain data.
const DATA: [&str; 11] = [
    "Anchor",
    "Body",
    "Bracket",
    "Connection",
    "Connector",
    "Contact",
    "Load",
    "Model",
    "Structure",
    "Verdict",
    "statics",
];

fn rust_files(directory: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The lines of a file that are code.
fn code(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap();
    text.lines().filter(|line| !line.trim_start().starts_with("//")).map(str::to_string).collect()
}

/// Whether `name::` stands in the line as a path of its own.
fn names(line: &str, name: &str) -> bool {
    let path = format!("{name}::");
    line.match_indices(&path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || c == '_' || c == ':')
    })
}

#[test]
fn no_arrow_runs_back() {
    for (layer, may_use) in LAYERS {
        for file in rust_files(&root().join("src").join(layer)) {
            for line in code(&file) {
                for (other, _) in LAYERS {
                    let used =
                        line.contains(&format!("crate::{other}::")) || line.contains(&format!("crate::{other};"));
                    assert!(
                        !used || other == layer || may_use.contains(&other),
                        "{}: {layer} must not use {other}: {line}",
                        file.display()
                    );
                }
            }
        }
    }
}

#[test]
fn every_module_of_the_library_has_its_layer() {
    let entries = fs::read_dir(root().join("src")).unwrap().map(|entry| entry.unwrap().path());
    let mut found: Vec<String> = entries
        .filter(|path| path.is_dir() && !path.ends_with("bin"))
        .map(|path| path.file_name().unwrap().to_str().unwrap().to_string())
        .collect();
    let mut known: Vec<String> = LAYERS.iter().map(|(layer, _)| (*layer).to_string()).collect();
    found.sort();
    known.sort();
    assert_eq!(found, known);
}

#[test]
fn foreign_libraries_stay_at_home() {
    for file in rust_files(&root().join("src")) {
        let place = file.strip_prefix(root().join("src")).unwrap();
        let layer = place.iter().next().unwrap().to_str().unwrap();
        for line in code(&file) {
            for (library, home) in HOMES {
                assert!(
                    !names(&line, library) || layer == home,
                    "{}: {library} outside {home}: {line}",
                    file.display()
                );
            }
        }
    }
}

#[test]
fn the_search_engines_know_no_robots() {
    for file in rust_files(&root().join("planners/src")) {
        for line in code(&file) {
            assert!(!names(&line, "steadfast") && !line.contains("use steadfast"), "{}: {line}", file.display());
        }
    }
    let manifest = fs::read_to_string(root().join("planners/Cargo.toml")).unwrap();
    let own = manifest.split("[dev-dependencies]").next().unwrap();
    assert!(!own.contains("path ="), "planners depends on nothing of ours: {own}");
}

#[test]
fn the_checker_of_certificates_shares_no_code_with_the_solver() {
    for file in rust_files(&root().join("src/certificate")) {
        if file.components().any(|part| part.as_os_str() == "issue") {
            continue; // makes certificates, and is not trusted
        }
        for line in code(&file) {
            let Some((_, used)) = line.split_once("crate::statics") else { continue };
            let names = used.split(|c: char| !c.is_alphanumeric()).filter(|name| !name.is_empty());
            for name in names {
                assert!(DATA.contains(&name), "{}: {name} is no plain data: {line}", file.display());
            }
        }
        for line in code(&file).iter().filter(|line| line.starts_with("use ") && !line.contains("::issue")) {
            let known = ["use crate::spatial", "use crate::statics", "use std::", "use super::"];
            assert!(known.iter().any(|start| line.starts_with(start)), "{}: {line}", file.display());
        }
    }
}
