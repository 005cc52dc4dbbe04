//! The `[sweep]` table as it is written.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use toml::Spanned;

use crate::wire::bounded;

bounded! {
    /// An end of a range.
    End(f64), f64 "f64", -1e15, 1e15;
    /// How many values.
    Count(usize), i64 "i64", 2, 1000;
}

/// Values from one end to the other, both among them.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct RangeWire {
    /// The first value.
    #[schemars(with = "End")]
    pub from: Spanned<End>,
    /// The last value.
    #[schemars(with = "End")]
    pub to: Spanned<End>,
    /// How many values, both ends among them.
    pub count: Count,
    /// `linear` (default): equal differences. `log`: equal factors.
    pub scale: Option<Scale>,
}

/// How a range is divided.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Scale {
    /// Equal differences.
    #[default]
    Linear,
    /// Equal factors.
    Log,
}

/// The `[sweep]` table, for the schema: its keys are paths of keys of the file.
pub struct SweepWire;

impl JsonSchema for SweepWire {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Sweep".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let range = RangeWire::json_schema(generator);
        json_schema!({
            "type": "object",
            "description": "Runs the scenario once for each combination of values. Keys are those of the file with their tables, as in \"optics.blur\" or \"method.window\".",
            "minProperties": 1,
            "additionalProperties": { "anyOf": [{ "type": "array", "minItems": 1 }, range, { "type": "object" }] }
        })
    }
}
