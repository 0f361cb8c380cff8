//! The program as a user runs it: exit codes, streams, closed pipes.

use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

fn plan(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_plan")).args(arguments).current_dir(problems::root()).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

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
fn bad_input_is_listed_on_stderr() {
    for kind in ["structure", "configuration"] {
        for path in problems::json_files(&format!("malformed/{kind}")).unwrap() {
            if path.ends_with("other_format.json") {
                continue; // says that it is a configuration, and is judged as one
            }
            let output = plan(&["check", path.to_str().unwrap()]);
            assert_eq!(output.status.code(), Some(30), "{}", path.display());
            assert!(output.stdout.is_empty());
            let place = format!("{}:", path.display());
            let shown = String::from_utf8(output.stderr).unwrap();
            assert!(shown.contains("error[E") && shown.contains("hint: "), "{place} {shown}");
        }
    }
    assert_eq!(plan(&["check", "no/such/file.json"]).status.code(), Some(30));
}

#[test]
fn bad_input_is_json_when_asked() {
    let output = plan(&["check", "--json", "malformed/structure/unknown_key.json"]);
    let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["errors"][0]["code"], "E012");
    assert_eq!((&value["errors"][0]["line"], &value["errors"][0]["column"]), (&6.into(), &20.into()));
    assert_eq!(output.status.code(), Some(30));
}

/// The program with a standard output of our own.
fn plan_into(arguments: &[&str], stdout: impl Into<Stdio>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plan"));
    command.args(arguments).current_dir(problems::root()).stdout(stdout).stderr(Stdio::piped());
    command.spawn().unwrap().wait_with_output().unwrap()
}

#[test]
fn a_closed_pipe_leaves_the_exit_code_alone() {
    let cases: [(&[&str], i32); 4] = [
        (&["schema", "plan"], 0),
        (&["check", "structures/hang_one.json"], 0),
        (&["check", "structures/cantilever_box_3.json"], 10),
        (&["check", "--json", "malformed/structure/unknown_key.json"], 30),
    ];
    for (arguments, code) in cases {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = plan_into(arguments, writer);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told() {
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = plan_into(&["check", "structures/hang_one.json"], full);
    assert_eq!(output.status.code(), Some(30));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.starts_with("error: the output cannot be written: "), "{told}");
}

#[test]
fn unreadable_files_are_reported_like_all_others() {
    for arguments in [&["check", "no/such.json", "--json"][..], &["no/such.json", "no/such.json", "--json"]] {
        let output = plan(arguments);
        assert_eq!(output.status.code(), Some(30));
        let value: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(value["format"], "errors/1");
        assert_eq!(value["errors"][0]["code"], "E001");
        assert_eq!(value["errors"][0]["file"], "no/such.json");
        assert_eq!(
            value["errors"].as_array().unwrap().len(),
            arguments.len() - 1 - usize::from(arguments[0] == "check")
        );
    }
    let output = plan(&["verify", "structures"]);
    assert_eq!(output.status.code(), Some(30));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.starts_with("structures:1:1: error[E001]: cannot be read: "), "{told}");
}

#[cfg(target_os = "linux")]
#[test]
fn endless_files_end() {
    let output = plan(&["check", "/dev/zero"]);
    assert_eq!(output.status.code(), Some(30));
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(told.contains("error[E006]: the file is larger than the 64 MB that are read"), "{told}");
}

#[test]
fn a_plan_against_itself_does_not_verify() {
    let text = std::fs::read_to_string(problems::root().join("valid/plan.json")).unwrap();
    let altered = text.replace("\"axis\": \"-y\"", "\"axis\": \"+x\"");
    assert_ne!(altered, text);
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("plan.json");
    std::fs::write(&path, altered).unwrap();
    let output = plan(&["verify", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(10));
    let shown = stdout(&output);
    assert!(
        shown.contains("action 1 (pivot  c about b to [0, 0, 2]): a turn by 180 degrees about +x does not lead"),
        "{shown}"
    );
    assert!(shown.contains("a turn by 180 degrees about -y does"), "{shown}");
}

#[test]
fn what_is_certified_verifies_and_nothing_else() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("certificate.json");
    let file = path.to_str().unwrap();
    let cases = [
        ("structures/suspension_76.json", 0, "VERIFIED: stable, utilisation between 0.7007"),
        ("structures/cantilever_box_3.json", 10, "VERIFIED: internally unstable, utilisation between "),
        ("structures/overhang_out.json", 10, "VERIFIED: whole-body unstable, no strength of the connections helps"),
        ("valid/configuration.json", 0, "VERIFIED: stable, utilisation between "),
    ];
    for (checked, code, expected) in cases {
        let report = plan(&["check", checked, "--certificate", file, "--json"]);
        assert_eq!(report.status.code(), Some(code), "{checked}");
        assert!(serde_json::from_slice::<serde_json::Value>(&report.stdout).unwrap()["format"] == "check/1");
        let verified = plan(&["verify", file]);
        assert_eq!(verified.status.code(), Some(0), "{checked}");
        assert!(stdout(&verified).starts_with(expected), "{checked}: {}", stdout(&verified));
    }
    let report = plan(&["check", "structures/hang_one.json", "--certificate", "no/such/directory/certificate.json"]);
    assert_eq!(report.status.code(), Some(30));
}

/// Three welded bodies between two magnets under a ceiling, a fourth welded below them.
const WELDED: &str = r#"{
  "format": "structure/1",
  "gravity_m_s2": [0.5, 0, -9.81],
  "bodies": [
    {"id": "left", "mass_kg": 0.5, "com_m": [0, 0, 0]},
    {"id": "middle", "mass_kg": 0.6, "com_m": [0.1, 0, 0]},
    {"id": "right", "mass_kg": 0.7, "com_m": [0.2, 0.01, 0]},
    {"id": "below", "mass_kg": 0.2, "com_m": [0.1, 0, -0.1]}
  ],
  "connectors": {
    "magnet": {"model": "cone", "strength_n": 30, "friction": [0.5, 0.5], "radius_m": [0.03, 0.03, 0.03]},
    "weld": {"model": "box", "strength_n": 1, "shear_n": [null, null], "tension_n": null,
             "compression_n": null, "bending_nm": [null, null], "torsion_nm": null}
  },
  "connections": [
    {"id": "m1", "parent": "world", "child": "left", "connector": "magnet",
     "position_m": [0, 0, 0.05], "rotation_xyzw": [1, 0, 0, 0]},
    {"id": "m2", "parent": "world", "child": "right", "connector": "magnet",
     "position_m": [0.2, 0, 0.05], "rotation_xyzw": [1, 0, 0, 0]},
    {"id": "w1", "parent": "left", "child": "middle", "connector": "weld",
     "position_m": [0.05, 0, 0], "rotation_xyzw": [0, 0.6, 0, 0.8]},
    {"id": "w2", "parent": "right", "child": "middle", "connector": "weld",
     "position_m": [0.15, 0, 0], "rotation_xyzw": [0, -0.6, 0, 0.8]},
    {"id": "w3", "parent": "middle", "child": "below", "connector": "weld",
     "position_m": [0.1, 0, -0.05], "rotation_xyzw": [1, 0, 0, 0]}
  ]
}"#;

/// Bodies that are solved as one are certified as they are: what the welds carry, and
/// that nothing moves across them.
#[test]
fn welded_structures_are_certified_body_by_body() {
    use steadfast::certificate::Carried;
    use steadfast::io::{SourceFile, read_certificate, write_certificate};
    let directory = tempfile::tempdir().unwrap();
    let (structure, path) = (directory.path().join("welded.json"), directory.path().join("certificate.json"));
    std::fs::write(&structure, WELDED).unwrap();
    let (structure, file) = (structure.to_str().unwrap(), path.to_str().unwrap());
    assert_eq!(plan(&["check", structure, "--certificate", file]).status.code(), Some(0));
    let verified = plan(&["verify", file]);
    assert_eq!(verified.status.code(), Some(0));
    assert!(stdout(&verified).starts_with("VERIFIED: stable, utilisation between 0."), "{}", stdout(&verified));

    let issued = read_certificate(&SourceFile::new("issued", std::fs::read(&path).unwrap())).unwrap();
    let (stress, mechanism) = (&issued.certificate.stress, &issued.certificate.mechanism);
    assert!(stress.is_some() && mechanism.is_some());
    let refused = |change: &dyn Fn(&mut steadfast::certificate::Certificate)| {
        let mut tampered = issued.clone();
        change(&mut tampered.certificate);
        std::fs::write(&path, write_certificate(&tampered).unwrap()).unwrap();
        let output = plan(&["verify", file]);
        assert_eq!(output.status.code(), Some(10), "{}", stdout(&output));
        stdout(&output)
    };
    let shown = refused(&|certificate| {
        let Carried::Wrench(wrench) = &mut certificate.stress.as_mut().unwrap().connections[4] else {
            panic!("a weld carries a wrench")
        };
        wrench.force.x += 0.1;
    });
    assert!(shown.contains("body below lacks"), "{shown}");
    let shown = refused(&|certificate| {
        let twists = &mut certificate.mechanism.as_mut().unwrap().twists;
        twists[3].linear *= 1.0 + 1e-9;
    });
    assert!(shown.contains("connection w3 resists") && shown.contains("without limit"), "{shown}");
    let shown = refused(&|certificate| certificate.structure.bodies[3].mass *= 1.001);
    assert!(shown.contains("body below lacks"), "{shown}");
}

#[test]
fn a_false_certificate_is_told_where_it_is_wrong() {
    use steadfast::certificate::Carried;
    use steadfast::io::{SourceFile, read_certificate, write_certificate};
    let text = std::fs::read(problems::root().join("valid/certificate.json")).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("certificate.json");
    let mut document = read_certificate(&SourceFile::new("valid", text.clone())).unwrap();
    let Carried::Wrench(wrench) = &mut document.certificate.stress.as_mut().unwrap().connections[0] else {
        panic!("a magnet carries a wrench")
    };
    wrench.force.z += 0.5;
    std::fs::write(&path, write_certificate(&document).unwrap()).unwrap();
    let output = plan(&["verify", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(10));
    let shown = stdout(&output);
    assert!(shown.starts_with("NOT VERIFIED\n  body ") && shown.contains(" lacks "), "{shown}");

    let damaged = String::from_utf8(text).unwrap().replacen("force_n\": [", "force_n\": [1", 1);
    std::fs::write(&path, damaged).unwrap();
    let output = plan(&["verify", path.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(30));
    assert!(String::from_utf8(output.stderr).unwrap().contains("error[E045]"));
}

#[test]
fn standard_input_is_a_file_too() {
    let text = std::fs::read(PathBuf::from(problems::root()).join("structures/hang_one.json")).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_plan"))
        .args(["check", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(&text).unwrap();
    assert_eq!(child.wait_with_output().unwrap().status.code(), Some(0));
}

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

/// A robot goes through formats and is still where it was: the plan from one file to the other is empty.
#[test]
fn robots_are_converted_there_and_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name).into_os_string().into_string().unwrap();
    let (own, text) = (file("robot.json"), file("robot.rofi"));
    assert_eq!(plan(&["convert", "valid/rofi.rofi", &own]).status.code(), Some(0));
    assert_eq!(plan(&["convert", &own, &text]).status.code(), Some(0));
    let output = plan(&[&own, &text]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stdout(&output).starts_with("PLAN: 0 moves"), "{output:?}");

    let output = plan(&["convert", "valid/configuration.json", "--to", "rofi-text"]);
    assert_eq!(output.status.code(), Some(30));
    assert!(output.stdout.is_empty(), "nothing is written of what cannot be written whole");
    assert!(String::from_utf8_lossy(&output.stderr).contains("no place for gravity"), "{output:?}");
}

#[test]
fn the_margin_of_a_robot_outside_lattices_is_certified() {
    let folder = tempfile::tempdir().unwrap();
    let proof = folder.path().join("proof.json").into_os_string().into_string().unwrap();
    assert_eq!(plan(&["check", "freesn/experiments/load.json", "--certificate", &proof]).status.code(), Some(0));
    let output = plan(&["verify", &proof]);
    assert_eq!(output.status.code(), Some(0));
    assert!(stdout(&output).starts_with("VERIFIED: stable"), "{output:?}");
}

#[test]
fn what_only_lattices_have_is_refused_for_other_robots() {
    for option in [&["--primitive"][..], &["--planner", "decompose"]] {
        let ends = ["freesn/strut_over/start.json", "freesn/strut_over/goal.json"];
        let output = plan(&[&ends[..], option].concat());
        assert_eq!(output.status.code(), Some(30), "{output:?}");
        assert!(String::from_utf8_lossy(&output.stderr).contains("for lattices only"), "{output:?}");
    }
}
