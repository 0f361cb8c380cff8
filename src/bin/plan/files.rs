//! Files by name.

use std::fs;
use std::io::{self, Read};
use std::path::Path;

use steadfast::io::SourceFile;

/// Reads a file, or standard input when it is called `-`.
///
/// # Errors
/// A sentence for the user.
pub fn read(path: &Path) -> Result<SourceFile, String> {
    let name = path.display().to_string();
    let bytes = if name == "-" {
        let mut bytes = Vec::new();
        io::stdin().lock().read_to_end(&mut bytes).map(|_| bytes)
    } else {
        fs::read(path)
    };
    match bytes {
        Ok(bytes) => Ok(SourceFile::new(name, bytes)),
        Err(error) => Err(format!("{name}: {error}")),
    }
}

/// Reads a file that another one names, relative to that one.
///
/// # Errors
/// A sentence for the user.
pub fn resolve(from: &str, reference: &str) -> Result<SourceFile, String> {
    let path = Path::new(from).parent().unwrap_or(Path::new("")).join(reference);
    let bytes = fs::read(&path).map_err(|error| error.to_string())?;
    Ok(SourceFile::new(path.display().to_string(), bytes))
}
