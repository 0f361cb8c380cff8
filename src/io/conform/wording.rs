//! What a schema asks for and what a file has instead, in words.

use serde_json::Value as Schema;

use super::super::findings::Place;
use super::super::json::{Node, Value, clipped};
use super::Checker;
use super::keywords::{alternatives, types, words};

impl<'a> Checker<'a> {
    /// What the key is about, as a hint.
    pub(super) fn meaning(&self) -> Option<String> {
        let Some(about) = self.about else {
            return Some("`plan schema` shows the form of every format".to_string());
        };
        let mut letters = about.trim_end_matches('.').chars();
        let first = letters.next()?;
        Some(format!("meaning: {}{}", first.to_lowercase(), letters.as_str()))
    }

    /// What a schema asks for, in words.
    pub(super) fn expected(&self, schema: &'a Schema) -> String {
        let schema = self.resolve(schema);
        let listed_words = words(schema);
        if !listed_words.is_empty() {
            return either(&listed_words);
        }
        if let Some(alternatives) = alternatives(schema) {
            let mut parts: Vec<_> = alternatives.iter().map(|one| self.expected(one)).collect();
            parts.dedup();
            return parts.join(" or ");
        }
        let parts: Vec<_> = types(schema).iter().map(|name| self.expected_of_type(schema, name)).collect();
        parts.join(" or ")
    }

    fn expected_of_type(&self, schema: &'a Schema, name: &str) -> String {
        let count = |key: &str| schema.get(key).and_then(Schema::as_u64);
        let plural = || {
            let item = schema.get("items").map(|items| self.resolve(items));
            match item.map(types).unwrap_or_default().as_slice() {
                ["number"] => "numbers",
                ["number", "null"] => "numbers (or null)",
                ["integer"] => "whole numbers",
                ["string"] => "strings",
                _ => "items",
            }
        };
        match (name, count("minItems"), count("maxItems")) {
            ("array", Some(least), Some(most)) if least == most => format!("{least} {}", plural()),
            ("array", Some(least), None) if least > 1 => format!("at least {least} {}", plural()),
            ("array", Some(_), None) => "a list that is not empty".to_string(),
            ("array", Some(least), Some(most)) => format!("{least} to {most} {}", plural()),
            ("array", ..) => "a list".to_string(),
            ("object", ..) => "an object".to_string(),
            ("number", ..) => "a number".to_string(),
            ("integer", ..) => "a whole number".to_string(),
            ("string", ..) => "a string".to_string(),
            ("boolean", ..) => "true or false".to_string(),
            _ => name.to_string(),
        }
    }
}

/// Words as alternatives.
pub(super) fn either(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ")
}

/// A value as messages show it.
pub(super) fn found(node: &Node, place: &Place<'_>) -> String {
    match &node.value {
        Value::Null => "null".to_string(),
        Value::Bool(value) => value.to_string(),
        Value::Number(_) => format!("the number {}", clipped(place.text().unwrap_or_default())),
        Value::String(text) => format!("the string \"{}\"", clipped(text)),
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Object(_) => "an object".to_string(),
    }
}
