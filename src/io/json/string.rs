//! JSON strings, and how to show text of unknown origin.

use super::Span;
use super::parse::Fault;

/// Reads the string whose opening quote is at `start`.
pub(super) fn scan(text: &str, start: usize) -> Result<(Box<str>, Span), Fault> {
    let mut value = String::new();
    let mut at = start + 1;
    loop {
        let rest = &text[at..];
        let plain = rest.bytes().take_while(|byte| !matches!(byte, b'"' | b'\\' | 0..0x20)).count();
        value.push_str(&rest[..plain]);
        at += plain;
        match text.as_bytes().get(at) {
            Some(b'"') => return Ok((value.into_boxed_str(), Span::new(start, at + 1))),
            Some(b'\\') => {
                let (character, length) = escape(&text[at..]).ok_or_else(|| bad_escape(text, at))?;
                value.push(character);
                at += length;
            }
            None => {
                let hint = "is the file truncated, or a closing double quote missing?";
                return Err(Fault::syntax(Span::new(start, at), "the file ends inside a string", hint));
            }
            Some(b'\n' | b'\r') => {
                let hint = "a closing double quote is missing; a line break in a string is written \\n";
                return Err(Fault::syntax(Span::new(start, at), "the string is not closed", hint));
            }
            Some(_) => {
                let hint = "write it as an escape, e.g. \\t for a tab";
                return Err(Fault::syntax(Span::new(at, at + 1), "a control character in a string", hint));
            }
        }
    }
}

/// The character that an escape stands for, and the escape's length in bytes.
fn escape(text: &str) -> Option<(char, usize)> {
    let simple = match text.as_bytes().get(1)? {
        b'"' => '"',
        b'\\' => '\\',
        b'/' => '/',
        b'b' => '\u{8}',
        b'f' => '\u{c}',
        b'n' => '\n',
        b'r' => '\r',
        b't' => '\t',
        b'u' => return unicode_escape(text),
        _ => return None,
    };
    Some((simple, 2))
}

fn unicode_escape(text: &str) -> Option<(char, usize)> {
    let unit = |at: usize| {
        let digits = text.get(at..at + 6)?.strip_prefix("\\u")?;
        // `from_str_radix` alone would accept a sign.
        digits.bytes().all(|byte| byte.is_ascii_hexdigit()).then(|| u32::from_str_radix(digits, 16).ok())?
    };
    let first = unit(0)?;
    if !(0xd800..0xdc00).contains(&first) {
        return Some((char::from_u32(first)?, 6));
    }
    let second = unit(6).filter(|second| (0xdc00..0xe000).contains(second))?;
    Some((char::from_u32(0x10000 + ((first - 0xd800) << 10) + (second - 0xdc00))?, 12))
}

fn bad_escape(text: &str, at: usize) -> Fault {
    let length = 1 + text[at + 1..].chars().next().map_or(0, char::len_utf8);
    let hint = "the escapes are \\\" \\\\ \\/ \\b \\f \\n \\r \\t and \\uXXXX; a backslash itself is written \\\\";
    Fault::syntax(Span::new(at, at + length), "not an escape that JSON knows", hint)
}

/// `text` cut to a length that fits a message, without control characters.
pub(crate) fn clipped(text: &str) -> String {
    const LONGEST: usize = 40;
    let mut shown: String = text.chars().take(LONGEST).map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect();
    if text.chars().nth(LONGEST).is_some() {
        shown.push_str("...");
    }
    shown
}
