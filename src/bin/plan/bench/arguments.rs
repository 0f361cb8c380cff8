//! What `plan bench` can be asked.

use std::path::PathBuf;

use clap::Args;

const EXIT_CODES: &str = "Exit codes: 0 all jobs are finished (whatever they found); 2 usage; 11 interrupted, or out of \
total time: run it again to go on; 30 bad input; 101 a bug, e.g. a plan that its replay refutes";

/// What `plan bench` can be asked.
#[derive(Debug, Args)]
#[command(after_help = EXIT_CODES)]
pub struct Arguments {
    /// A suite/1 file, in TOML: see `plan schema suite`
    pub suite: PathBuf,
    /// Folder for results.jsonl, plans, report.md and its figures; what it holds of this suite is not run again
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// How many jobs to run at once, each on one thread [default: one for each core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Run this one job and write what becomes known to standard output: how the program calls itself
    #[arg(long, value_name = "NAME", hide = true)]
    pub job: Option<String>,
}
