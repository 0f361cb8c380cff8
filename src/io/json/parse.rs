//! Recursive descent over the text, stopped by the first syntax error.

use std::collections::HashSet;

use super::super::codes::{self, Code};
use super::{Member, Node, Span, Value, number, string};

/// Deepest nesting of objects and arrays; the formats need eight.
const MAX_DEPTH: usize = 64;

/// A problem of the text itself.
#[derive(Debug)]
pub(crate) struct Fault {
    pub(crate) code: Code,
    pub(crate) span: Span,
    pub(crate) message: String,
    pub(crate) hint: Option<String>,
}

impl Fault {
    pub(crate) fn new(code: Code, span: Span, message: impl Into<String>, hint: &str) -> Self {
        let hint = (!hint.is_empty()).then(|| hint.to_string());
        Self { code, span, message: message.into(), hint }
    }

    pub(crate) fn syntax(span: Span, message: impl Into<String>, hint: &str) -> Self {
        Self::new(codes::SYNTAX, span, message, hint)
    }
}

/// Parses a whole text. Faults that do not stop the parser (duplicate keys,
/// numbers out of range) come with the tree; a syntax error comes without one.
pub(crate) fn parse(text: &str) -> (Option<Node>, Vec<Fault>) {
    parse_from(text, 0)
}

/// Parses what stands in a text from a byte on, with places in the whole text.
pub(crate) fn parse_from(text: &str, at: usize) -> (Option<Node>, Vec<Fault>) {
    let mut parser = Parser { text, at, depth: 0, faults: Vec::new() };
    let root = parser.document();
    let mut faults = parser.faults;
    match root {
        Ok(node) => (Some(node), faults),
        Err(fault) => {
            faults.push(fault);
            (None, faults)
        }
    }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
    faults: Vec<Fault>,
}

impl Parser<'_> {
    fn document(&mut self) -> Result<Node, Fault> {
        if self.at == 0 && self.text.starts_with('\u{feff}') {
            let hint = "save the file as UTF-8 without BOM";
            return Err(Fault::syntax(Span::new(0, 3), "the file starts with a byte-order mark", hint));
        }
        let start = self.at;
        self.skip_space()?;
        if self.at == self.text.len() {
            let hint = "a file is one JSON object that names its format, e.g. {\"format\": \"structure/1\", ...}";
            return Err(Fault::new(codes::EMPTY, Span::new(start, start), "the file is empty", hint));
        }
        let root = self.value()?;
        self.skip_space()?;
        if self.at < self.text.len() {
            let hint = "a file holds exactly one JSON value; is a bracket closed too early?";
            let message = format!("unexpected {} after the end of the document", self.found());
            return Err(Fault::syntax(self.here(), message, hint));
        }
        Ok(root)
    }

    fn value(&mut self) -> Result<Node, Fault> {
        match self.peek() {
            Some(b'{') => self.nested(Self::object),
            Some(b'[') => self.nested(Self::array),
            Some(b'"') => {
                let (value, span) = string::scan(self.text, self.at)?;
                self.at = span.end as usize;
                Ok(Node { span, value: Value::String(value) })
            }
            Some(b'-' | b'+' | b'.' | b'0'..=b'9') => self.number(),
            Some(byte) if byte.is_ascii_alphabetic() => self.word(),
            Some(b'\'') => {
                Err(Fault::syntax(self.here(), "expected a value, found `'`", "strings are written in double quotes"))
            }
            _ => Err(self.unexpected("a value")),
        }
    }

    fn nested(&mut self, read: fn(&mut Self) -> Result<Node, Fault>) -> Result<Node, Fault> {
        if self.depth == MAX_DEPTH {
            let message = format!("more than {MAX_DEPTH} brackets are open");
            let hint = "no format nests this deep; is a closing bracket missing?";
            return Err(Fault::new(codes::TOO_DEEP, self.here(), message, hint));
        }
        self.depth += 1;
        let node = read(self);
        self.depth -= 1;
        node
    }

    fn array(&mut self) -> Result<Node, Fault> {
        let start = self.at;
        self.at += 1;
        let mut items = Vec::new();
        self.skip_space()?;
        if self.peek() != Some(b']') {
            loop {
                self.skip_space()?;
                items.push(self.value()?);
                if !self.comma(b']', start)? {
                    break;
                }
            }
        }
        self.at += 1;
        Ok(Node { span: Span::new(start, self.at), value: Value::Array(items) })
    }

    fn object(&mut self) -> Result<Node, Fault> {
        let start = self.at;
        self.at += 1;
        let mut members: Vec<Member> = Vec::new();
        let mut seen = HashSet::new();
        self.skip_space()?;
        if self.peek() != Some(b'}') {
            loop {
                let member = self.member()?;
                if seen.insert(member.key.clone()) {
                    members.push(member);
                } else {
                    let message = format!("the key `{}` occurs twice in one object", string::clipped(&member.key));
                    self.faults.push(Fault::new(codes::DUPLICATE_KEY, member.key_span, message, "keep one of the two"));
                }
                if !self.comma(b'}', start)? {
                    break;
                }
            }
        }
        self.at += 1;
        Ok(Node { span: Span::new(start, self.at), value: Value::Object(members) })
    }

    fn member(&mut self) -> Result<Member, Fault> {
        self.skip_space()?;
        match self.peek() {
            Some(b'"') => {}
            Some(byte) if byte == b'\'' || byte == b'_' || byte.is_ascii_alphabetic() => {
                let span = self.word_span();
                let message = format!("expected a key in double quotes, found {}", self.found());
                return Err(Fault::syntax(span, message, "keys are written in double quotes"));
            }
            _ => return Err(self.unexpected("a key in double quotes")),
        }
        let (key, key_span) = string::scan(self.text, self.at)?;
        self.at = key_span.end as usize;
        self.skip_space()?;
        if self.peek() != Some(b':') {
            return Err(self.unexpected(&format!("`:` after the key `{}`", string::clipped(&key))));
        }
        self.at += 1;
        self.skip_space()?;
        let node = self.value()?;
        Ok(Member { key, key_span, node })
    }

    /// After an item: whether another one follows. Leaves the closing bracket unread.
    fn comma(&mut self, close: u8, open: usize) -> Result<bool, Fault> {
        let item_end = self.at;
        self.skip_space()?;
        match self.peek() {
            Some(byte) if byte == close => Ok(false),
            Some(b',') => {
                let comma = self.at;
                self.at += 1;
                self.skip_space()?;
                if self.peek() == Some(close) {
                    let message = format!("trailing comma before `{}`", close as char);
                    return Err(Fault::syntax(
                        Span::new(comma, comma + 1),
                        message,
                        "JSON has no trailing commas: remove it",
                    ));
                }
                Ok(true)
            }
            None => Err(self.ends_inside(close, open)),
            Some(b'"' | b'{' | b'[' | b'-' | b'0'..=b'9' | b't' | b'f' | b'n') => {
                let message = format!("expected `,` or `{}`, found {}", close as char, self.found());
                let span = Span::new(item_end, item_end + 1);
                Err(Fault::syntax(span, message, "a comma is missing after the previous value"))
            }
            Some(_) => {
                let mut fault = self.unexpected(&format!("`,` or `{}`", close as char));
                fault.hint = Some("is a comma, or a closing double quote, missing before it?".to_string());
                Err(fault)
            }
        }
    }

    fn number(&mut self) -> Result<Node, Fault> {
        let (value, span) = number::scan(self.text, self.at)?;
        self.at = span.end as usize;
        if !value.is_finite() {
            let message =
                format!("the number {} is beyond the range of a double", string::clipped(&self.text[span.range()]));
            self.faults.push(Fault::new(codes::NOT_FINITE, span, message, "numbers must be finite, at most 1.797e308"));
        }
        Ok(Node { span, value: Value::Number(value) })
    }

    fn word(&mut self) -> Result<Node, Fault> {
        let span = self.word_span();
        let word = &self.text[span.range()];
        let value = match word {
            "null" => Value::Null,
            "true" => Value::Bool(true),
            "false" => Value::Bool(false),
            _ => {
                let hint = match word.to_ascii_lowercase().as_str() {
                    "nan" | "inf" | "infinity" => number::NOT_JSON,
                    "true" | "false" => "write `true` or `false`, in lower case",
                    "none" | "null" | "nil" | "undefined" => "write `null`",
                    _ => "strings are written in double quotes",
                };
                return Err(Fault::syntax(span, format!("expected a value, found `{}`", string::clipped(word)), hint));
            }
        };
        self.at = span.end as usize;
        Ok(Node { span, value })
    }

    fn skip_space(&mut self) -> Result<(), Fault> {
        let rest = &self.text.as_bytes()[self.at..];
        self.at += rest.iter().take_while(|byte| matches!(byte, b' ' | b'\t' | b'\n' | b'\r')).count();
        let rest = &self.text[self.at..];
        if rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#') {
            let length = if rest.starts_with('#') { 1 } else { 2 };
            let span = Span::new(self.at, self.at + length);
            return Err(Fault::syntax(span, "found a comment", "JSON has no comments: remove it"));
        }
        Ok(())
    }

    fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    fn word_span(&self) -> Span {
        let rest = &self.text.as_bytes()[self.at..];
        let length = rest.iter().take_while(|byte| byte.is_ascii_alphanumeric() || **byte == b'_').count();
        Span::new(self.at, self.at + length.max(1))
    }

    fn here(&self) -> Span {
        let length = self.text[self.at..].chars().next().map_or(0, char::len_utf8);
        Span::new(self.at, self.at + length)
    }

    fn found(&self) -> String {
        match self.text[self.at..].chars().next() {
            None => "the end of the file".to_string(),
            Some(first) if first.is_ascii_alphabetic() => {
                format!("`{}`", string::clipped(&self.text[self.word_span().range()]))
            }
            Some(first) => format!("`{}`", string::clipped(first.encode_utf8(&mut [0; 4]))),
        }
    }

    fn unexpected(&self, expected: &str) -> Fault {
        let truncated = self.at == self.text.len();
        let hint = if truncated { "is the file truncated?" } else { "is something missing or doubled just before?" };
        Fault::syntax(self.here(), format!("expected {expected}, found {}", self.found()), hint)
    }

    fn ends_inside(&self, close: u8, open: usize) -> Fault {
        let line = 1 + self.text[..open].bytes().filter(|byte| *byte == b'\n').count();
        let kind = if close == b'}' { "object" } else { "array" };
        let message = format!("the file ends inside the {kind} that opens in line {line}");
        Fault::syntax(self.here(), message, "is the file truncated, or a closing bracket missing?")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(text: &str) -> Fault {
        let (_, mut faults) = parse(text);
        assert_eq!(faults.len(), 1, "{text}: {faults:?}");
        faults.remove(0)
    }

    #[test]
    fn accepts_exactly_what_serde_json_accepts() {
        let cases = [
            "{}",
            "[]",
            "1",
            "-0",
            "-0.5e+3",
            "01",
            "1.",
            ".5",
            "+1",
            "1e",
            "-",
            "\"a\\u00e9\\n\"",
            "\"\\x\"",
            "\"\\ud800\"",
            "\"\\ud83d\\ude00\"",
            "\"\\udc00\"",
            "\"a\nb\"",
            "[1,]",
            "{\"a\":1,}",
            "{\"a\" 1}",
            "[1 2]",
            "nul",
            "true",
            " [ null ] ",
            "[[]]x",
            "\"",
            "{",
            "[",
            "{\"a\"",
            "{\"a\":",
            "\"\\",
            "\"\\u12",
            "tru",
            "\u{a0}1",
            "{,}",
            "[,]",
            "{1:2}",
        ];
        for text in cases {
            let ours = parse(text).0.is_some();
            let theirs = serde_json::from_str::<serde_json::Value>(text).is_ok();
            assert_eq!(ours, theirs, "{text}");
        }
    }

    #[test]
    fn a_trailing_comma_is_pointed_at() {
        let fault = fault("[1, 2, ]");
        assert_eq!(fault.span, Span::new(5, 6));
        assert!(fault.message.contains("trailing comma"));
    }

    #[test]
    fn nesting_is_bounded() {
        assert_eq!(fault(&"[".repeat(1_000_000)).code, codes::TOO_DEEP);
        assert!(parse(&("[".repeat(MAX_DEPTH) + &"]".repeat(MAX_DEPTH))).0.is_some());
    }

    #[test]
    fn duplicate_keys_and_infinite_numbers_leave_a_tree() {
        let (root, faults) = parse("{\"a\": 1, \"a\": 1e999}");
        assert!(root.is_some());
        let codes: Vec<_> = faults.iter().map(|fault| fault.code).collect();
        assert_eq!(codes, [codes::NOT_FINITE, codes::DUPLICATE_KEY]);
    }
}
