//! The program as a user runs it: exit codes, streams, closed pipes.

mod checks;
mod forces;
#[cfg(target_os = "linux")]
mod memory;
mod planning;
mod robots;
mod streams;
mod verification;

use std::process::{Command, Output, Stdio};

fn plan(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_plan")).args(arguments).current_dir(problems::root()).output().unwrap()
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The program with a standard output of our own.
fn plan_into(arguments: &[&str], stdout: impl Into<Stdio>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_plan"));
    command.args(arguments).current_dir(problems::root()).stdout(stdout).stderr(Stdio::piped());
    command.spawn().unwrap().wait_with_output().unwrap()
}
