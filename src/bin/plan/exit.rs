//! How the program ends.

use std::process::ExitCode;

/// The exit codes; a bug exits with 101, bad usage with clap's 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Plan found, structure stable, plan verified.
    Yes,
    /// Proved: no plan exists; structure unstable; plan does not verify.
    No,
    /// Nothing found within the limits; verdict undecided.
    Undecided,
    /// The input cannot be used, or the output cannot be written; it is said why.
    BadInput,
    /// The program contradicts itself.
    Bug,
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(match exit {
            Exit::Yes => 0,
            Exit::No => 10,
            Exit::Undecided => 11,
            Exit::BadInput => 30,
            Exit::Bug => 101,
        })
    }
}
