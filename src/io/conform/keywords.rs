//! What the keywords of a JSON Schema say about one value.

use serde_json::Value as Schema;

pub(super) fn alternatives(schema: &Schema) -> Option<&[Schema]> {
    schema.get("oneOf").or_else(|| schema.get("anyOf")).and_then(Schema::as_array).map(Vec::as_slice)
}

/// What a schema says that it is for.
pub(super) fn description(schema: &Schema) -> Option<&str> {
    schema.get("description").and_then(Schema::as_str)
}

pub(super) fn types(schema: &Schema) -> Vec<&str> {
    match schema.get("type") {
        Some(Schema::String(name)) => vec![name],
        Some(Schema::Array(names)) => names.iter().filter_map(Schema::as_str).collect(),
        _ => Vec::new(),
    }
}

/// The fixed words that a schema allows; empty when it is not about words.
pub(super) fn words(schema: &Schema) -> Vec<&str> {
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
pub(super) fn tag_of(kind: &Schema) -> Option<&str> {
    let properties = kind.get("properties")?.as_object()?;
    properties.iter().find(|(_, property)| property.get("const").is_some()).map(|(key, _)| key.as_str())
}

pub(super) fn tag_word<'a>(kind: &'a Schema, tag: &str) -> Option<&'a str> {
    kind["properties"][tag]["const"].as_str()
}

pub(super) fn is_integer(schema: &Schema) -> bool {
    types(schema).contains(&"integer")
}

/// Whether a number's text is a whole number that the decoder's integer type holds.
pub(super) fn in_integer_format(schema: &Schema, text: &str) -> bool {
    match schema.get("format").and_then(Schema::as_str) {
        Some("int32") => text.parse::<i32>().is_ok(),
        Some("uint32") => text.parse::<u32>().is_ok(),
        Some("uint64") => text.parse::<u64>().is_ok(),
        _ => text.parse::<i64>().is_ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::schema;
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
