//! The command line: arguments in, files through the library, reports out.
//!
//! Results go to stdout, progress and diagnostics to stderr. Knows no
//! mechanics and no search; what it prints, the library has found.

mod arguments;
mod check;
mod exit;
mod files;
mod output;
mod schema;
mod table;

use std::process::ExitCode;

use clap::Parser;

use arguments::{Arguments, Command};
use exit::Exit;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let exit = match arguments.command {
        Command::Check(check) => check::run(&check),
        Command::Schema(schema) => schema::run(&schema),
    };
    exit.unwrap_or_else(Exit::from).into()
}
