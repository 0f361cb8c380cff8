//! `plan schema [NAME]`

use std::io;

use steadfast::io::{schema, schema_names};

use crate::arguments::SchemaArguments;
use crate::exit::Exit;
use crate::output;

/// Prints a schema, or the names of all.
///
/// # Errors
/// The output cannot be written.
pub fn run(arguments: &SchemaArguments) -> io::Result<Exit> {
    let names = schema_names().join("\n") + "\n";
    let Some(name) = &arguments.name else {
        output::result(&names)?;
        return Ok(Exit::Yes);
    };
    match schema(name) {
        Some(text) => {
            output::result(&text)?;
            Ok(Exit::Yes)
        }
        None => {
            output::message(&format!("`{name}` is not a format; the formats are\n{}", names.trim_end()))?;
            Ok(Exit::BadInput)
        }
    }
}
