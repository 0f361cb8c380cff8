//! Robots outside the lattices, and their files.

use crate::{plan, stdout};

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
