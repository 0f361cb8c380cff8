//! The problem library: files to check and to plan, and one manifest that
//! alone knows the expected answers and where each comes from.
//!
//! Knows no robots and no formats: it finds files and reads the manifest.

use std::io;
use std::path::{Path, PathBuf};

use indexmap::IndexMap;
use serde::Deserialize;

/// All expected answers.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Manifest {
    /// Structures by name: `structures/NAME.json`.
    pub structures: IndexMap<String, StructureCase>,
    /// Planning problems by name: `cubes/NAME/start.json` and `goal.json`.
    pub cubes: IndexMap<String, PlanningCase>,
    /// Planning problems of RoFI modules by name: `rofi/NAME/start.json` and `goal.json`.
    pub rofi: IndexMap<String, PlanningCase>,
    /// Planning problems of struts and nodes by name: `freesn/NAME/start.json` and `goal.json`.
    pub freesn: IndexMap<String, PlanningCase>,
    /// Planning problems of many cubes, beyond exact search, by name: `large/NAME/start.json` and `goal.json`.
    pub large: IndexMap<String, LargeCase>,
    /// Configurations of the published experiments with struts and nodes by name: `freesn/experiments/NAME.json`.
    pub experiments: IndexMap<String, StructureCase>,
}

/// The expected answers to a planning problem.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlanningCase {
    /// Why the problem is in the library.
    pub why: String,
    /// How many modules the robot has.
    pub modules: usize,
    /// The answer when the fewest moves are asked for.
    pub moves: FewestMoves,
    /// The answer when the largest margin is asked for, where that is quick to prove.
    pub margin: Option<LargestMargin>,
    /// The answer when stability is left out.
    pub by_geometry: Option<ByGeometry>,
    /// How many plans with the fewest moves there are at least.
    pub plans: Option<usize>,
}

/// The expected answer to a planning problem of so many modules that no best plan is known.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LargeCase {
    /// Why the problem is in the library.
    pub why: String,
    /// How many modules the robot has.
    pub modules: usize,
    /// There is a plan with at least this margin.
    pub margin_at_least: f64,
    /// Where that comes from.
    pub source: String,
}

/// The expected answer to the question for the fewest moves.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FewestMoves {
    /// `solved` or `impossible`.
    pub outcome: String,
    /// The number of moves; `None` when impossible.
    pub moves: Option<u32>,
    /// Where the answer comes from.
    pub source: String,
}

/// The expected answer to the question for the largest margin.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LargestMargin {
    /// The fewest moves with that margin.
    pub moves: u32,
    /// The margin, where it is known by another way than a search.
    pub value: Option<f64>,
    /// Where the answer comes from.
    pub source: String,
}

/// The expected answer when stability is left out.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ByGeometry {
    /// The number of moves.
    pub moves: u32,
    /// Whether the robot breaks when that plan is carried out.
    pub breaks: bool,
}

/// The expected answer to a structure.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StructureCase {
    /// `stable`, `internally-unstable` or `whole-body-unstable`.
    pub verdict: String,
    /// The utilisation; `None` when whole-body unstable.
    pub utilisation: Option<f64>,
    /// Tolerance of the utilisation, relative to the larger of 1 and its magnitude.
    pub rtol: f64,
    /// Whether it stands only by contacts that press on each other though nothing makes them, where that is known.
    pub relies_on_contact_self_stress: Option<bool>,
    /// Where the answer comes from.
    pub source: String,
}

/// The directory of the library.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Reads the manifest.
///
/// # Errors
/// The file cannot be read, or is not a manifest.
pub fn manifest() -> io::Result<Manifest> {
    Ok(serde_json::from_slice(&std::fs::read(root().join("manifest.json"))?)?)
}

/// The JSON files in a directory of the library, by name.
///
/// # Errors
/// The directory cannot be read.
pub fn json_files(directory: &str) -> io::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(root().join(directory))?;
    let paths = entries.map(|entry| entry.map(|entry| entry.path())).collect::<io::Result<Vec<_>>>()?;
    let mut files: Vec<_> = paths.into_iter().filter(|path| path.extension().is_some_and(|e| e == "json")).collect();
    files.sort();
    Ok(files)
}

/// The files in a directory of the library other than expected outputs, by name.
///
/// # Errors
/// The directory cannot be read.
pub fn texts_and_json_files(directory: &str) -> io::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(root().join(directory))?;
    let paths = entries.map(|entry| entry.map(|entry| entry.path())).collect::<io::Result<Vec<_>>>()?;
    let mut files: Vec<_> = paths.into_iter().filter(|path| path.extension().is_none_or(|e| e != "stderr")).collect();
    files.sort();
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_structure_has_an_expected_answer_and_the_other_way_round() {
        let mut expected: Vec<_> = manifest().unwrap().structures.into_keys().collect();
        expected.sort();
        let files = json_files("structures").unwrap();
        let present: Vec<_> =
            files.iter().map(|path| path.file_stem().unwrap().to_str().unwrap().to_string()).collect();
        let mut present = present;
        present.sort();
        assert_eq!(present, expected);
    }

    #[test]
    fn every_planning_problem_has_an_expected_answer_and_the_other_way_round() {
        let Manifest { cubes, rofi, large, .. } = manifest().unwrap();
        let names = [cubes.into_keys().collect(), rofi.into_keys().collect(), large.into_keys().collect()];
        for (family, mut expected) in ["cubes", "rofi", "large"].into_iter().zip::<[Vec<String>; 3]>(names) {
            expected.sort();
            let entries = std::fs::read_dir(root().join(family)).unwrap();
            let mut present: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
            present.sort();
            assert_eq!(present, expected);
        }
    }

    #[test]
    fn every_problem_of_struts_and_nodes_has_an_expected_answer_and_the_other_way_round() {
        let mut expected: Vec<_> = manifest().unwrap().freesn.into_keys().collect();
        expected.sort();
        let entries = std::fs::read_dir(root().join("freesn")).unwrap().map(|entry| entry.unwrap().path());
        let problems = entries.filter(|path| path.join("start.json").exists());
        let mut present: Vec<_> =
            problems.map(|path| path.file_name().unwrap().to_str().unwrap().to_string()).collect();
        present.sort();
        assert_eq!(present, expected);
    }

    #[test]
    fn every_experiment_has_an_expected_answer_and_the_other_way_round() {
        let mut expected: Vec<_> = manifest().unwrap().experiments.into_keys().collect();
        expected.sort();
        let name = |path: PathBuf| path.file_stem().unwrap().to_str().unwrap().to_string();
        let mut present: Vec<_> = json_files("freesn/experiments").unwrap().into_iter().map(name).collect();
        present.sort();
        assert_eq!(present, expected);
    }
}
