//! Where a byte range is in a text, and the line that shows it.

use super::json::Span;

/// Longest part of a source line that is shown, in characters.
const WINDOW: usize = 76;

/// Characters shown before the marked place in a clipped line.
const LEAD: usize = 24;

/// A place in a text, ready for a person.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Excerpt {
    /// From 1.
    pub(super) line: usize,
    /// In characters, from 1.
    pub(super) column: usize,
    /// The source line (clipped) and below it the underline, with a gutter.
    pub(super) picture: String,
}

/// Shows `span` of `text`. A span over several lines is marked to the end of its first.
pub(super) fn excerpt(text: &str, span: Span) -> Excerpt {
    let start = char_boundary(text, span.start as usize);
    let before = &text.as_bytes()[..start];
    let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
    let line_start = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
    let line_end = text.as_bytes()[start..].iter().position(|byte| *byte == b'\n').map_or(text.len(), |at| start + at);
    let lead = text[line_start..start].chars().count();
    let tail = text[start..line_end].trim_end_matches('\r');

    let marked_bytes = (span.end as usize).saturating_sub(start).min(tail.len());
    let clipped_left = lead > LEAD && lead + tail.chars().take(WINDOW).count() > WINDOW;
    let skipped = if clipped_left { lead - LEAD } else { 0 };
    let mut shown: String = if clipped_left { "..." } else { "" }.to_string();
    let indent = shown.len() + lead - skipped;
    let room = WINDOW - (lead - skipped);
    let source = text[line_start..start].chars().skip(skipped).chain(tail.chars().take(room));
    shown.extend(source.map(|c| if c.is_control() || c == '\u{feff}' { ' ' } else { c }));
    if tail.chars().nth(room).is_some() {
        shown.push_str("...");
    }
    let marked = tail[..char_boundary(tail, marked_bytes)].chars().take(room).count().max(1);

    let number = line.to_string();
    let picture = format!(
        "{number} | {}\n{} | {}{}",
        shown.trim_end(),
        " ".repeat(number.len()),
        " ".repeat(indent),
        "^".repeat(marked)
    );
    Excerpt { line, column: lead + 1, picture }
}

/// The last boundary between characters that is at most `at`.
fn char_boundary(text: &str, at: usize) -> usize {
    (0..=at.min(text.len())).rev().find(|at| text.is_char_boundary(*at)).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let shown = excerpt("ok\n\u{e4}\u{1f916}x!", Span::new(9, 10));
        assert_eq!((shown.line, shown.column), (2, 3));
        assert_eq!(shown.picture, "2 | \u{e4}\u{1f916}x!\n  |   ^");
    }

    #[test]
    fn long_lines_are_clipped_around_the_mark() {
        let text = "a".repeat(5_000) + "XYZ" + &"b".repeat(5_000);
        let shown = excerpt(&text, Span::new(5_000, 5_003));
        assert_eq!(shown.column, 5_001);
        let lines: Vec<_> = shown.picture.lines().collect();
        assert!(lines[0].chars().count() < 90, "{}", lines[0]);
        let mark = lines[1].find('^').unwrap();
        assert_eq!(&lines[0][mark..mark + 3], "XYZ");
        assert!(lines[1].ends_with("^^^") && !lines[1].ends_with("^^^^"));
    }

    #[test]
    fn spans_beyond_the_text_are_shown_at_its_end() {
        let shown = excerpt("ab", Span::new(7, 9));
        assert_eq!((shown.line, shown.column), (1, 3));
        let shown = excerpt("", Span::new(0, 0));
        assert_eq!((shown.line, shown.column), (1, 1));
    }

    #[test]
    fn line_ends_are_not_shown() {
        assert_eq!(excerpt("{\r\n\"a\": 1\r\n}", Span::new(0, 12)).picture, "1 | {\n  | ^");
    }
}
