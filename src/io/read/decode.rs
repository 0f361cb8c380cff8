//! From a place in a text to a wire value.

use std::collections::HashSet;

use serde::de::DeserializeOwned;
use serde_json::{Map, Value as Json};

use super::super::findings::{Findings, Place};
use super::super::json::{Node, Value, clipped};
use super::super::{codes, conform, schema, suggest};

/// Version of all formats.
const VERSION: &str = "1";

/// Checks the value against the schema of `format` and decodes it. Problems
/// that leave something to decode (unknown keys, values out of range) do not
/// stop here, so that a first reading finds as much as possible; the findings
/// keep them from passing.
pub(super) fn decode<T: DeserializeOwned>(format: &str, place: &Place<'_>, findings: &mut Findings) -> Option<T> {
    let node = place.node()?;
    if node.get_str("format").is_some() {
        format_of(place, &[format], findings)?;
    }
    let schema = schema::value(format)?;
    let form = conform::check(schema, place, findings);
    if form.broken {
        return None;
    }
    let json = to_json(node, place, &form.unknown_keys);
    match serde_json::from_value(json) {
        Ok(value) => Some(value),
        Err(error) => {
            findings.add(
                place,
                codes::WRONG_TYPE,
                format!("does not fit the format {format}/{VERSION}: {error}"),
                None,
            );
            None
        }
    }
}

/// Which of the `expected` formats a document says it has.
pub(super) fn format_of<'e>(place: &Place<'_>, expected: &[&'e str], findings: &mut Findings) -> Option<&'e str> {
    let node = place.node()?;
    let opening = |wanted: &str| place.opening(wanted);
    let full: Vec<_> = expected.iter().map(|name| format!("{name}/{VERSION}")).collect();
    let wanted = full.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ");
    let Some(found) = node.get_str("format") else {
        let (code, message) = match (&node.value, node.get("format")) {
            (Value::Object(_), None) => (codes::MISSING_KEY, "the key is missing".to_string()),
            (Value::Object(_), Some(_)) => (codes::WRONG_TYPE, format!("expected {wanted}")),
            _ => {
                findings.add(
                    place,
                    codes::WRONG_TYPE,
                    "expected an object",
                    format!("the file starts with {{\"format\": {wanted}"),
                );
                return None;
            }
        };
        findings.add(&place.key("format"), code, message, opening(&wanted));
        return None;
    };
    if let Some(index) = full.iter().position(|name| name == found) {
        return Some(expected[index]);
    }
    let (name, version) = found.split_once('/').unwrap_or((found, ""));
    let hint = if expected.contains(&name) && version != VERSION {
        format!("this program reads version {VERSION} of the format {name}")
    } else if schema::schema_names().contains(&name) && version == VERSION {
        format!("this is a {name} file, which has no place here")
    } else {
        match suggest::closest(found, full.iter().map(String::as_str)) {
            Some(meant) => format!("did you mean \"{meant}\"?"),
            None => opening(&wanted),
        }
    };
    let message = format!("expected {wanted}, found \"{}\"", clipped(found));
    findings.add(&place.key("format"), codes::FORMAT, message, hint);
    None
}

/// The number that stands in the text. TOML writes some in ways that JSON does not know, e.g. `1_000`.
fn number(source: &str, value: f64) -> Json {
    let whole = (value.fract() == 0.0 && value.abs() < 2.0_f64.powi(53)).then_some(value as i64);
    serde_json::from_str(source).unwrap_or_else(|_| whole.map_or_else(|| Json::from(value), Json::from))
}

/// The value as `serde_json` has it, without the keys at `unknown`. Integers
/// stay integers, so that the decoder's integer types take them.
fn to_json(node: &Node, place: &Place<'_>, unknown: &HashSet<u32>) -> Json {
    match &node.value {
        Value::Null => Json::Null,
        Value::Bool(value) => Json::Bool(*value),
        Value::Number(value) => number(place.source(node.span), *value),
        Value::String(text) => Json::String(text.to_string()),
        Value::Array(items) => items.iter().map(|item| to_json(item, place, unknown)).collect(),
        Value::Object(members) => {
            let known = members.iter().filter(|member| !unknown.contains(&member.key_span.start));
            let pairs = known.map(|member| (member.key.to_string(), to_json(&member.node, place, unknown)));
            Json::Object(pairs.collect::<Map<_, _>>())
        }
    }
}
