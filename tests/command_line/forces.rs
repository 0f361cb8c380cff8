//! Ranges of an applied force.

use crate::{plan, stdout};

/// A kilogram on a magnet of 100 N.
#[test]
fn the_range_of_a_force_is_told_with_what_fails() {
    let range = |more: &[&str]| plan(&[&["load-range", "structures/hang_one.json", "--module", "a"], more].concat());
    let report = range(&["--direction", "0,0,-1"]);
    assert_eq!(report.status.code(), Some(0));
    let text = stdout(&report);
    assert!(text.starts_with("RANGE: a withstands any force to 90.1900 N"), "{text}");
    assert!(text.contains("connections that break: c0"), "{text}");
    let json = |more: &[&str]| -> serde_json::Value { serde_json::from_str(&stdout(&range(more))).unwrap() };
    let value = json(&["--direction", "0,0,2", "--json", "--margin", "0.5"]);
    assert_eq!((&value["format"], &value["outcome"]), (&"load-range/1".into(), &"range".into()));
    assert_eq!((&value["highest"]["unlimited"], &value["stands_without"]), (&true.into(), &true.into()));
    let lowest = &value["lowest"];
    assert!((lowest["force_n"]["upper"].as_f64().unwrap() + 50.0 - 9.81).abs() < 1e-4, "{lowest}");
    assert_eq!(lowest["fails"]["gives_way"]["connections"][0], "c0");
    // Pulled sideways off the middle it turns, which the magnet resists less.
    let beside = json(&["--direction", "-1,0,0", "--at", "0,0,-0.1", "--json"]);
    let at_it = json(&["--direction", "-1,0,0", "--at", "0,0,0", "--json"]);
    let most = |value: &serde_json::Value| value["highest"]["force_n"]["lower"].as_f64().unwrap();
    assert!((most(&at_it) - 0.8 * (100.0 - 9.81)).abs() < 1e-4 && most(&beside) < 0.5 * most(&at_it));
}

#[test]
fn a_point_of_a_module_is_given_in_its_own_frame() {
    // The top of c, whose centre is 0.075 m above the ground and 0.05 m along x.
    let arguments = ["--module", "c", "--direction", "0,0,-1", "--at", "0,0,0.025", "--json"];
    let output = plan(&[&["load-range", "valid/configuration.json"], &arguments[..]].concat());
    let value: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    let at: Vec<f64> = value["at_m"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
    assert!((at[2] - 0.1).abs() < 1e-12, "{at:?}");
    assert_eq!(value["body"], "c");
}

#[test]
fn what_no_force_helps_is_a_no() {
    let output = plan(&["load-range", "structures/cantilever_box_3.json", "--module", "a2", "--direction", "0,1,0"]);
    assert_eq!(output.status.code(), Some(10));
    let text = stdout(&output);
    assert!(text.starts_with("NOWHERE") && text.contains("connections that break: "), "{text}");
}

#[test]
fn forces_that_make_no_sense_are_refused() {
    let range = |more: &[&str]| plan(&[&["load-range", "structures/hang_one.json"], more].concat());
    for usage in [
        &["--module", "a"][..],
        &["--direction", "0,0,1"],
        &["--module", "a", "--direction", "0,0"],
        &["--module", "a", "--direction", "0,0,0"],
        &["--module", "a", "--direction", "0,0,nan"],
        &["--module", "a", "--direction", "0,0,1", "--at", "0,x,0"],
        &["--module", "a", "--direction", "0,0,1", "--margin", "1"],
    ] {
        let output = range(usage);
        assert_eq!(output.status.code(), Some(2), "{usage:?}");
        assert!(output.stdout.is_empty());
    }
    let output = range(&["--module", "b", "--direction", "0,0,1"]);
    assert_eq!(output.status.code(), Some(30));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("there is no module or body `b`; there are a"), "{said}");
    let output = range(&["--module", "b", "--direction", "0,0,1", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
    assert_eq!(value["format"], "errors/1");
}
