//! JSON as a person would lay it out: short lists and objects on one line.

use serde_json::Value;

/// Longest line that holds a whole list or object, in characters.
const WIDTH: usize = 110;

/// The value as text, ending in a line feed.
pub(super) fn text(value: &Value) -> String {
    let mut out = String::new();
    write(value, 0, 0, &mut out);
    out.push('\n');
    out
}

/// Writes `value` at `indent`, where `used` characters of its line are taken already.
fn write(value: &Value, indent: usize, used: usize, out: &mut String) {
    let inner = indent + 2;
    let room = WIDTH.saturating_sub(used);
    match value {
        Value::Array(items) if !fits(value, room) => {
            let all = items.iter().map(|item| (String::new(), item));
            block(('[', ']'), all, indent, inner, out);
        }
        Value::Object(members) if !fits(value, room) => {
            let all = members.iter().map(|(key, item)| (format!("{}: ", Value::from(key.as_str())), item));
            block(('{', '}'), all, indent, inner, out);
        }
        _ => inline(value, out),
    }
}

fn block<'a>(
    brackets: (char, char),
    items: impl Iterator<Item = (String, &'a Value)>,
    indent: usize,
    inner: usize,
    out: &mut String,
) {
    out.push(brackets.0);
    for (index, (label, item)) in items.enumerate() {
        out.push_str(if index == 0 { "\n" } else { ",\n" });
        out.push_str(&" ".repeat(inner));
        out.push_str(&label);
        write(item, inner, inner + label.chars().count(), out);
    }
    out.push('\n');
    out.push_str(&" ".repeat(indent));
    out.push(brackets.1);
}

fn inline(value: &Value, out: &mut String) {
    match value {
        Value::Array(items) => {
            out.push('[');
            for (index, item) in items.iter().enumerate() {
                out.push_str(if index == 0 { "" } else { ", " });
                inline(item, out);
            }
            out.push(']');
        }
        Value::Object(members) => {
            out.push('{');
            for (index, (key, item)) in members.iter().enumerate() {
                out.push_str(if index == 0 { "" } else { ", " });
                out.push_str(&Value::from(key.as_str()).to_string());
                out.push_str(": ");
                inline(item, out);
            }
            out.push('}');
        }
        scalar => out.push_str(&scalar.to_string()),
    }
}

/// Whether a value written inline is at most `room` characters long. Stops
/// counting when it is not, so that laying out a deep value stays linear.
fn fits(value: &Value, room: usize) -> bool {
    fn take(value: &Value, room: usize) -> Option<usize> {
        match value {
            Value::Array(items) => {
                items.iter().try_fold(room.checked_sub(2)?, |room, item| take(item, room)?.checked_sub(2))
            }
            Value::Object(members) => members.iter().try_fold(room.checked_sub(2)?, |room, (key, item)| {
                take(item, room.checked_sub(key.len() + 4)?)?.checked_sub(2)
            }),
            scalar => room.checked_sub(scalar.to_string().chars().count()),
        }
    }
    take(value, room).is_some()
}

#[cfg(test)]
mod tests {
    use super::text;
    use serde_json::{Value, json};

    #[test]
    fn short_parts_stay_on_their_line() {
        let value = json!({"cells": [[0, 0, 0], [1, 0, 0]], "long": ["x".repeat(60), "y".repeat(60)]});
        let expected = format!(
            "{{\n  \"cells\": [[0, 0, 0], [1, 0, 0]],\n  \"long\": [\n    \"{}\",\n    \"{}\"\n  ]\n}}\n",
            "x".repeat(60),
            "y".repeat(60)
        );
        assert_eq!(text(&value), expected);
    }

    #[test]
    fn what_is_laid_out_reads_back() {
        let value = json!({"a": [1.5e-300, -0.0, 0.1, {"b\n\"": [[], {}]}], "c": "z".repeat(200), "d": [null, true]});
        assert_eq!(serde_json::from_str::<Value>(&text(&value)).unwrap(), value);
    }
}
