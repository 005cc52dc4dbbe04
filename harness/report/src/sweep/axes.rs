//! Axes: from values to parts of a side, with ticks.

use calibench_records::description::Axis;

use crate::ticks;

/// Where the values of a swept key lie along a side, as parts of it, and how the ticks are labelled.
pub struct Places {
    /// From 0 to 1, in the order of the axis.
    pub parts: Vec<f64>,
    /// In the same order.
    pub labels: Vec<String>,
}

/// Room at both ends of a side, as a part of it.
const MARGIN: f64 = 0.05;

impl Places {
    /// To scale where all values are numbers, else at equal distances.
    pub fn of(axis: &Axis) -> Self {
        let labels = axis.values.iter().map(|value| super::units::label(axis, value)).collect();
        let numbers: Option<Vec<f64>> =
            axis.values.iter().map(|value| value.number.map(|number| super::units::position(axis, number))).collect();
        let last = (axis.values.len() - 1).max(1) as f64;
        let numbers = numbers.unwrap_or_else(|| (0..axis.values.len()).map(|index| index as f64).collect());
        let positions: Vec<f64> = if axis.log { numbers.iter().map(|value| value.ln()).collect() } else { numbers };
        let low = positions.iter().copied().fold(f64::INFINITY, f64::min);
        let high = positions.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let span = if high > low { high - low } else { last };
        let part = |position: &f64| if high > low { MARGIN + (1.0 - 2.0 * MARGIN) * (position - low) / span } else { 0.5 };
        Self { parts: positions.iter().map(part).collect(), labels }
    }

    /// The ticks whose labels do not run into each other on a side of `length` px of the picture.
    pub fn ticks(&self, length: u32) -> Vec<(f64, &str)> {
        let mut order: Vec<usize> = (0..self.parts.len()).collect();
        order.sort_by(|a, b| self.parts[*a].total_cmp(&self.parts[*b]));
        let mut ticks: Vec<(f64, &str)> = Vec::new();
        let mut end = f64::NEG_INFINITY;
        for index in order {
            let (middle, half) = (self.parts[index] * f64::from(length), 4.5 * self.labels[index].chars().count() as f64 + 4.0);
            if middle - half >= end {
                end = middle + half;
                ticks.push((self.parts[index], &self.labels[index]));
            }
        }
        ticks
    }
}

/// A scale of figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    low: f64,
    high: f64,
    log: bool,
}

/// Figures that span more than this factor are drawn on a logarithmic scale.
const WIDE: f64 = 8.0;

impl Scale {
    /// A scale that holds `values`: logarithmic where they are positive and span a wide range.
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let low = values.clone().fold(f64::INFINITY, f64::min);
        let high = values.fold(f64::NEG_INFINITY, f64::max);
        if !low.is_finite() || !high.is_finite() {
            return Self { low: 0.0, high: 1.0, log: false };
        }
        if low > 0.0 && high / low > WIDE {
            return Self { low: low / 1.3, high: high * 1.3, log: true };
        }
        let top = if high > 0.0 { high * 1.1 } else { 1.0 };
        Self { low: low.min(0.0), high: top, log: false }
    }

    /// Where `value` lies, 0 at the low end and 1 at the high one; values beyond are held at the ends.
    pub fn part(&self, value: f64) -> f64 {
        let part = if self.log {
            (value.max(f64::MIN_POSITIVE) / self.low).ln() / (self.high / self.low).ln()
        } else {
            (value - self.low) / (self.high - self.low)
        };
        part.clamp(0.0, 1.0)
    }

    /// Round values with their labels, from 3 to about 9.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let values = if self.log { self.factors() } else { ticks::linear(self.low, self.high) };
        values.into_iter().map(|value| (value, format!("{}", (value * 1e9).round() / 1e9))).collect()
    }

    fn factors(&self) -> Vec<f64> {
        let decades = (self.high / self.low).log10();
        let within: &[f64] = if decades > 4.0 {
            &[1.0]
        } else if decades > 2.0 {
            &[1.0, 3.0]
        } else {
            &[1.0, 2.0, 5.0]
        };
        ticks::decades(self.low, self.high, within)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_ranges_are_logarithmic_with_round_ticks() {
        let scale = Scale::of([0.012, 0.3].into_iter());
        let labels: Vec<String> = scale.ticks().into_iter().map(|tick| tick.1).collect();
        assert_eq!(labels, ["0.01", "0.02", "0.05", "0.1", "0.2"]);
        assert!((scale.part((0.012_f64 * 0.3).sqrt()) - 0.5).abs() < 1e-12, "the geometric mean lies in the middle");
    }

    #[test]
    fn narrow_ranges_and_zeros_are_linear_from_zero() {
        let scale = Scale::of([0.0, 100.0].into_iter());
        assert_eq!(scale.ticks().iter().map(|tick| tick.0).collect::<Vec<_>>(), [0.0, 50.0, 100.0]);
        assert!((scale.part(55.0) - 0.5).abs() < 1e-12);
        assert_eq!((scale.part(-1.0), scale.part(1e9)), (0.0, 1.0));
        assert_eq!(Scale::of(std::iter::empty()).part(0.5), 0.5);
    }
}
