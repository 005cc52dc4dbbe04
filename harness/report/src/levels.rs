//! Round levels of a logarithmic scale, and where a grid of values crosses them.

use crate::ticks::decades;

/// Most levels of a map.
const MOST: usize = 7;

/// A logarithmic scale from the least to the largest value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scale {
    low: f64,
    high: f64,
}

impl Scale {
    /// Over positive `values`; `None` without any. Values hardly different get a scale of a factor of two about them.
    pub(crate) fn of(values: &[f64]) -> Option<Self> {
        let positive = || values.iter().copied().filter(|value| *value > 0.0 && value.is_finite());
        let (low, high) = (positive().reduce(f64::min)?, positive().reduce(f64::max)?);
        let widen = (2.0 * low / high).max(1.0).sqrt();
        Some(Self { low: low / widen, high: high * widen })
    }

    /// Where a value stands, 0 to 1; what is not positive stands at 0.
    pub(crate) fn part(&self, value: f64) -> f64 {
        if value > self.low { (value / self.low).ln() / (self.high / self.low).ln() } else { 0.0 }.clamp(0.0, 1.0)
    }

    /// Round values within the scale: 1, 2, 5 of each decade, or 1 and 3, or 1 alone where these were too many.
    pub(crate) fn levels(&self) -> Vec<f64> {
        let choices: [&[f64]; 4] = [&[1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0], &[1.0, 2.0, 5.0], &[1.0, 3.0], &[1.0]];
        let found: Vec<Vec<f64>> = choices.iter().map(|factors| decades(self.low, self.high, factors)).collect();
        let few = |levels: &&Vec<f64>| levels.len() <= MOST;
        found.iter().find(few).or(found.last()).cloned().unwrap_or_default()
    }
}

/// The pieces of the line on which a grid of values, `columns` x `rows` row by row, has the value `level`: two ends each, in columns and rows of the grid.
///
/// Source: Lorensen & Cline 1987, in two dimensions; values are taken for linear along the edges. Cells with a value that is no number have no line.
pub(crate) fn contour(values: &[f64], (columns, rows): (usize, usize), level: f64) -> Vec<[(f64, f64); 2]> {
    let at = |c: usize, r: usize| values[r * columns + c];
    let mut pieces = Vec::new();
    for (row, column) in (1..rows).flat_map(|row| (1..columns).map(move |column| (row - 1, column - 1))) {
        if [(0, 0), (1, 0), (1, 1), (0, 1)].iter().any(|(c, r)| !at(column + c, row + r).is_finite()) {
            continue;
        }
        let corners = [(column, row), (column + 1, row), (column + 1, row + 1), (column, row + 1)];
        let crossing = |i: usize| {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            let (from, to) = (at(a.0, a.1), at(b.0, b.1));
            let between = (from < level) != (to < level);
            let part = (level - from) / (to - from);
            let along = |a: usize, b: usize| a as f64 + (b as f64 - a as f64) * part;
            between.then(|| (along(a.0, b.0), along(a.1, b.1)))
        };
        let found: Vec<_> = (0..4).filter_map(crossing).collect();
        pieces.extend(found.chunks_exact(2).map(|ends| [ends[0], ends[1]]));
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_round_and_few() {
        let levels = |values: &[f64]| Scale::of(values).unwrap().levels();
        assert_eq!(levels(&[0.011, 0.9]), [0.02, 0.05, 0.1, 0.2, 0.5]);
        assert_eq!(levels(&[1e-4, 0.5]), [1e-4, 1e-3, 0.01, 0.1]);
        assert!((2..=7).contains(&levels(&[0.05, 0.0501]).len()), "{:?}", levels(&[0.05, 0.0501]));
        assert_eq!(Scale::of(&[0.0, f64::NAN]), None);
        let scale = Scale::of(&[0.01, 1.0]).unwrap();
        assert!((scale.part(0.1) - 0.5).abs() < 1e-12 && scale.part(0.0) == 0.0 && scale.part(7.0) == 1.0);
    }

    /// Analytic truth: the levels of a paraboloid are circles.
    #[test]
    fn contours_of_a_paraboloid_are_circles() {
        let values: Vec<f64> = (0..41 * 41).map(|i| f64::from(i % 41 - 20).powi(2) + f64::from(i / 41 - 20).powi(2)).collect();
        let pieces = contour(&values, (41, 41), 150.0);
        assert!(pieces.len() > 60);
        let holed: Vec<f64> = values.iter().enumerate().map(|(i, value)| if i == 840 { f64::NAN } else { *value }).collect();
        // The circle of level 0.5 lies in the four cells around the middle alone.
        assert!(!contour(&values, (41, 41), 0.5).is_empty() && contour(&holed, (41, 41), 0.5).is_empty());
        for (x, y) in pieces.into_iter().flatten() {
            assert!(((x - 20.0).hypot(y - 20.0) - 150_f64.sqrt()).abs() < 0.02, "{x} {y}");
        }
    }
}
