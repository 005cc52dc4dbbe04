//! `calibench schema`.

use calibench_measure::Registry;
use calibench_report::published;
use clap::ValueEnum;

/// Files that have a JSON Schema.
#[derive(Clone, Copy, ValueEnum)]
pub enum Schema {
    /// scenarios/<family>/<name>.toml
    Scenarios,
    /// reference/published/<paper>/<table>.toml
    Tables,
}

impl Schema {
    /// The schema as text, with the methods of `registry`.
    pub fn text(self, registry: &Registry) -> String {
        match self {
            Self::Scenarios => format!("{:#}\n", calibench_scenario::schema::schema(registry)),
            Self::Tables => format!("{:#}\n", published::schema()),
        }
    }
}
