//! Standard output and standard error. A reader that has seen enough, as in
//! `plan check FILE | head -1`, is no failure: the exit code stays the answer's.

use std::io::{self, ErrorKind, Write};

use steadfast::io::Diagnostics;

use crate::exit::Exit;

/// Writes a result.
///
/// # Errors
/// Standard output cannot be written, though it is not closed.
pub fn result(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    unless_closed(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
}

/// Writes a message to the user.
///
/// # Errors
/// Standard error cannot be written, though it is not closed.
pub fn message(text: &str) -> io::Result<()> {
    unless_closed(writeln!(io::stderr().lock(), "{text}"))
}

/// Lists what is wrong with the input: for people on standard error, for
/// programs as a document on standard output.
///
/// # Errors
/// The output cannot be written.
pub fn bad_input(diagnostics: &Diagnostics, json: bool) -> io::Result<Exit> {
    match json {
        true => result(&diagnostics.to_json())?,
        false => unless_closed(write!(io::stderr().lock(), "{diagnostics}"))?,
    }
    Ok(Exit::BadInput)
}

/// Says that the planner or the oracle refuses the input.
///
/// # Errors
/// The output cannot be written.
pub fn refused(file: &str, reasons: impl IntoIterator<Item = String>, json: bool) -> io::Result<Exit> {
    match Diagnostics::refused(file, reasons) {
        Some(diagnostics) => bad_input(&diagnostics, json),
        None => Ok(Exit::BadInput),
    }
}

fn unless_closed(written: io::Result<()>) -> io::Result<()> {
    match written {
        Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        other => other,
    }
}
