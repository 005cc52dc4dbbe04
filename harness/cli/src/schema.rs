//! `calibench schema`: the JSON Schemas of files that are read and of answers that are given.

use calibench_measure::Registry;
use calibench_report::json::{COMMANDS, schema_of};
use calibench_report::published;
use clap::ValueEnum;
use clap::builder::PossibleValue;

/// What has a JSON Schema.
#[derive(Clone, Copy)]
pub enum Schema {
    /// scenarios/<family>/<name>.toml
    Scenarios,
    /// reference/published/<paper>/<table>.toml
    Tables,
    /// The answer of a command with --json.
    Answer(&'static str),
}

const ALL: [Schema; 2 + COMMANDS.len()] = {
    let mut all = [Schema::Scenarios; 2 + COMMANDS.len()];
    all[1] = Schema::Tables;
    let mut place = 0;
    while place < COMMANDS.len() {
        all[2 + place] = Schema::Answer(COMMANDS[place]);
        place += 1;
    }
    all
};

impl ValueEnum for Schema {
    fn value_variants<'a>() -> &'a [Self] {
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::Scenarios => PossibleValue::new("scenarios").help("scenarios/<family>/<name>.toml"),
            Self::Tables => PossibleValue::new("tables").help("reference/published/<paper>/<table>.toml"),
            Self::Answer(command) => PossibleValue::new(*command).help(format!("What `{command} --json` answers")),
        })
    }
}

impl Schema {
    /// The schema as text, with the methods of `registry`.
    pub fn text(self, registry: &Registry) -> String {
        let schema = match self {
            Self::Scenarios => calibench_scenario::schema::schema(registry),
            Self::Tables => published::schema(),
            Self::Answer(command) => schema_of(command).unwrap_or_default(),
        };
        format!("{schema:#}\n")
    }
}
