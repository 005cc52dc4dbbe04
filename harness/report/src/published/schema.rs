//! The JSON Schema of published tables, for editors.

use schemars::schema_for;
use serde_json::{Value, json};

use super::Table;

/// The schema of a file `reference/published/<paper>/<table>.toml`.
pub fn schema() -> Value {
    let mut root = schema_for!(Table).to_value();
    root["title"] = json!("calibench published table");
    root
}
