//! Plans and certificates that `plan verify` takes, and those that it refuses.

use crate::{plan, stdout};

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
