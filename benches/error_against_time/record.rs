//! What is kept of a run: comma-separated values, and the tables in the page that
//! discusses them.

use std::fmt::Write as _;
use std::io;
use std::path::Path;

use crate::growth::Point;
use crate::study::Row;

/// The study as comma-separated values.
pub fn study_csv(rows: &[Row]) -> String {
    let mut text = "family,scene,bodies,method,parameter,claim,lower,upper,reference,reference_uncertainty,error,\
                    time_ms,runs\n"
        .to_owned();
    for row in rows {
        let error = row.error.map_or_else(String::new, |error| format!("{error:.3e}"));
        let _ = writeln!(
            text,
            "{},{},{},\"{}\",{:e},{:?},{},{},{},{:.1e},{error},{:.4},{}",
            row.family,
            row.scene,
            row.bodies,
            row.method.name(),
            row.method.parameter(),
            row.answer.claim,
            row.answer.lower,
            row.answer.upper,
            row.reference,
            row.uncertainty,
            row.milliseconds,
            row.runs
        );
    }
    text
}

/// The growth as comma-separated values.
pub fn growth_csv(points: &[Point]) -> String {
    let mut text = "family,method,bodies,time_ms,peak_mib,added_mib,claim,lower,upper,relative_error\n".to_owned();
    for point in points {
        let error = point.error.map_or_else(String::new, |error| format!("{error:.3e}"));
        let _ = writeln!(
            text,
            "{},\"{}\",{},{:.4},{:.1},{:.1},{},{},{},{error}",
            point.family,
            point.method,
            point.bodies,
            point.milliseconds,
            point.peak,
            point.added,
            point.claim,
            point.lower,
            point.upper
        );
    }
    text
}

/// Replaces what stands in `page` between the two comments that name `part`.
///
/// # Errors
/// Where the page cannot be read or written, or lacks the comments.
pub fn splice(page: &Path, part: &str, text: &str) -> io::Result<()> {
    let old = std::fs::read_to_string(page)?;
    let (begin, end) = (format!("<!-- {part}: written by the bench -->"), format!("<!-- {part}: end -->"));
    let missing = || io::Error::other(format!("{} lacks the comments for {part}", page.display()));
    let (before, rest) = old.split_once(&begin).ok_or_else(missing)?;
    let (_, after) = rest.split_once(&end).ok_or_else(missing)?;
    std::fs::write(page, format!("{before}{begin}\n\n{}\n\n{end}{after}", text.trim()))
}
