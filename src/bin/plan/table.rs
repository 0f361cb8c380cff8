//! Tables that fit a terminal.

/// Widest first column, in characters; longer names are cut in the middle.
const WIDEST_NAME: usize = 28;

/// Rows under headings: the first column to the left, all others to the right.
pub fn table(headings: &[&str], rows: &[Vec<String>]) -> String {
    let shorten = |row: &Vec<String>| {
        let mut row = row.clone();
        row[0] = shortened(&row[0]);
        row
    };
    let headings: Vec<_> = headings.iter().map(|heading| heading.to_string()).collect();
    let rows: Vec<_> = std::iter::once(&headings).chain(rows).map(shorten).collect();
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or_default();
    let widths: Vec<_> = (0..headings.len()).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| match column {
            0 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        });
        format!("  {}\n", cells.collect::<Vec<_>>().join("  ").trim_end())
    };
    rows.iter().map(line).collect()
}

fn shortened(name: &str) -> String {
    let letters: Vec<_> = name.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if letters.len() <= WIDEST_NAME {
        return letters.into_iter().collect();
    }
    let half = (WIDEST_NAME - 3) / 2;
    let (head, tail) = (&letters[..half], &letters[letters.len() - half..]);
    head.iter().chain(&['.', '.', '.']).chain(tail).collect()
}
