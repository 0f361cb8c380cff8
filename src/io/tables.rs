//! TOML, read into the tree that JSON is read into: the same schemas, names and messages from there on.
//!
//! The only place that names the parser of TOML. Knows no format.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::codes;
use super::json::{Fault, Member, Node, Span, Value};

/// What to do about a text that is no TOML.
const HINT: &str = "the file is TOML: lines `key = value`, in tables that begin with `[name]` or, in a list of \
                    them, `[[name]]`";

/// Parses a text, with everything that is wrong with it.
pub(super) fn parse(text: &str) -> (Option<Node>, Vec<Fault>) {
    let (root, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        let fault = |error: &toml::de::Error| {
            let range = error.span().unwrap_or(0..0);
            let message = error.message().lines().next().unwrap_or("this is no TOML").to_string();
            Fault::syntax(Span::new(range.start, range.end), message, HINT)
        };
        return (None, errors.iter().map(fault).collect());
    }
    let mut faults = Vec::new();
    // What is missing in the file as a whole is shown at its first character.
    let value = table(root.get_ref(), &mut faults);
    (Some(Node { span: Span::new(0, text.len()), value }), faults)
}

fn table(table: &DeTable<'_>, faults: &mut Vec<Fault>) -> Value {
    let member = |(key, value): (&Spanned<_>, &Spanned<DeValue<'_>>)| {
        let key: &Spanned<std::borrow::Cow<'_, str>> = key;
        Member { key: (&**key.get_ref()).into(), key_span: span(key), node: node(value, faults) }
    };
    Value::Object(table.iter().map(member).collect())
}

fn node(spanned: &Spanned<DeValue<'_>>, faults: &mut Vec<Fault>) -> Node {
    let at = span(spanned);
    let value = match spanned.get_ref() {
        DeValue::String(text) => Value::String((&**text).into()),
        DeValue::Integer(digits) => Value::Number(match i64::from_str_radix(digits.as_str(), digits.radix()) {
            Ok(integer) => integer as f64,
            Err(_) => not_a_number(at, faults),
        }),
        DeValue::Float(digits) => Value::Number(match digits.as_str().parse::<f64>() {
            Ok(number) if number.is_finite() => number,
            _ => not_a_number(at, faults),
        }),
        DeValue::Boolean(value) => Value::Bool(*value),
        DeValue::Datetime(date) => {
            let message = "a date, where no format has one";
            faults.push(Fault::new(codes::WRONG_TYPE, at, message, "put it in quotes if it is meant as a text"));
            Value::String(date.to_string().into())
        }
        DeValue::Array(items) => Value::Array(items.iter().map(|item| node(item, faults)).collect()),
        DeValue::Table(members) => table(members, faults),
    };
    Node { span: at, value }
}

fn not_a_number(at: Span, faults: &mut Vec<Fault>) -> f64 {
    let message = "the number is not finite, or too large";
    faults.push(Fault::new(codes::NOT_FINITE, at, message, "leave out a limit that is not meant"));
    f64::INFINITY
}

fn span<T>(spanned: &Spanned<T>) -> Span {
    let range = spanned.span();
    Span::new(range.start, range.end)
}
