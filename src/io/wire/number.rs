//! Numbers that are always finite, and say their range in the schema.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize, Serializer};

macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident $(, $keyword:literal)?;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(transparent)]
        pub(crate) struct $name(pub(crate) f64);

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                finite(self.0, serializer)
            }
        }

        impl JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({"type": "number" $(, $keyword: 0)?})
            }
        }
    )*};
}

numbers! {
    /// Any number.
    Real;
    /// A number above 0.
    Positive, "exclusiveMinimum";
    /// A number that is 0 or more.
    NonNegative, "minimum";
}

// serde_json would write an infinity or a NaN as `null` without a word.
fn finite<S: Serializer>(value: f64, serializer: S) -> Result<S::Ok, S::Error> {
    if value.is_finite() {
        serializer.serialize_f64(value)
    } else {
        Err(serde::ser::Error::custom(format!("the number {value}")))
    }
}

macro_rules! nullable_numbers {
    ($($(#[$doc:meta])* $name:ident $(, $keyword:literal)?;)*) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
        #[serde(transparent)]
        pub(crate) struct $name(pub(crate) Option<f64>);

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match self.0 {
                    Some(value) => finite(value, serializer),
                    None => serializer.serialize_none(),
                }
            }
        }

        impl JsonSchema for $name {
            fn inline_schema() -> bool {
                true
            }

            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({"type": ["number", "null"] $(, $keyword: 0)?})
            }
        }
    )*};
}

// Unlike an `Option`, these must be written out: a forgotten limit is not an unlimited one.
nullable_numbers! {
    /// A limit of a connector: a number that is 0 or more, or `null` for unlimited.
    Limit, "minimum";
    /// One end of an interval, or `null` where nothing was proved.
    Bound;
}

/// The smallest and the largest of some angles, or `null` where there is no end. It must
/// be written out, as a limit must.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct AngleRange(pub(crate) Option<[Real; 2]>);

impl JsonSchema for AngleRange {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "AngleRange".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({"type": ["array", "null"], "items": {"type": "number"}, "minItems": 2, "maxItems": 2})
    }
}

/// Numbers from plain ones.
pub(crate) fn reals<const N: usize>(values: [f64; N]) -> [Real; N] {
    values.map(Real)
}
