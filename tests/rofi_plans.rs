//! Shortest plans of RoFI modules without gravity: as many steps as the platform's own planner needs. That one checks
//! end cells only; here nothing may be hit on the way, and in none of these does that cost a step. Reads what is kept
//! beside the repository, where it is.

#[path = "support/rofi_pairs.rs"]
mod rofi_pairs;

use serde_json::Value;
use steadfast::io::{SourceFile, no_references, read_linkage};
use steadfast::reconfigure::linkage::{replay, solve};
use steadfast::reconfigure::{Objective, Options, Outcome};
use steadfast::robot::Matching;
use steadfast::robot::linkage::{Goal, Linkage};

use rofi_pairs::pairs;

fn read(world: &Value) -> Linkage {
    let text = serde_json::to_vec(world).unwrap();
    read_linkage(&SourceFile::new("world", text), &no_references).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn as_many_moves_as_the_platform_needs() {
    for (name, value) in pairs() {
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
