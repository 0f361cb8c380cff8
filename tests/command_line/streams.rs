//! What goes in and out: files, pipes, standard input, and what is wrong with them.

use std::io::Write;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::{plan, plan_into};

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
