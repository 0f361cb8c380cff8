//! Memory as the kernel counts it, not as the search does.

use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::plan;

/// What a process has held at most so far, in bytes; nothing once it has ended.
fn peak(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix(" kB")?.trim().parse().ok()?;
    Some(1024 * kibibytes)
}

#[test]
fn the_process_stays_below_the_memory_limit() {
    const LIMIT: u64 = 24 << 20;
    let directory = tempfile::tempdir().unwrap();
    let path = |name: &str| directory.path().join(name).display().to_string();
    let problem = ["generate", "--family", "cubes", "--modules", "8", "--seed", "2", "--out", &path("")];
    assert_eq!(plan(&problem).status.code(), Some(0));
    let mut search = Command::new(env!("CARGO_BIN_EXE_plan"))
        .args([
            &path("start.json"),
            &path("goal.json"),
            "--memory-limit",
            &LIMIT.to_string(),
            "--out",
            &path("plan.json"),
        ])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // It only ever grows, so that the last look counts.
    let mut most = 0;
    while search.try_wait().unwrap().is_none() {
        most = peak(search.id()).unwrap_or(most);
        sleep(Duration::from_millis(5));
    }
    assert!(most <= LIMIT, "{most} bytes");
    // It came close, and kept what it had.
    let text = std::fs::read_to_string(path("plan.json")).unwrap();
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert!(most > LIMIT / 2, "{most} bytes");
    assert_eq!(document["proof"]["optimal"], false);
    assert_eq!(plan(&["verify", &path("plan.json")]).status.code(), Some(0));
}
