//! Standard output and standard error, where a closed pipe is an ordinary end.

use std::io::{self, Write};

use steadfast::io::Diagnostics;

use crate::exit::Exit;

/// Writes a result.
///
/// # Errors
/// Standard output cannot be written.
pub fn result(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    out.flush()
}

/// Writes a message to the user.
///
/// # Errors
/// Standard error cannot be written.
pub fn message(text: &str) -> io::Result<()> {
    writeln!(io::stderr().lock(), "{text}")
}

/// Lists what is wrong with the input: for people on standard error, for
/// programs as a document on standard output.
///
/// # Errors
/// The output cannot be written.
pub fn bad_input(diagnostics: &Diagnostics, json: bool) -> io::Result<Exit> {
    match json {
        true => result(&diagnostics.to_json())?,
        false => write!(io::stderr().lock(), "{diagnostics}")?,
    }
    Ok(Exit::BadInput)
}
