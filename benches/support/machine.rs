//! What a measurement was made of and on.

/// Revision of the source, processor, cores and load, on one line.
pub fn describe() -> String {
    let run = |program: &str, arguments: &[&str]| {
        let output = std::process::Command::new(program).args(arguments).output().ok();
        output.map_or_else(String::new, |out| String::from_utf8_lossy(&out.stdout).trim().to_owned())
    };
    let revision = run("git", &["describe", "--always", "--dirty"]);
    let processors = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = processors.lines().find_map(|line| line.strip_prefix("model name")).unwrap_or("unknown");
    let model = model.trim_start_matches(['\t', ' ', ':']);
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').next().unwrap_or("unknown");
    format!("revision {revision}; {model}, {cores} cores, load {load}; one thread")
}
