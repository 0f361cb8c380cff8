//! The command line: arguments in, files through the library, reports out.
//!
//! Results go to stdout, progress and diagnostics to stderr. Knows no
//! mechanics and no search; what it prints, the library has found.

mod arguments;
mod bench;
mod check;
mod convert;
mod exit;
mod explain;
mod family;
mod files;
mod gantt;
mod generate;
mod gives_way;
mod load_range;
mod memory;
mod motion_range;
mod order;
mod output;
mod parallel;
mod polar_map;
mod profile;
mod progress;
mod restrictions;
mod schema;
mod search;
mod summary;
mod table;
mod verify;

use std::process::ExitCode;

use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};

use arguments::{Arguments, Command};
use exit::Exit;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let exit = match (arguments.command, arguments.planning) {
        (Some(Command::Verify(verify)), _) => verify::run(&verify),
        (Some(Command::Check(check)), _) => check::run(&check),
        (Some(Command::MotionRange(range)), _) => motion_range::run(&range),
        (Some(Command::Convert(convert)), _) => convert::run(&convert),
        (Some(Command::LoadRange(range)), _) => load_range::run(&range),
        (Some(Command::Generate(generate)), _) => generate::run(&generate),
        (Some(Command::Bench(bench)), _) => bench::run(&bench),
        (Some(Command::Parallel(parallel)), _) => parallel::run(&parallel),
        (Some(Command::Schema(schema)), _) => schema::run(&schema),
        (None, Some(planning)) => search::run(&planning),
        (None, None) => {
            Arguments::command().error(ErrorKind::MissingRequiredArgument, "START and GOAL are missing").exit()
        }
    };
    let exit = exit.unwrap_or_else(|error| {
        // Nobody is left to tell when this fails as well.
        let _ = output::message(&format!("error: the output cannot be written: {error}"));
        Exit::BadInput
    });
    exit.into()
}
