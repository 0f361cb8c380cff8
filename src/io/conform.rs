//! Checks a JSON value against the schema of its format, and finds everything
//! that is wrong with its form: keys, types, lengths, ranges, fixed words.
//!
//! Understands the part of JSON Schema that the wire types use, and no more; a
//! test holds the two together. Knows no format by itself.

use std::collections::HashSet;

use serde_json::{Map, Value as Schema};

use super::codes;
use super::findings::{Findings, Place};
use super::json::{Node, Value, clipped};
use super::suggest;

/// What is left to do with a value after its form was checked.
#[derive(Debug, Default)]
pub(super) struct Form {
    /// Whether something has the wrong type or is missing, so that the value
    /// cannot be decoded.
    pub(super) broken: bool,
    /// Where the keys are that no decoder may see.
    pub(super) unknown_keys: HashSet<u32>,
}

/// Checks the value at `place` against the root schema.
pub(super) fn check(schema: &Schema, place: &Place<'_>, findings: &mut Findings) -> Form {
    let mut checker = Checker { root: schema, findings, form: Form::default(), about: None };
    if let Some(node) = place.node() {
        checker.value(schema, node, place);
    }
    checker.form
}

struct Checker<'a> {
    root: &'a Schema,
    findings: &'a mut Findings,
    form: Form,
    /// What the schema says of the innermost key.
    about: Option<&'a str>,
}

impl<'a> Checker<'a> {
    fn resolve(&self, schema: &'a Schema) -> &'a Schema {
        let reference = schema.get("$ref").and_then(Schema::as_str);
        match reference.and_then(|reference| self.root.pointer(reference.strip_prefix('#')?)) {
            Some(target) => self.resolve(target),
            None => schema,
        }
    }

    fn value<'d>(&mut self, schema: &'a Schema, node: &'d Node, place: &Place<'d>) {
        if self.findings.is_full() {
            self.form.broken = true; // more would not be shown
            self.findings.truncate();
            return;
        }
        let schema = self.resolve(schema);
        if let Some(alternatives) = alternatives(schema) {
            return self.one_of(alternatives, schema, node, place);
        }
        if !self.accepts(schema, &node.value) {
            return self.wrong_type(schema, node, place);
        }
        match &node.value {
            Value::Null | Value::Bool(_) => {}
            Value::Number(number) => self.number(schema, *number, place),
            Value::String(text) => self.word(&[schema], text, place),
            Value::Array(items) => self.array(schema, items, place),
            Value::Object(_) => self.object(schema, node, place),
        }
    }

    fn one_of<'d>(&mut self, alternatives: &'a [Schema], schema: &'a Schema, node: &'d Node, place: &Place<'d>) {
        let fitting: Vec<_> =
            alternatives.iter().map(|one| self.resolve(one)).filter(|one| self.accepts(one, &node.value)).collect();
        match (&node.value, fitting.as_slice()) {
            (_, []) => self.wrong_type(schema, node, place),
            (_, [one]) => self.value(one, node, place),
            (Value::String(text), words) => self.word(words, text, place),
            (Value::Object(_), objects) => self.tagged(objects, node, place),
            (_, [one, ..]) => self.value(one, node, place),
        }
    }

    /// An object of one of several kinds: by a key whose value names the kind
    /// (`"model": "cone"`), or by its only key (`{"ball": ..}`).
    fn tagged<'d>(&mut self, kinds: &[&'a Schema], node: &'d Node, place: &Place<'d>) {
        if let Some(tag) = kinds.first().and_then(|kind| tag_of(kind)) {
            let tag_place = place.key(tag);
            let Some(found) = node.get(tag) else {
                let words: Vec<_> = kinds.iter().filter_map(|kind| tag_word(kind, tag)).collect();
                let hint = format!("`{tag}` is one of {}", suggest::listed(&words));
                return self.missing(tag, place, Some(hint));
            };
            let Value::String(word) = &found.value else {
                return self.wrong_type(&kinds[0]["properties"][tag], found, &tag_place);
            };
            return match kinds.iter().find(|kind| tag_word(kind, tag) == Some(word)) {
                Some(kind) => self.object(kind, node, place),
                None => {
                    let tags: Vec<_> = kinds.iter().map(|kind| &kind["properties"][tag]).collect();
                    self.word(&tags, word, &tag_place);
                }
            };
        }
        let Value::Object(members) = &node.value else { return };
        let key_of = |kind: &&'a Schema| kind["required"][0].as_str();
        let known: Vec<_> = kinds.iter().filter_map(key_of).collect();
        match members.as_slice() {
            [member] => match kinds.iter().find(|kind| key_of(kind) == Some(&member.key)) {
                Some(kind) => self.object(kind, node, place),
                None => {
                    self.form.broken = true;
                    let message = format!("unknown key `{}`", clipped(&member.key));
                    let hint = suggest::hint(&member.key, "known keys", known);
                    self.findings.add_at(place, member.key_span, codes::UNKNOWN_KEY, message, hint);
                }
            },
            _ => {
                self.form.broken = true;
                let message =
                    format!("expected exactly one of the keys {}, found {}", suggest::listed(&known), members.len());
                self.findings.add(place, codes::WRONG_LENGTH, message, self.meaning());
            }
        }
    }

    fn word(&mut self, schemas: &[&'a Schema], text: &str, place: &Place<'_>) {
        let words: Vec<_> = schemas.iter().flat_map(|schema| words(schema)).collect();
        if words.is_empty() || words.contains(&text) {
            return;
        }
        self.form.broken = true;
        let hint = suggest::closest(text, words.iter().copied()).map(|meant| format!("did you mean `{meant}`?"));
        let hint = hint.or_else(|| self.meaning());
        let message = format!("expected {}, found \"{}\"", either(&words), clipped(text));
        self.findings.add(place, codes::UNKNOWN_VALUE, message, hint);
    }

    fn number(&mut self, schema: &Schema, number: f64, place: &Place<'_>) {
        if !number.is_finite() {
            self.form.broken = true; // said already, by the parser
            return;
        }
        let text = place.text().unwrap_or_default();
        if is_integer(schema) && !in_integer_format(schema, text) {
            self.form.broken = true;
            if text.trim_start_matches('-').bytes().all(|byte| byte.is_ascii_digit()) {
                let message = format!("the whole number {} is out of range", clipped(text));
                return self.findings.add(place, codes::OUT_OF_RANGE, message, self.meaning());
            }
            let message = format!("expected a whole number, found {}", clipped(text));
            let short = number.fract() == 0.0 && number.abs() < 1e9;
            return self.findings.add(
                place,
                codes::WRONG_TYPE,
                message,
                if short { Some(format!("write {number:.0}")) } else { self.meaning() },
            );
        }
        let limit = |key: &str| schema.get(key).and_then(Schema::as_f64);
        let violated = if let Some(least) = limit("minimum").filter(|least| number < *least) {
            format!("at least {least}")
        } else if let Some(least) = limit("exclusiveMinimum").filter(|least| number <= *least) {
            format!("more than {least}")
        } else if let Some(most) = limit("maximum").filter(|most| number > *most) {
            format!("at most {most}")
        } else {
            return;
        };
        self.findings.add(
            place,
            codes::OUT_OF_RANGE,
            format!("must be {violated}, found {}", clipped(text)),
            self.meaning(),
        );
    }

    fn array<'d>(&mut self, schema: &'a Schema, items: &'d [Node], place: &Place<'d>) {
        let limit = |key: &str| schema.get(key).and_then(Schema::as_u64).map(|limit| limit as usize);
        let (least, most) = (limit("minItems"), limit("maxItems"));
        if least.is_some_and(|least| items.len() < least) || most.is_some_and(|most| items.len() > most) {
            // A fixed length is a type of the decoder's; an empty list is not.
            self.form.broken |= most.is_some();
            let message = match items.len() {
                0 => format!("expected {}, found none", self.expected(schema)),
                count => format!("expected {}, found {count}", self.expected(schema)),
            };
            self.findings.add(place, codes::WRONG_LENGTH, message, self.meaning());
        }
        if let Some(item_schema) = schema.get("items") {
            for (index, item) in items.iter().enumerate() {
                if self.findings.is_full() {
                    break;
                }
                self.value(item_schema, item, &place.item(index, item));
            }
        }
    }

    fn object<'d>(&mut self, schema: &'a Schema, node: &'d Node, place: &Place<'d>) {
        let Value::Object(members) = &node.value else { return };
        let known = schema.get("properties").and_then(Schema::as_object);
        let others = schema.get("additionalProperties").filter(|others| others.is_object());
        let all = known.into_iter().flat_map(Map::keys).map(String::as_str);
        let free: Vec<_> = all.filter(|key| node.get(key).is_none()).collect();
        let mut meant = Vec::new();
        for member in members {
            if self.findings.is_full() {
                break;
            }
            if let Some(property) = known.and_then(|known| known.get(&*member.key)).or(others) {
                let outer = std::mem::replace(&mut self.about, description(property));
                self.value(property, &member.node, &place.member(member));
                self.about = outer;
                continue;
            }
            self.form.unknown_keys.insert(member.key_span.start);
            meant.extend(suggest::closest(&member.key, free.iter().copied()));
            let hint = suggest::hint(&member.key, "known keys not yet used", free.iter().copied());
            let hint = hint.filter(|_| !free.is_empty()).or_else(|| Some("leave it out".to_string()));
            let message = format!("unknown key `{}`", clipped(&member.key));
            self.findings.add_at(place, member.key_span, codes::UNKNOWN_KEY, message, hint);
        }
        let required = schema.get("required").and_then(Schema::as_array).into_iter().flatten();
        for key in required.filter_map(Schema::as_str).filter(|key| node.get(key).is_none()) {
            if meant.contains(&key) {
                self.form.broken = true; // said already, with the unknown key
            } else {
                let expected = known.and_then(|known| known.get(key)).map(|property| self.expected(property));
                let hint = expected.map(|expected| format!("`{key}` is {expected}"));
                self.missing(key, place, hint);
            }
        }
    }

    fn missing(&mut self, key: &str, place: &Place<'_>, hint: Option<String>) {
        self.form.broken = true;
        self.findings.add(&place.key(key), codes::MISSING_KEY, "the key is missing", hint);
    }

    fn wrong_type(&mut self, schema: &'a Schema, node: &Node, place: &Place<'_>) {
        self.form.broken = true;
        let message = format!("expected {}, found {}", self.expected(schema), found(node, place));
        let quoted = matches!(&node.value, Value::String(text) if text.trim().parse::<f64>().is_ok());
        let quoted = quoted && types(self.resolve(schema)).contains(&"number");
        let hint = if quoted { Some("write the number without quotes".to_string()) } else { self.meaning() };
        self.findings.add(place, codes::WRONG_TYPE, message, hint);
    }

    /// What the key is about, as a hint.
    fn meaning(&self) -> Option<String> {
        let Some(about) = self.about else {
            return Some("`plan schema` shows the form of every format".to_string());
        };
        let mut letters = about.trim_end_matches('.').chars();
        let first = letters.next()?;
        Some(format!("meaning: {}{}", first.to_lowercase(), letters.as_str()))
    }

    fn accepts(&self, schema: &'a Schema, value: &Value) -> bool {
        let schema = self.resolve(schema);
        if let Some(alternatives) = alternatives(schema) {
            return alternatives.iter().any(|one| self.accepts(one, value));
        }
        let names: &[&str] = match value {
            Value::Null => &["null"],
            Value::Bool(_) => &["boolean"],
            Value::Number(_) => &["number", "integer"],
            Value::String(_) => &["string"],
            Value::Array(_) => &["array"],
            Value::Object(_) => &["object"],
        };
        types(schema).is_empty() || types(schema).iter().any(|name| names.contains(name))
    }

    /// What a schema asks for, in words.
    fn expected(&self, schema: &'a Schema) -> String {
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
            ("array", Some(_), None) => "a list that is not empty".to_string(),
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

fn alternatives(schema: &Schema) -> Option<&[Schema]> {
    schema.get("oneOf").or_else(|| schema.get("anyOf")).and_then(Schema::as_array).map(Vec::as_slice)
}

/// What a schema says that it is for.
fn description(schema: &Schema) -> Option<&str> {
    schema.get("description").and_then(Schema::as_str)
}

fn types(schema: &Schema) -> Vec<&str> {
    match schema.get("type") {
        Some(Schema::String(name)) => vec![name],
        Some(Schema::Array(names)) => names.iter().filter_map(Schema::as_str).collect(),
        _ => Vec::new(),
    }
}

/// The fixed words that a schema allows; empty when it is not about words.
fn words(schema: &Schema) -> Vec<&str> {
    if let Some(word) = schema.get("const").and_then(Schema::as_str) {
        return vec![word];
    }
    if let Some(words) = schema.get("enum").and_then(Schema::as_array) {
        return words.iter().filter_map(Schema::as_str).collect();
    }
    let alternatives = alternatives(schema).unwrap_or_default();
    let all: Vec<_> = alternatives.iter().map(words).collect();
    if all.iter().any(Vec::is_empty) { Vec::new() } else { all.concat() }
}

/// The key that names an object's kind, if it has one.
fn tag_of(kind: &Schema) -> Option<&str> {
    let properties = kind.get("properties")?.as_object()?;
    properties.iter().find(|(_, property)| property.get("const").is_some()).map(|(key, _)| key.as_str())
}

fn tag_word<'a>(kind: &'a Schema, tag: &str) -> Option<&'a str> {
    kind["properties"][tag]["const"].as_str()
}

fn is_integer(schema: &Schema) -> bool {
    types(schema).contains(&"integer")
}

/// Whether a number's text is a whole number that the decoder's integer type holds.
fn in_integer_format(schema: &Schema, text: &str) -> bool {
    match schema.get("format").and_then(Schema::as_str) {
        Some("int32") => text.parse::<i32>().is_ok(),
        Some("uint32") => text.parse::<u32>().is_ok(),
        Some("uint64") => text.parse::<u64>().is_ok(),
        _ => text.parse::<i64>().is_ok(),
    }
}

fn either(words: &[&str]) -> String {
    words.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or ")
}

fn found(node: &Node, place: &Place<'_>) -> String {
    match &node.value {
        Value::Null => "null".to_string(),
        Value::Bool(value) => value.to_string(),
        Value::Number(_) => format!("the number {}", clipped(place.text().unwrap_or_default())),
        Value::String(text) => format!("the string \"{}\"", clipped(text)),
        Value::Array(items) => format!("a list of {}", items.len()),
        Value::Object(_) => "an object".to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::schema;
    use super::Schema;

    /// Keywords that are checked, or that say nothing about the form.
    const KNOWN: [&str; 22] = [
        "$defs",
        "$ref",
        "$schema",
        "additionalProperties",
        "anyOf",
        "const",
        "default",
        "description",
        "enum",
        "exclusiveMinimum",
        "format",
        "items",
        "maxItems",
        "maximum",
        "minItems",
        "minimum",
        "oneOf",
        "properties",
        "required",
        "title",
        "type",
        "examples",
    ];

    fn check_keywords(schema: &Schema) {
        for (keyword, value) in schema.as_object().into_iter().flatten() {
            assert!(KNOWN.contains(&keyword.as_str()), "the checker does not know `{keyword}`");
            match (keyword.as_str(), value) {
                ("properties" | "$defs", Schema::Object(members)) => members.values().for_each(check_keywords),
                ("oneOf" | "anyOf", Schema::Array(all)) => all.iter().for_each(check_keywords),
                ("items" | "additionalProperties", inner) => check_keywords(inner),
                _ => {}
            }
        }
    }

    #[test]
    fn every_keyword_of_the_schemas_is_understood() {
        for name in schema::schema_names() {
            check_keywords(schema::value(name).unwrap());
        }
    }
}
