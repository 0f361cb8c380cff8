//! The committed JSON Schemas are those of the types. After a change of a
//! format, `STEADFAST_WRITE=1 cargo test --test schemas` writes them anew.

use steadfast::io::{schema, schema_names};

#[test]
fn the_committed_schemas_are_those_of_the_types() {
    for name in schema_names() {
        let path = problems::root().join("schema").join(format!("{name}.schema.json"));
        let made = schema(name).unwrap();
        if std::env::var_os("STEADFAST_WRITE").is_some() {
            std::fs::write(&path, &made).unwrap();
        }
        let committed = std::fs::read_to_string(&path).unwrap_or_default();
        assert!(committed == made, "{} is out of date", path.display());
    }
}

#[test]
fn unknown_names_have_no_schema() {
    assert_eq!(schema("robot"), None);
}
