//! What can be asked on the command line.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand};

/// Reconfiguration planner for modular robots in which every transient state is proved stable
#[derive(Debug, Parser)]
#[command(name = "plan", version, after_help = EXIT_CODES)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

const EXIT_CODES: &str = "Exit codes: 0 plan found, structure stable, plan verified; 2 usage; 10 proved that no plan \
exists, structure unstable, plan does not verify; 11 not decided within the limits; 30 bad input; 101 a bug";

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Say whether a structure or a configuration is stable, and by what margin
    Check(CheckArguments),
    /// Print the JSON Schema of a format, or the names of all formats
    Schema(SchemaArguments),
}

#[derive(Debug, Args)]
pub struct CheckArguments {
    /// A structure/1 or configuration/1 file; `-` reads standard input
    pub file: PathBuf,
    /// Print a check/1 document (and errors as an errors/1 document)
    #[arg(long)]
    pub json: bool,
    /// How many of the most loaded connections to show
    #[arg(long, value_name = "N", default_value_t = 10)]
    pub top: usize,
}

#[derive(Debug, Args)]
pub struct SchemaArguments {
    /// Name of the format; without it, all names are listed
    pub name: Option<String>,
}
