//! Files by name.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use steadfast::io::{LARGEST_FILE, SourceFile};

/// Reads a file, or standard input when it is called `-`. A failure is
/// part of the result: the library's readers report it with all else.
pub fn read(path: &Path) -> SourceFile {
    let name = path.display().to_string();
    let bytes = if name == "-" { all(io::stdin().lock()) } else { File::open(path).and_then(all) };
    match bytes {
        Ok(bytes) => SourceFile::new(name, bytes),
        Err(error) => SourceFile::unreadable(name, error.to_string()),
    }
}

/// Reads a file that another one names, relative to that one.
///
/// # Errors
/// A sentence for the user.
pub fn resolve(from: &str, reference: &str) -> Result<SourceFile, String> {
    let path = Path::new(from).parent().unwrap_or(Path::new("")).join(reference);
    let bytes = File::open(&path).and_then(all).map_err(|error| error.to_string())?;
    Ok(SourceFile::new(path.display().to_string(), bytes))
}

/// All bytes, or one more than the library takes: endless files end here.
fn all(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(LARGEST_FILE as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Writes beside the file and renames, so that no half-written plan is left.
///
/// # Errors
/// The file cannot be written.
pub fn save(path: &Path, text: &str) -> io::Result<()> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(".part");
    std::fs::write(&beside, text)?;
    std::fs::rename(&beside, path)
}
