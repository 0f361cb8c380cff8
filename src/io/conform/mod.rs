//! Checks a JSON value against the schema of its format, and finds everything
//! that is wrong with its form: keys, types, lengths, ranges, fixed words.
//!
//! Understands the part of JSON Schema that the wire types use, and no more; a
//! test holds the two together. Knows no format by itself.

mod keywords;
mod wording;

use std::collections::HashSet;

use serde_json::{Map, Value as Schema};

use super::codes;
use super::findings::{Findings, Place};
use super::json::{Node, Value, clipped};
use super::suggest;
use keywords::{alternatives, description, in_integer_format, is_integer, tag_of, tag_word, types, words};
use wording::{either, found};

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
}
