//! Random problems and suites of them, as a user has them: files that are the same for the same seed and that
//! stand by an independent check; runs that can be interrupted; results that must be whole.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;

use serde_json::Value;
use steadfast::certificate::{check, issue};
use steadfast::generate::{Family, GoalKind, Pair, Request, Setting, generate};
use steadfast::io::{
    NamedStructure, Problem, SourceFile, no_references, read_problem, read_results, read_suite, write_result,
};
use steadfast::statics::{Question, Verdict, assess};
use tempfile::TempDir;

fn plan() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plan"));
    command.current_dir(problems::root());
    command
}

fn run(arguments: &[&str]) -> Output {
    plan().args(arguments).output().unwrap()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn path(folder: &TempDir, name: &str) -> String {
    folder.path().join(name).display().to_string()
}

#[test]
fn the_same_seed_writes_the_same_files_with_any_number_of_threads() {
    for family in ["cubes", "freesn", "rofi"] {
        let folder = TempDir::new().unwrap();
        let draw = |name: &str, seed: &str, threads: &str| {
            let out = path(&folder, name);
            let arguments = ["generate", "--family", family, "--modules", "5", "--terrain", "flat", "--held", "true"];
            let output = plan()
                .args(arguments)
                .args(["--seed", seed, "--difficulty", "3", "--goal", "walk", "--out", &out])
                .env("RAYON_NUM_THREADS", threads)
                .output()
                .unwrap();
            assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
            ["start.json", "goal.json"].map(|file| fs::read_to_string(folder.path().join(name).join(file)).unwrap())
        };
        let first = draw("first", "8", "1");
        assert_eq!(first, draw("second", "8", "2"), "{family}");
        assert_ne!(first, draw("third", "9", "1"), "{family}");
    }
}

#[test]
fn what_is_drawn_stands_by_certificates_that_share_no_code_with_the_solver() {
    let settings = [Setting::Mounted, Setting::Flat, Setting::Slope, Setting::Steps, Setting::Rough];
    for family in [Family::Cubes, Family::Freesn, Family::Rofi] {
        for (seed, setting) in (20..).zip(settings) {
            let modules = if family == Family::Rofi { 3 } else { 7 };
            let request = Request { setting, ..Request::new(family, modules, seed) };
            let ends = match generate(&request).unwrap_or_else(|failure| panic!("{request:?}: {failure}")).pair {
                Pair::Lattice { start, goal } => {
                    [start, goal.configuration].map(|robot| NamedStructure::of_configuration(&robot).structure)
                }
                Pair::Linkage { start, goal } => {
                    [start, goal.linkage].map(|robot| NamedStructure::of_linkage(&robot).structure)
                }
            };
            for structure in ends {
                let answer = assess(&structure, Question::VALUE).unwrap();
                let certificate = issue(&structure, &answer).unwrap_or_else(|why| panic!("{request:?}: {why:?}"));
                let proof = check(&certificate).unwrap_or_else(|faults| panic!("{request:?}: {faults:?}"));
                assert_eq!(certificate.verdict, Verdict::Stable, "{request:?}");
                assert!(proof.utilisation.upper <= 0.9 + 1e-5, "{request:?}: {:?}", proof.utilisation);
            }
        }
    }
}

#[test]
fn files_read_back_as_what_was_drawn() {
    for (family, setting, goal) in [
        (Family::Cubes, Setting::Rough, GoalKind::Grown),
        (Family::Freesn, Setting::Steps, GoalKind::Walk),
        (Family::Rofi, Setting::Space, GoalKind::Walk),
    ] {
        let folder = TempDir::new().unwrap();
        let (start, goal_file) = (path(&folder, "a.json"), path(&folder, "b.json"));
        let kind = goal.name();
        let output = run(&[
            "generate",
            "--family",
            family.name(),
            "--modules",
            "4",
            "--seed",
            "3",
            "--terrain",
            setting.name(),
            "--goal",
            kind,
            "--out-start",
            &start,
            "--out-goal",
            &goal_file,
        ]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let file = |name: &str| SourceFile::new(name, fs::read(name).unwrap());
        let read = read_problem(&file(&start), &file(&goal_file), &no_references).unwrap_or_else(|why| panic!("{why}"));
        let drawn = generate(&Request { setting, goal, ..Request::new(family, 4, 3) }).unwrap().pair;
        match (read, drawn) {
            (Problem::Lattice(read), Pair::Lattice { start, goal }) => {
                assert_eq!((read.start, read.goal), (start, goal))
            }
            (Problem::Linkage(read), Pair::Linkage { start, goal }) => {
                assert_eq!((read.start, read.goal), (start, goal))
            }
            _ => panic!("another kind of robot"),
        }
    }
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let folder = TempDir::new().unwrap();
    let out = path(&folder, "out");
    let refused = |arguments: &[&str], code: i32, expected: &str| {
        let output = run(&[&["generate", "--seed", "1", "--out", &out], arguments].concat());
        assert_eq!(output.status.code(), Some(code), "{arguments:?}");
        let said = text(&output.stderr);
        assert!(said.contains(expected), "{arguments:?}: {said}");
        assert!(!Path::new(&out).exists(), "nothing is written");
    };
    refused(&["--family", "cubes", "--modules", "1"], 30, "from 2 to 2000 modules");
    refused(&["--family", "cubes", "--modules", "4", "--difficulty", "4"], 30, "from 1 to 3");
    refused(&["--family", "cubes", "--modules", "4", "--margin", "1.5"], 30, "below 1");
    refused(&["--family", "rofi", "--modules", "2", "--goal", "grown", "--difficulty", "1"], 30, "cannot be chosen");
    refused(&["--family", "cats", "--modules", "2"], 2, "possible values");
    refused(&["--family", "cubes"], 2, "--modules");
    assert_eq!(run(&["generate", "--family", "cubes", "--modules", "4", "--seed", "1"]).status.code(), Some(2));
}

#[test]
fn the_standard_suite_is_sound_and_damage_to_it_is_an_error() {
    let bytes = fs::read(problems::root().join("suites/standard.toml")).unwrap();
    let suite = read_suite(&SourceFile::new("standard.toml", bytes.clone())).unwrap_or_else(|why| panic!("{why}"));
    assert!(suite.jobs().len() > 100);
    let mut word = 1_u64;
    for round in 0..3000 {
        let mut damaged = bytes.clone();
        for _ in 0..1 + round % 4 {
            word = word.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let at = (word >> 33) as usize % damaged.len().max(1);
            match (word >> 20) % 3 {
                _ if damaged.is_empty() => {}
                0 => damaged[at] = b"[]{}=.,\"'#\n0-e_ \xff"[(word >> 40) as usize % 17],
                1 => drop(damaged.remove(at)),
                _ => damaged.truncate(at.max(1)),
            }
        }
        // It must not panic; what is still a suite has jobs.
        if let Ok(suite) = read_suite(&SourceFile::new("damaged.toml", damaged)) {
            assert!(!suite.jobs().is_empty());
        }
    }
}

/// The results of a run by job, without what depends on the clock and on the allocator.
fn results(out: &Path) -> BTreeMap<String, Value> {
    let lines = fs::read_to_string(out.join("results.jsonl")).unwrap();
    let timeless = |line: &str| {
        let mut value: Value = serde_json::from_str(line).unwrap();
        let name = value["job"].as_str().unwrap().to_string();
        for key in ["seconds", "trace", "peak_memory_bytes"] {
            value.as_object_mut().unwrap().remove(key);
        }
        for key in ["seconds", "memory_bytes"] {
            value["statistics"].as_object_mut().unwrap().remove(key);
        }
        (name, value)
    };
    lines.lines().map(timeless).collect()
}

const QUICK: [&str; 3] = ["bench", "suites/quick.toml", "--out"];

#[test]
fn a_suite_runs_and_goes_on_after_interruptions_to_the_same_results() {
    let folder = TempDir::new().unwrap();
    let whole = folder.path().join("whole");
    let output = run(&[&QUICK[..], &[whole.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}{}", text(&output.stdout), text(&output.stderr));
    let expected = results(&whole);
    assert_eq!(expected.len(), 9);
    for (name, result) in &expected {
        assert!(result["plan"]["moves"].as_u64().is_some(), "{name}: {result}");
        let is_free = result["asked"]["planner"] == "ignore-stability";
        assert!(is_free || result["replay"]["flaw"].is_null(), "{name}: {result}");
        let verdict = run(&["verify", whole.join("plans").join(format!("{name}.json")).to_str().unwrap()]);
        assert_eq!(verdict.status.code(), Some(if result["replay"]["flaw"].is_null() { 0 } else { 10 }), "{name}");
    }
    let report = fs::read_to_string(whole.join("report.md")).unwrap();
    assert!(report.contains("9 of 9 jobs finished"), "{report}");
    for figure in ["first_plan", "answered", "error", "gap", "growth"] {
        let svg = fs::read_to_string(whole.join(format!("{figure}.svg"))).unwrap();
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{figure}");
    }
    // What was read is what was written.
    let suite =
        read_suite(&SourceFile::new("quick", fs::read(problems::root().join("suites/quick.toml")).unwrap())).unwrap();
    let file = SourceFile::new("results", fs::read(whole.join("results.jsonl")).unwrap());
    let again = read_results(&file).unwrap().records.into_iter().map(|record| {
        let job = suite.jobs().into_iter().find(|job| job.name() == record.job).unwrap();
        write_result(&job, &record).unwrap()
    });
    assert_eq!(again.collect::<String>(), text(&file.bytes.unwrap()));
    // All is done: nothing runs again.
    let lines = fs::read(whole.join("results.jsonl")).unwrap();
    assert_eq!(run(&[&QUICK[..], &[whole.to_str().unwrap()]].concat()).status.code(), Some(0));
    assert_eq!(fs::read(whole.join("results.jsonl")).unwrap(), lines);

    // The power fails while the fourth line is being written.
    let failed = folder.path().join("failed");
    fs::create_dir(&failed).unwrap();
    let ends: Vec<usize> = (0..lines.len()).filter(|&at| lines[at] == b'\n').collect();
    fs::write(failed.join("results.jsonl"), &lines[..ends[2] + 40]).unwrap();
    let output = run(&[&QUICK[..], &[failed.to_str().unwrap()]].concat());
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stderr).contains("half written"), "{}", text(&output.stderr));
    assert_eq!(results(&failed), expected);
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_a_run_that_can_go_on() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().join("out");
    let suite = folder.path().join("suite.toml");
    let slow = "format = \"suite/1\"\nname = \"slow\"\n[limits]\njob_time_s = 30\njob_memory_mb = 512\n\
                [[case]]\nfamily = \"cubes\"\nmodules = [2]\nseeds = 1\nobjectives = [\"moves\"]\nplanners = [\"exact\"]\n\
                [[case]]\nfamily = \"cubes\"\nmodules = [12]\nseeds = 1\nplanners = [\"exact\"]\n";
    fs::write(&suite, slow).unwrap();
    let arguments = ["bench", suite.to_str().unwrap(), "--out", out.to_str().unwrap(), "--jobs", "1"];
    let child = plan().args(arguments).stdout(std::process::Stdio::null()).stderr(std::process::Stdio::null()).spawn();
    let mut child = child.unwrap();
    let finished = || fs::read_to_string(out.join("results.jsonl")).is_ok_and(|text| text.ends_with('\n'));
    let began = std::time::Instant::now();
    while !finished() && began.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(20));
    }
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    assert_eq!(child.wait().unwrap().code(), Some(11));
    assert!(began.elapsed() < Duration::from_secs(60), "it does not wait for the job");
    assert_eq!(results(&out).len(), 1, "what was interrupted is no result");
    let report = fs::read_to_string(out.join("report.md")).unwrap();
    assert!(report.contains("Not finished: 1 jobs"), "{report}");
}

#[test]
fn results_that_are_broken_or_of_other_jobs_are_refused() {
    let folder = TempDir::new().unwrap();
    let refused = |text_of_results: &str, expected: &str| {
        fs::write(folder.path().join("results.jsonl"), text_of_results).unwrap();
        let output = run(&[&QUICK[..], &[folder.path().to_str().unwrap()]].concat());
        assert_eq!(output.status.code(), Some(30));
        let said = text(&output.stderr);
        assert!(said.contains(expected), "{said}");
        let left = fs::read_to_string(folder.path().join("results.jsonl")).unwrap();
        assert_eq!(left, text_of_results, "it is left as it was");
    };
    refused("\n", "results.jsonl:1:");
    refused("{\"format\": \"result/1\"}\n{ half\n", "results.jsonl:2:");
    let line = r#"{"format":"result/1","job":"another","asked":{"family":"cubes","modules":4,"seed":1,"terrain":"flat",
        "held":false,"goal":"grown","difficulty":null,"margin":0.1,"min_margin":0,"objective":"moves","planner":"exact"},
        "ending":"impossible","seconds":1,"plan":null,"replay":null,"margin_at_most":null,"moves_at_least":null,"trace":[],
        "statistics":{"expanded":1,"oracle_solves":1,"decided_by_bounds":0,"seconds":1},"peak_memory_bytes":null}"#;
    let line = line.replace('\n', " ") + "\n";
    refused(&line, "line 1: the suite has no job another");
    refused(&(line.clone() + &line), "a line before this one is of the same job");
}
