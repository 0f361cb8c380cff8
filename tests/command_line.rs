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
fn the_json_report_is_json_whatever_the_verdict() {
    for name in ["suspension_76", "overhang_out", "no_gravity"] {
        let report = stdout(&plan(&["check", "--json", &format!("structures/{name}.json")]));
        let value: serde_json::Value = serde_json::from_str(&report).unwrap();
        assert_eq!(value["format"], "check/1");
        assert_eq!(value["utilisation"].is_null(), name == "overhang_out");
    }
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

#[test]
fn a_closed_pipe_is_no_failure() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_plan"))
        .args(["schema", "plan"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
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
