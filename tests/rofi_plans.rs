//! Shortest plans of RoFI modules without gravity: as many steps as the platform's own planner needs. That one checks
//! end cells only; here nothing may be hit on the way, and in none of these does that cost a step. Reads what is kept
//! beside the repository, where it is.

use std::path::PathBuf;

use serde_json::Value;
use steadfast::io::{SourceFile, no_references, read_linkage};
use steadfast::reconfigure::linkage::{replay, solve};
use steadfast::reconfigure::{Objective, Options, Outcome};
use steadfast::robot::Matching;
use steadfast::robot::linkage::{Goal, Linkage};

fn read(world: &Value) -> Linkage {
    let text = serde_json::to_vec(world).unwrap();
    read_linkage(&SourceFile::new("world", text), &no_references).unwrap_or_else(|problems| panic!("{problems}"))
}

fn worlds() -> Vec<(String, Value)> {
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

#[test]
fn as_many_moves_as_the_platform_needs() {
    for (name, value) in worlds() {
        let start = read(&value["start"]);
        let goal = Goal { linkage: read(&value["goal"]), matching: Matching { labelled: false, free_frame: true } };
        let options = Options { objective: Objective::Moves, ignore_stability: true, ..Options::default() };
        let report = solve(&start, &goal, &options, &mut |_| {}).unwrap_or_else(|refusal| panic!("{name}: {refusal}"));
        assert_eq!(report.outcome, Outcome::Solved, "{name}");
        let plan = report.plan.as_ref().unwrap();
        assert_eq!(u64::from(plan.moves), value["shortest"].as_u64().unwrap(), "{name}");
        assert!(report.proof.optimal, "{name}");
        let check = replay::replay(&start, &goal, plan, f64::NEG_INFINITY).unwrap();
        assert_eq!(check.failures, [], "{name}");
    }
}
