//! Sweeps: a scenario over values of some of its keys. A cell is the scenario with one value of each.

pub mod read;
mod replace;
pub mod wire;

use std::ops::Range;

use calibench_diagnostics::Problem;
use calibench_measure::Registry;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// More cells than this are not run at one go.
pub const MOST_CELLS: usize = 2000;

/// The swept keys of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// In the order of the file; the last changes fastest.
    pub axes: Vec<Axis>,
    /// The file as the user named it.
    pub file: String,
}

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
    span: Range<usize>,
}

/// One value of a swept key.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// As labels show it.
    pub text: String,
    /// The value, if it is a number.
    pub number: Option<f64>,
    /// TOML whose key `v` has the value, at its place in the file.
    source: String,
    span: Range<usize>,
}

impl Value {
    /// A value as it stands in `text` at `span`.
    fn written(text: &str, span: Range<usize>) -> Self {
        let literal = &text[span.clone()];
        // The same number of bytes before it as in the file: what is wrong inside it is then found at its place.
        let before = span.start.saturating_sub(KEY.len());
        let source = format!("{}{KEY}{literal}", " ".repeat(before));
        let words = literal.split_whitespace().collect::<Vec<_>>().join(" ");
        let plain = words.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(words.clone(), str::to_owned);
        Self { number: number(literal), text: plain, source, span }
    }

    /// A value of the range at `span`.
    fn computed(value: f64, span: Range<usize>) -> Self {
        let text = value.to_string();
        Self { number: Some(value), source: format!("{KEY}{text}"), text, span }
    }

    fn toml(&self) -> Option<Spanned<DeValue<'_>>> {
        let mut table = DeTable::parse(&self.source).ok()?.into_inner();
        let (_, value) = table.remove_entry("v")?;
        Some(Spanned::new(self.span.clone(), value.into_inner()))
    }
}

const KEY: &str = "v = ";

fn number(literal: &str) -> Option<f64> {
    literal.replace('_', "").parse::<f64>().ok().filter(|value| value.is_finite())
}

impl Axis {
    /// Whether all its values are numbers.
    pub fn is_numeric(&self) -> bool {
        self.values.iter().all(|value| value.number.is_some())
    }

    /// Whether this is what the user calls it: its key, or its whole path.
    pub fn is_called(&self, name: &str) -> bool {
        self.path == name || self.name == name || self.path.rsplit('.').next() == Some(name)
    }
}

impl Sweep {
    /// How many cells.
    pub fn cells(&self) -> usize {
        self.axes.iter().map(|axis| axis.values.len()).product()
    }

    /// The place on each axis of cell `index`.
    ///
    /// # Panics
    /// Never for an index below [`Self::cells`].
    pub fn places(&self, mut index: usize) -> Vec<usize> {
        let mut places: Vec<usize> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            places.push(index % axis.values.len());
            index /= axis.values.len();
        }
        places.reverse();
        places
    }

    /// The value on each axis of cell `index`.
    pub fn values(&self, index: usize) -> Vec<&Value> {
        self.axes.iter().zip(self.places(index)).map(|(axis, place)| &axis.values[place]).collect()
    }

    /// The values of cell `index` in a line, as in `blur=0.3, grey_noise=0.01`.
    pub fn label(&self, index: usize) -> String {
        let pairs = self.axes.iter().zip(self.values(index)).map(|(axis, value)| format!("{}={}", axis.name, value.text));
        pairs.collect::<Vec<_>>().join(", ")
    }

    /// The label of method `label` without its swept parameters: what is the same method in all cells.
    pub fn method(&self, label: &str) -> String {
        let Some((name, settings)) = label.split_once(':') else { return label.to_owned() };
        let swept = |setting: &&str| {
            let key = setting.split('=').next().unwrap_or_default();
            self.axes.iter().any(|axis| {
                let parts: Vec<&str> = axis.path.split('.').collect();
                parts.first() == Some(&"method") && parts.last() == Some(&key) && (parts.len() == 2 || parts[1] == name)
            })
        };
        let kept: Vec<&str> = settings.split(',').filter(|setting| !swept(setting)).collect();
        if kept.is_empty() { name.to_owned() } else { format!("{name}:{}", kept.join(",")) }
    }

    /// Whether it changes the methods.
    pub fn changes_methods(&self) -> bool {
        self.axes.iter().any(|axis| axis.path.starts_with("method."))
    }

    /// The table of a file with the values of cell `index` in their places.
    pub(super) fn replaced<'i>(
        &'i self,
        root: &DeTable<'i>,
        index: usize,
        registry: &Registry,
        problems: &mut Vec<Problem>,
    ) -> DeTable<'i> {
        let mut table = root.clone();
        for (axis, value) in self.axes.iter().zip(self.values(index)) {
            if let Some(value) = value.toml() {
                replace::replace(&mut table, axis, &value, registry, problems);
            }
        }
        table
    }
}
