//! JSON Schemas, made from the wire types: for users' editors, and for
//! checking every file before it is decoded. A suite is written in TOML, which has the same values.

use std::sync::LazyLock;

use schemars::{JsonSchema, generate::SchemaSettings};
use serde_json::Value;

use super::{layout, wire};

/// The formats that have a schema.
const NAMES: [&str; 13] = [
    "structure",
    "catalogue",
    "configuration",
    "plan",
    "check",
    "load-range",
    "partial-order",
    "certificate",
    "suite",
    "result",
    "errors",
    "rofi-world",
    "rofi-voxels",
];

static SCHEMAS: LazyLock<[Value; 13]> = LazyLock::new(|| {
    [
        generate::<wire::Structure>(),
        generate::<wire::Catalogue>(),
        generate::<wire::Configuration>(),
        generate::<wire::Plan>(),
        generate::<wire::Check>(),
        generate::<wire::LoadRange>(),
        generate::<wire::PartialOrder>(),
        generate::<wire::Certificate>(),
        generate::<wire::Suite>(),
        generate::<wire::JobResult>(),
        generate::<wire::Errors>(),
        generate::<wire::RofiWorld>(),
        generate::<wire::VoxelWorld>(),
    ]
});

fn generate<T: JsonSchema>() -> Value {
    SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<T>().to_value()
}

/// Names of the formats that have a JSON Schema, e.g. `structure`.
pub fn schema_names() -> &'static [&'static str] {
    &NAMES
}

/// The JSON Schema (draft 2020-12) of a format, ending in a line feed; `None` for an unknown name.
pub fn schema(name: &str) -> Option<String> {
    value(name).map(layout::text)
}

/// The schema of a format as a value.
pub(super) fn value(name: &str) -> Option<&'static Value> {
    let index = NAMES.iter().position(|known| *known == name)?;
    Some(&SCHEMAS[index])
}
