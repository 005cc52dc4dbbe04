//! Scales along the sides of a plot.

use crate::axes::number;
use crate::ticks;

/// A scale along a side of a plot.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    /// What it shows, with its unit.
    pub(crate) title: String,
    /// Values at the left and the right end, or at the lower and the upper one.
    pub(crate) ends: [f64; 2],
    /// Whether it is logarithmic.
    pub(crate) log: bool,
    /// Names in place of numbers, at 0, 1, ...
    pub(crate) names: Vec<String>,
}

impl Axis {
    /// A linear one.
    pub(crate) fn linear(title: &str, ends: [f64; 2]) -> Self {
        Self { title: title.to_owned(), ends, log: false, names: Vec::new() }
    }

    /// One with a place for each name.
    pub(crate) fn named(title: &str, names: Vec<String>) -> Self {
        Self { title: title.to_owned(), ends: [-0.5, names.len() as f64 - 0.5], log: false, names }
    }

    /// Where a value stands, 0 to 1.
    pub(super) fn part(&self, value: f64) -> f64 {
        let scaled = |value: f64| if self.log { value.log10() } else { value };
        let [low, high] = self.ends.map(scaled);
        (scaled(value) - low) / (high - low)
    }

    /// Values with numbers or names.
    pub(super) fn ticks(&self) -> Vec<(f64, String)> {
        if !self.names.is_empty() {
            return self.names.iter().enumerate().map(|(place, name)| (place as f64, name.clone())).collect();
        }
        let (low, high) = (self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1]));
        if self.log {
            return ticks::decades(low, high, &[1.0, 2.0, 5.0]).into_iter().map(|value| (value, value.to_string())).collect();
        }
        let values = ticks::linear(low, high);
        values.iter().map(|&value| (value, number(value, &values))).collect()
    }
}
