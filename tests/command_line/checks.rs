//! What `plan check` says, as text and as JSON.

use crate::{plan, stdout};

#[test]
fn the_exit_code_is_the_verdict() {
    let cases = [("hang_one", 0), ("cantilever_box_3", 10), ("overhang_out", 10)];
    for (name, code) in cases {
        let output = plan(&["check", &format!("structures/{name}.json")]);
        assert_eq!(output.status.code(), Some(code), "{name}");
        assert!(output.stderr.is_empty());
    }
    assert_eq!(plan(&["check", "valid/configuration.json"]).status.code(), Some(0));
    assert_eq!(plan(&["check"]).status.code(), Some(2));
}

#[test]
fn reports_fit_a_terminal_and_name_what_matters() {
    let report = stdout(&plan(&["check", "structures/suspension_76.json"]));
    assert!(report.starts_with("STABLE"), "{report}");
    assert!(report.contains("0.299282"), "margin 1 - 0.700718: {report}");
    assert!(report.contains("76.5184"), "required strength: {report}");
    assert!(report.lines().all(|line| line.chars().count() <= 80), "{report}");
}

#[test]
fn only_the_full_report_chooses_a_state() {
    let check = |more: &[&str]| stdout(&plan(&[&["check", "structures/suspension_76.json"], more].concat()));
    let (plain, full) = (check(&["--top", "84"]), check(&["--top", "84", "--distribution"]));
    assert!(!plain.contains("least sum") && !plain.contains("at its limit"), "{plain}");
    assert!(full.contains("the least sum of strengths") && full.contains("0.299282"), "{full}");
    assert!(full.lines().all(|line| line.chars().count() <= 80), "{full}");
    for (more, expected) in [(&["--json"][..], "proof"), (&["--json", "--distribution"], "least")] {
        let value: serde_json::Value = serde_json::from_str(&check(more)).unwrap();
        assert_eq!(value["distribution"], expected);
        let connections = value["connections"].as_array().unwrap();
        assert!(connections.iter().all(|c| !(c["critical"] == true && c["at_limit"] == true)));
    }
}

/// Nine equal magnets share a weight equally, and each of them at its limit is said to be.
#[test]
fn the_full_report_tells_critical_from_loaded() {
    let report = stdout(&plan(&["check", "--distribution", "structures/hang_nine_parallel.json"]));
    let named = |row: &&str| row.contains("critical") || row.contains("at its limit");
    assert_eq!(report.lines().filter(named).count(), 9, "{report}");
}

#[test]
fn the_json_report_is_json_whatever_the_verdict() {
    for name in ["suspension_76", "overhang_out", "no_gravity"] {
        let report = stdout(&plan(&["check", "--json", &format!("structures/{name}.json")]));
        let value: serde_json::Value = serde_json::from_str(&report).unwrap();
        assert_eq!(value["format"], "check/1");
        assert_eq!(value["utilisation"].is_null(), name == "overhang_out");
    }
}

#[test]
fn what_was_left_out_is_explained() {
    let report = stdout(&plan(&["check", "--explain", "structures/suspension_76.json"]));
    assert!(report.contains("4 fixed bodies"), "{report}");
    assert!(report.contains("there is no contact"), "{report}");
    assert!(report.lines().all(|line| line.chars().count() <= 80), "{report}");
    // The table ends with the one block, which lies in a plane: 72 bodies, 84 unknown wrenches.
    assert!(report.contains("1 block lies in a plane (72 bodies)"), "{report}");
    let remained: Vec<&str> = report.lines().last().unwrap().split_whitespace().collect();
    assert_eq!(remained, ["72", "84", "216", "84", "0"], "{report}");

    let report = stdout(&plan(&["check", "--explain", "structures/random_000.json"]));
    assert!(report.contains("1 block with six equations a body: no plane holds"), "{report}");

    let report = stdout(&plan(&["check", "--explain", "structures/cantilever_box_10.json"]));
    assert!(report.contains("10 connections and 0 contacts in closed form"), "{report}");
    assert!(report.contains("nothing: no solver was asked"), "{report}");
}

#[test]
fn the_json_report_explains_only_when_asked() {
    let value = |arguments: &[&str]| -> serde_json::Value { serde_json::from_str(&stdout(&plan(arguments))).unwrap() };
    assert!(value(&["check", "--json", "structures/suspension_76.json"])["explanation"].is_null());
    let explanation = &value(&["check", "--json", "--explain", "structures/suspension_76.json"])["explanation"];
    assert_eq!((&explanation["fixed_bodies"], &explanation["linear"]), (&4.into(), &false.into()));
    assert_eq!(explanation["remaining"][0]["bodies"], 72);
    assert_eq!(explanation["remaining"][0]["friction_cones"], 0);
    assert_eq!(explanation["remaining"][0]["planar"], true);
    assert!(explanation["remaining"][0]["in_space_because"].is_null());
}

#[test]
fn the_order_of_failure_is_told_on_request() {
    let check = |more: &[&str]| stdout(&plan(&[&["check", "structures/suspension_76.json"], more].concat()));
    assert!(!check(&[]).contains("give way"));
    let report = check(&["--order", "--top", "3"]);
    assert!(report.contains("the order in which connections would give way"), "{report}");
    assert!(report.contains("1. at 0.70071") && report.contains("3. at "), "{report}");
    assert!(report.lines().all(|line| line.chars().count() <= 80), "{report}");
    let value: serde_json::Value = serde_json::from_str(&check(&["--order", "--top", "2", "--json"])).unwrap();
    let order = &value["order"];
    let names = |list: &serde_json::Value| list.as_array().unwrap().len();
    let listed: usize = order["levels"].as_array().unwrap().iter().map(|level| names(&level["connections"])).sum();
    assert_eq!((names(&order["levels"]), listed + names(&order["idle"]) + names(&order["open"])), (2, 84));
    assert_eq!(value["gives_way"]["contacts"], serde_json::json!([]));
}

#[test]
fn what_gives_way_is_named() {
    let report = stdout(&plan(&["check", "structures/incline_mu0.5_27.0.json"]));
    assert!(report.contains("contacts that slide: "), "{report}");
    let report = stdout(&plan(&["check", "structures/overhang_out.json"]));
    assert!(report.contains("contacts that open: "), "{report}");
    let report = stdout(&plan(&["check", "structures/cantilever_box_3.json"]));
    assert!(report.contains("connections that break: "), "{report}");
}

#[test]
fn a_verdict_that_rests_on_squeeze_says_so() {
    for (name, relies) in [("squeeze_block", true), ("squeeze_h", true), ("wedge_v", false), ("hang_one", false)] {
        let path = format!("structures/{name}.json");
        let value: serde_json::Value = serde_json::from_str(&stdout(&plan(&["check", "--json", &path]))).unwrap();
        assert_eq!((&value["verdict"], &value["relies_on_contact_self_stress"]), (&"stable".into(), &relies.into()));
        let report = stdout(&plan(&["check", &path]));
        assert_eq!(report.contains("nothing makes them"), relies, "{report}");
    }
    let output = stdout(&plan(&["check", "--json", "structures/overhang_out.json"]));
    let value: serde_json::Value = serde_json::from_str(&output).unwrap();
    assert!(value["relies_on_contact_self_stress"].is_null());
}

#[test]
fn a_motion_range_is_a_table_and_a_picture() {
    let directory = tempfile::tempdir().unwrap();
    let [csv, svg] = ["range.csv", "range.svg"].map(|name| directory.path().join(name));
    let range =
        |what: &[&str]| plan(&[&["motion-range", "freesn/experiments/arm_0.json", "--step", "30"], what].concat());
    let output = range(&["--connection", "top,node", "--csv", csv.to_str().unwrap(), "--svg", svg.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(stdout(&output).contains("62 positions"), "{output:?}");
    // 12 azimuths at 5 polar angles, and the poles.
    let table = std::fs::read_to_string(csv).unwrap();
    assert_eq!(table.lines().count(), 1 + 12 * 5 + 2);
    assert!(std::fs::read_to_string(svg).unwrap().starts_with("<svg"));
    for (what, said) in [
        (&["--connection", "top,nobody"][..], "there is no module `nobody`"),
        (&["--joint", "top.alpha"], "`top` has no joint `alpha`"),
    ] {
        let output = range(what);
        assert_eq!(output.status.code(), Some(30));
        assert!(String::from_utf8_lossy(&output.stderr).contains(said), "{output:?}");
    }
}
