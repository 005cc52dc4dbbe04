//! A table of a scenario file, read into a type that describes itself.

use std::ops::Range;

use calibench_diagnostics::{Problem, nearest};
use schemars::{JsonSchema, Schema, schema_for};
use serde::de::DeserializeOwned;
use toml::Spanned;
use toml::de::{DeTable, DeValue, ValueDeserializer};

/// A table and where it stands.
pub struct Section<'i> {
    /// What it is called in messages, as in `[[method]]`.
    pub name: &'static str,
    /// Where it stands.
    pub span: Range<usize>,
    /// What it holds.
    pub table: DeTable<'i>,
}

impl<'i> Section<'i> {
    /// Takes the table of key `key` out of this one. A value of another type is a problem.
    pub fn take_table(&mut self, key: &str, name: &'static str, problems: &mut Vec<Problem>) -> Option<Section<'i>> {
        let (key_span, value) = self.take(key)?;
        match value.into_inner() {
            DeValue::Table(table) => Some(Section { name, span: key_span, table }),
            other => {
                problems.push(Problem::new(key_span, format!("`{key}` is a table, {name}, found {}", article(other.type_str()))));
                None
            }
        }
    }

    /// Takes the array of tables of key `key` out of this one, each element as a section. `None` if there is no such key.
    pub fn take_tables(&mut self, key: &str, name: &'static str, problems: &mut Vec<Problem>) -> Option<Vec<Section<'i>>> {
        let (key_span, value) = self.take(key)?;
        let DeValue::Array(elements) = value.get_ref() else {
            let found = article(value.get_ref().type_str());
            problems.push(Problem::new(key_span, format!("`{key}` is a list of tables, {name}, found {found}")));
            return None;
        };
        let mut sections = Vec::new();
        for element in elements {
            match element.get_ref() {
                DeValue::Table(table) => sections.push(Section { name, span: element.span(), table: table.clone() }),
                other => {
                    problems.push(Problem::new(element.span(), format!("expected a table, {name}, found {}", article(other.type_str()))));
                }
            }
        }
        Some(sections)
    }

    /// Takes those of `keys` that there are out of this table, as one of their own.
    pub fn take_keys(&mut self, keys: &[&str]) -> Section<'i> {
        let mut table = DeTable::new();
        for key in keys {
            if let Some((key, value)) = self.table.remove_entry(*key) {
                table.insert(key, value);
            }
        }
        Section { name: self.name, span: self.span.clone(), table }
    }

    /// Takes key `key` and its value out of the table.
    pub fn take(&mut self, key: &str) -> Option<(Range<usize>, Spanned<DeValue<'i>>)> {
        let (key, value) = self.table.remove_entry(key)?;
        Some((key.span(), value))
    }

    /// Reads all keys into `T`, whose JSON Schema says which there are and which must be. `taken` are keys that were taken out before, for proposals.
    ///
    /// Unknown keys, missing keys and values of the wrong form are problems.
    pub fn read<T: DeserializeOwned + JsonSchema>(self, taken: &[&str], problems: &mut Vec<Problem>) -> Option<T> {
        if !self.has_the_keys(&schema_for!(T), taken, problems) {
            return None;
        }
        let span = self.span.clone();
        let whole = ValueDeserializer::from(Spanned::new(span.clone(), DeValue::Table(self.table)));
        T::deserialize(whole).map_err(|error| problems.push(Problem::new(error.span().unwrap_or(span), plain(error.message())))).ok()
    }

    /// Whether the keys are those of `schema`: none that it does not have, all that it requires. Not in [`Self::read`], which is compiled for every type.
    fn has_the_keys(&self, schema: &Schema, taken: &[&str], problems: &mut Vec<Problem>) -> bool {
        let before = problems.len();
        let properties = schema.get("properties").and_then(|p| p.as_object());
        let known: Vec<&str> = properties.iter().flat_map(|p| p.keys()).map(String::as_str).chain(taken.iter().copied()).collect();
        // A misspelt key is one mistake, not a missing one as well.
        let mut meant: Vec<&str> = Vec::new();
        for (key, _) in &self.table {
            let name: &str = key.get_ref();
            if !known.contains(&name) {
                let message = format!("unknown key `{name}` in {}: expected {}", self.name, listed(&known));
                meant.extend(nearest(name, known.iter().copied()));
                problems.push(Problem::new(key.span(), message).nearest(name, known.iter().copied()));
            }
        }
        let required = schema.get("required").and_then(|r| r.as_array());
        for key in required.into_iter().flatten().filter_map(|key| key.as_str()) {
            if !self.table.contains_key(key) && !meant.contains(&key) {
                let about = properties.and_then(|p| p.get(key)?.get("description")?.as_str()).unwrap_or_default();
                problems.push(Problem::new(self.span.clone(), format!("{} has no `{key}`", self.name)).help(format!("`{key}`: {about}")));
            }
        }
        problems.len() == before
    }
}

/// serde names Rust's types; a scenario's author knows numbers.
fn plain(message: &str) -> String {
    let words = [
        ("i64", "a whole number"),
        ("u64", "a whole number"),
        (" as i128", ""),
        ("f64", "a number"),
        ("bool", "true or false"),
        ("type: map", "type: a table"),
        ("type: sequence", "type: a list"),
        ("a sequence", "a list"),
    ];
    words.iter().fold(message.to_owned(), |text, (rust, word)| text.replace(rust, word))
}

fn article(kind: &str) -> String {
    let an = kind.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {kind}", if an { "an" } else { "a" })
}

fn listed(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}
