//! How much memory there is, how much this process uses, and sizes on the command line.

use std::fs;

/// Size of a page of memory in bytes: what Linux counts in, on all machines with 4 KiB pages.
const PAGE: usize = 4096;

/// Memory of this process that is resident, in bytes; `None` where the system does not tell as Linux does.
pub fn in_use() -> Option<usize> {
    let counts = fs::read_to_string("/proc/self/statm").ok()?;
    let pages: usize = counts.split_whitespace().nth(1)?.parse().ok()?;
    pages.checked_mul(PAGE)
}

/// Half of this machine's memory in bytes; `None` where the system does not tell as Linux does.
pub fn half_of_the_machine() -> Option<usize> {
    let facts = fs::read_to_string("/proc/meminfo").ok()?;
    let total = facts.lines().find_map(|line| line.strip_prefix("MemTotal:"))?;
    let kibibytes: usize = total.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 512)
}

/// A size: digits, and a letter for a power of 1024.
///
/// # Errors
/// It is none, or not a positive one that fits.
pub fn size(text: &str) -> Result<usize, String> {
    let powers = ["K", "M", "G", "T"];
    let upper = text.trim().to_ascii_uppercase();
    let bare = upper.strip_suffix('B').unwrap_or(&upper);
    let bare = bare.strip_suffix('I').unwrap_or(bare);
    let found = powers.iter().zip(1_u32..).find_map(|(&letter, power)| Some((bare.strip_suffix(letter)?, power)));
    let (digits, power) = found.unwrap_or((bare, 0));
    let number: f64 = digits.trim().parse().map_err(|_| format!("`{text}` is no size like 800M or 1.5G"))?;
    let bytes = number * 1024_f64.powi(power as i32);
    if bytes >= 1.0 && bytes < usize::MAX as f64 {
        Ok(bytes as usize)
    } else {
        Err("a size is positive, and fits into memory".to_string())
    }
}

/// A size for people, e.g. `1.5 GiB`.
pub fn spelled(bytes: u64) -> String {
    let units = ["KiB", "MiB", "GiB", "TiB"];
    let mut value = bytes as f64 / 1024.0;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < units.len() {
        value /= 1024.0;
        unit += 1;
    }
    format!("{value:.1} {}", units[unit])
}
