//! What `plan` and `plan parallel` say and write.

use crate::{plan, stdout};

const TOWER: [&str; 2] = ["cubes/tower_to_bridge/start.json", "cubes/tower_to_bridge/goal.json"];

#[test]
fn plans_are_ranked_profiled_and_bounded() {
    let directory = std::env::temp_dir().join(format!("steadfast-ranking-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let file = |name: &str| directory.join(name).display().to_string();
    let run = |more: &[&str]| plan(&[&TOWER[..], more].concat());

    let front = run(&["--objective", "pareto", "--json"]);
    assert_eq!(front.status.code(), Some(0));
    let front: serde_json::Value = serde_json::from_str(&stdout(&front)).unwrap();
    assert_eq!((&front["objective"], &front["proof"]["optimal"]), (&"pareto".into(), &true.into()));

    let (csv, out) = (file("profile.csv"), file("plan.json"));
    let ranked = stdout(&run(&["--plans", "2", "--profile", &csv, "--out", &out]));
    assert!(ranked.contains("alternative 1: ") && ranked.contains("times as strong, it would give"), "{ranked}");
    let table = std::fs::read_to_string(&csv).unwrap();
    let document: serde_json::Value = serde_json::from_str(&std::fs::read_to_string(&out).unwrap()).unwrap();
    assert_eq!(table.lines().count(), document["profile"].as_array().unwrap().len() + 1);
    assert_eq!(plan(&["verify", &out]).status.code(), Some(0), "all of its plans verify");
    run(&["--profile", &file("profile.svg")]);
    assert!(std::fs::read_to_string(directory.join("profile.svg")).unwrap().starts_with("<svg"));

    let small = run(&["--memory-limit", "1K"]);
    assert_eq!(small.status.code(), Some(11));
    assert!(stdout(&small).contains("stopped at the memory limit"));
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn what_is_in_the_way_is_told() {
    let demanding = [&TOWER[..], &["--min-margin", "0.7"]].concat();
    let output = plan(&demanding);
    assert_eq!(output.status.code(), Some(10));
    let report = stdout(&output);
    // The largest margin is 0.5040: 0.4960 of the strength is used where 0.3 may be.
    assert!(report.contains("with a required margin of 0.5040 there is a plan, of 5 moves"), "{report}");
    assert!(report.contains("1.653") && report.contains("too weak for it: connection b:-z - c:-z"), "{report}");
    let json = stdout(&plan(&[&demanding[..], &["--json"]].concat()));
    let document: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert!(document["in_the_way"]["strength_factor"]["upper"].as_f64().unwrap() > 1.65);
}

#[test]
fn sizes_and_profiles_that_are_none_are_refused() {
    for (option, value) in
        [("--memory-limit", "much"), ("--memory-limit", "-1G"), ("--memory-limit", "0"), ("--profile", "plan.txt")]
    {
        let output = plan(&[&TOWER[..], &[&format!("{option}={value}")]].concat());
        assert_eq!(output.status.code(), Some(2), "{option} {value}");
    }
}

#[test]
fn what_may_run_at_the_same_time_is_told_drawn_and_written() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).display().to_string();
    let (start, goal) = ("cubes/overhang/start.json", "cubes/overhang/goal.json");
    let found = plan(&[start, goal, "--objective", "moves", "--out", &path("plan.json")]);
    assert_eq!(found.status.code(), Some(0));
    let told = plan(&["parallel", &path("plan.json"), "--svg", &path("times.svg"), "--dot", &path("order.dot")]);
    assert_eq!(told.status.code(), Some(0));
    assert!(stdout(&told).contains("waves"), "{}", stdout(&told));
    assert!(std::fs::read_to_string(path("times.svg")).unwrap().starts_with("<svg"));
    assert!(std::fs::read_to_string(path("order.dot")).unwrap().contains("1 -> "));
    let written = stdout(&plan(&["parallel", &path("plan.json"), "--json"]));
    let value: serde_json::Value = serde_json::from_str(&written).unwrap();
    assert_eq!(value["format"], "partial-order/1");
    assert!(value["makespan"].as_f64() <= value["one_by_one"].as_f64());
    assert_eq!(plan(&["parallel", "valid/structure.json"]).status.code(), Some(30));
}

#[test]
fn what_may_run_at_the_same_time_is_told_of_linkages_too() {
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).display().to_string();
    for problem in ["rofi/fold_then_swing", "rofi/tower_of_four_nods", "freesn/two_ways", "freesn/climber"] {
        let [start, goal] = ["start", "goal"].map(|which| format!("{problem}/{which}.json"));
        let found = plan(&[&start, &goal, "--objective", "moves", "--out", &path("plan.json")]);
        assert_eq!(found.status.code(), Some(0), "{problem}");
        let told = plan(&["parallel", &path("plan.json"), "--svg", &path("times.svg"), "--dot", &path("order.dot")]);
        assert_eq!(told.status.code(), Some(0), "{problem}");
        assert!(std::fs::read_to_string(path("order.dot")).unwrap().contains("roll") == problem.contains("freesn"));
        let written = plan(&["parallel", &path("plan.json"), "--move-time", "10", "--latch-time", "1", "--json"]);
        let value: serde_json::Value = serde_json::from_str(&stdout(&written)).unwrap();
        assert_eq!((&value["format"], &value["complete"]), (&"partial-order/1".into(), &true.into()));
        let actions = value["actions"].as_array().unwrap();
        let ends: Vec<f64> = actions.iter().map(|action| action["ends"].as_f64().unwrap()).collect();
        for action in actions {
            let waits = action["waits_for"].as_array().unwrap();
            let ready = waits.iter().map(|wait| ends[wait["action"].as_u64().unwrap() as usize]).fold(0.0, f64::max);
            assert_eq!(action["begins"].as_f64(), Some(ready), "{problem}");
        }
        assert_eq!(value["makespan"].as_f64(), ends.iter().copied().reduce(f64::max), "{problem}");
    }
}

#[test]
fn what_is_forbidden_is_kept_in_the_plan_file() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.json").display().to_string();
    let problem = ["cubes/overhang/start.json", "cubes/overhang/goal.json", "--objective", "moves", "--out", &path];
    let forbid = |more: &[&str]| plan(&[&problem[..], more].concat()).status.code();
    assert_eq!(forbid(&["--forbid-module", "nobody"]), Some(30));
    assert_eq!(forbid(&["--forbid-region", "0,0,0,1,1"]), Some(2));
    // Somewhere else, so that the plan is what it was, and verifies with the region in it.
    assert_eq!(forbid(&["--forbid-region", "5,5,5,6,6,6"]), Some(0));
    assert!(std::fs::read_to_string(&path).unwrap().contains("keep_out"));
    assert_eq!(plan(&["verify", &path]).status.code(), Some(0));
    // Everywhere: nothing can move at all.
    assert_eq!(forbid(&["--forbid-region=-9,-9,-9,9,9,9"]), Some(10));
}
