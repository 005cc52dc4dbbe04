//! What there is of a kind, as JSON.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use super::Answer;

/// What there is of a kind.
#[derive(Serialize, JsonSchema)]
pub struct ListAnswer {
    /// The kind, as `list` takes it: `scenarios`, `methods`, ...
    pub what: String,
    /// All of them, in the order of the list in words.
    pub items: Vec<Listed>,
}

/// One of what there is.
#[derive(Default, Serialize, JsonSchema)]
pub struct Listed {
    /// Its name, by which commands take it.
    pub name: String,
    /// What it is, or is for, in words.
    pub about: String,
    /// What else is known of it, by a word that all of its kind have in common, as `source`, `version`, `unit`; `unavailable` says why it cannot be used here.
    pub facts: BTreeMap<String, String>,
    /// The parameters that a method takes; of other kinds there are none.
    pub parameters: Vec<ListedParameter>,
}

/// A parameter of a method.
#[derive(Serialize, JsonSchema)]
pub struct ListedParameter {
    /// Its name, as in `forstner:NAME=VALUE`.
    pub name: String,
    /// Its value where none is given.
    pub default: String,
    /// What it is, with its unit.
    pub about: String,
    /// Which values it takes, in words.
    pub values: String,
}

impl Listed {
    /// Of this name, with what is known of it; what is empty is left out.
    pub fn new<'f>(name: impl Into<String>, about: impl Into<String>, facts: impl IntoIterator<Item = (&'f str, String)>) -> Self {
        let facts = facts.into_iter().filter(|(_, fact)| !fact.is_empty()).map(|(word, fact)| (word.to_owned(), fact));
        Self { name: name.into(), about: about.into(), facts: facts.collect(), parameters: Vec::new() }
    }
}

impl Answer for ListAnswer {
    const COMMAND: &'static str = "list";
    const SCHEMA: u32 = 1;
}
