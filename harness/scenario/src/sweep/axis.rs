//! A swept key and its values.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A swept key with its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The key with its tables, as in `optics.blur`.
    pub path: String,
    /// What reports call it: the key alone where that is no other axis' too, as in `blur`.
    pub name: String,
    /// Its values, as they are written.
    pub values: Vec<Value>,
    /// Whether steps are factors, not differences.
    pub log: bool,
    /// Where the key stands.
    pub(super) span: Range<usize>,
}

/// One value of a swept key.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// As labels show it.
    pub text: String,
    /// The value, if it is a number, in the unit of its key.
    pub number: Option<f64>,
    /// TOML whose key `v` has the value, at its place in the file.
    source: String,
    pub(super) span: Range<usize>,
}

impl Value {
    /// A value as it stands in `text` at `span`.
    pub(super) fn written(text: &str, span: Range<usize>) -> Self {
        let literal = &text[span.clone()];
        // The same number of bytes before it as in the file: what is wrong inside it is then found at its place.
        let before = span.start.saturating_sub(KEY.len());
        let source = format!("{}{KEY}{literal}", " ".repeat(before));
        let words = literal.split_whitespace().collect::<Vec<_>>().join(" ");
        let plain = words.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(words.clone(), str::to_owned);
        Self { number: number(literal), text: plain, source, span }
    }

    /// A value of the range at `span`.
    pub(super) fn computed(value: f64, span: Range<usize>) -> Self {
        let text = value.to_string();
        Self { number: Some(value), source: format!("{KEY}{text}"), text, span }
    }

    pub(super) fn toml(&self) -> Option<Spanned<DeValue<'_>>> {
        let mut table = DeTable::parse(&self.source).ok()?.into_inner();
        let (_, value) = table.remove_entry("v")?;
        Some(Spanned::new(self.span.clone(), value.into_inner()))
    }
}

const KEY: &str = "v = ";

fn number(literal: &str) -> Option<f64> {
    literal.replace('_', "").parse::<f64>().ok().filter(|value| value.is_finite())
}
