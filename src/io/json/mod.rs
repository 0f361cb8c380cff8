//! JSON with spans: a small strict parser whose errors say what to do.
//!
//! Strict RFC 8259 JSON, with duplicate keys and numbers beyond the range of
//! a double reported as problems of their own. Knows no format.

mod number;
mod parse;
mod string;

pub(super) use parse::{Fault, parse, parse_from};
pub(super) use string::clipped;

/// Half-open byte range of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Span {
    pub(super) start: u32,
    pub(super) end: u32,
}

impl Span {
    pub(super) fn new(start: usize, end: usize) -> Self {
        let clip = |offset: usize| u32::try_from(offset).unwrap_or(u32::MAX);
        Self { start: clip(start), end: clip(end) }
    }

    pub(super) fn range(self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// A JSON value and where it stands.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) span: Span,
    pub(super) value: Value,
}

/// A JSON value. An object keeps the first of duplicate keys.
#[derive(Debug)]
pub(super) enum Value {
    Null,
    Bool(bool),
    Number(f64),
    String(Box<str>),
    Array(Vec<Node>),
    Object(Vec<Member>),
}

/// A key of an object and its value.
#[derive(Debug)]
pub(super) struct Member {
    pub(super) key: Box<str>,
    pub(super) key_span: Span,
    pub(super) node: Node,
}

impl Node {
    /// The value under `key`, if this is an object that has it.
    pub(super) fn get(&self, key: &str) -> Option<&Node> {
        match &self.value {
            Value::Object(members) => members.iter().find(|m| &*m.key == key).map(|m| &m.node),
            _ => None,
        }
    }

    /// The string under `key`, if this is an object that has one.
    pub(super) fn get_str(&self, key: &str) -> Option<&str> {
        match &self.get(key)?.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }
}
