//! Errors against what an adjustment says of them.

use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Iterations of an adjustment from the truth at most.
pub(super) const ITERATIONS: usize = 1000;
/// A weighted sum of squares that is larger by no more than this share is that of the same minimum.
const SAME: f64 = 1e-4;

/// The probability of a region.
const REGION: f64 = 0.95;

/// What every network says of itself.
pub(super) struct Whole {
    pub(super) cost: f64,
    pub(super) redundancy: i64,
    pub(super) image_points: usize,
    pub(super) in_doubt: bool,
    /// The weighted sum of squares of the minimum that the truth leads to; `None` where it leads to none.
    pub(super) from_truth: Option<f64>,
}

impl Whole {
    /// Cost, redundancy, whether it is doubted, whether it ended in a wrong minimum.
    pub(super) fn figures(&self) -> Vec<Figure> {
        let is = |yes: bool| f64::from(u8::from(yes));
        let is_wrong = self.from_truth.map(|least| is_wrong(self.cost, least));
        let mut figures = vec![
            Figure::plain(Quantity::CostOverRedundancy, self.cost / self.redundancy as f64, ""),
            Figure::plain(Quantity::Redundancy, self.redundancy as f64, ""),
            Figure::plain(Quantity::ImagePoints, self.image_points as f64, ""),
            Figure::plain(Quantity::IsDoubtful, is(self.in_doubt), ""),
        ];
        figures.extend(is_wrong.map(|wrong| Figure::plain(Quantity::IsWrongMinimum, is(wrong), "")));
        figures.extend(is_wrong.map(|wrong| Figure::plain(Quantity::IsWrongMinimumAndSilent, is(wrong && !self.in_doubt), "")));
        figures
    }
}

/// Whether the truth leads to a lower minimum than the one that was found.
pub(super) fn is_wrong(found: f64, from_truth: f64) -> bool {
    found > from_truth * (1.0 + SAME)
}

/// The square of all errors together in their covariance, over their number, and whether it is in the region of 95 %; none where the covariance is none.
/// The covariance has the estimated variance factor: over their number the square has Fisher's distribution.
pub(super) fn together(errors: &DVector<f64>, covariance: &DMatrix<f64>, redundancy: i64) -> Vec<Figure> {
    let count = errors.len();
    // Parameters differ by ten powers of ten.
    let scale: Vec<f64> = (0..count).map(|i| covariance[(i, i)].max(f64::MIN_POSITIVE).sqrt()).collect();
    let correlations = DMatrix::from_fn(count, count, |i, j| covariance[(i, j)] / (scale[i] * scale[j]));
    let scaled = DVector::from_fn(count, |i, _| errors[i] / scale[i]);
    let Some(factor) = correlations.cholesky().filter(|_| count > 0) else { return Vec::new() };
    let mean = scaled.dot(&factor.solve(&scaled)) / count as f64;
    let mut figures = vec![Figure::plain(Quantity::SquareOverCovariance, mean, "")];
    figures.extend(is_within(mean, count, redundancy).map(|within| Figure::plain(Quantity::WithinRegion, within, "")));
    figures
}

/// Of lengths, each with its error and standard deviation: the mean square of errors over standard deviations, and the share within intervals of 95 %.
pub(super) fn lengths(all: &[(f64, f64)], redundancy: i64) -> Vec<Figure> {
    let squares: Vec<f64> = all.iter().map(|(error, sigma)| (error / sigma).powi(2)).collect();
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let within: Option<Vec<f64>> = squares.iter().map(|square| is_within(*square, 1, redundancy)).collect();
    let Some(within) = within.filter(|within| !within.is_empty()) else { return Vec::new() };
    vec![Figure::plain(Quantity::SquareOfLengths, mean(&squares), ""), Figure::plain(Quantity::LengthsWithin, mean(&within), "")]
}

/// 1 within the region, 0 without.
fn is_within(mean_square: f64, count: usize, redundancy: i64) -> Option<f64> {
    let fisher = FisherSnedecor::new(count as f64, redundancy as f64).ok()?;
    Some(f64::from(u8::from(fisher.cdf(mean_square) <= REGION)))
}

#[cfg(test)]
mod tests {
    use calibench_records::results::find;

    use super::*;

    fn value(figures: &[Figure], quantity: Quantity) -> Option<f64> {
        find(figures, quantity).map(|figure| figure.value)
    }

    /// Of two parameters whose correlation is 0.8 errors of one sign are common and those of two are not; F(0.95; 2, 60) is 3.15.
    #[test]
    fn errors_are_measured_in_their_covariance() {
        // Standard deviations of 1e4 and 1e-5.
        let covariance = DMatrix::from_row_slice(2, 2, &[1e8, 0.08, 0.08, 1e-10]);
        let of = |a: f64, b: f64| together(&DVector::from_row_slice(&[1e4 * a, 1e-5 * b]), &covariance, 60);
        let square = |a: f64, b: f64| (a * a - 2.0 * 0.8 * a * b + b * b) / (1.0 - 0.64) / 2.0;
        for (a, b) in [(1.0, 1.0), (1.0, -1.0), (2.3, 0.4)] {
            assert!((value(&of(a, b), Quantity::SquareOverCovariance).unwrap() - square(a, b)).abs() < 1e-9);
        }
        // 3.14 and 3.16 times the number of parameters.
        let at = |mean: f64| (2.0 * mean * (1.0 - 0.64) / 3.6_f64).sqrt();
        assert_eq!(value(&of(at(3.1), -at(3.1)), Quantity::WithinRegion), Some(1.0));
        assert_eq!(value(&of(at(3.16), -at(3.16)), Quantity::WithinRegion), Some(0.0));
        let singular = DMatrix::from_element(2, 2, 1.0);
        assert!(together(&DVector::zeros(2), &singular, 60).is_empty());
    }

    /// Student's t for 30 degrees of freedom is 2.042.
    #[test]
    fn lengths_are_within_their_intervals() {
        let figures = lengths(&[(2.04, 1.0), (-4.1, 2.0), (0.0, 3.0), (-6.12, 3.0)], 30);
        assert_eq!(value(&figures, Quantity::LengthsWithin), Some(0.75));
        let squares = (2.04_f64.powi(2) + 2.05_f64.powi(2) + 2.04_f64.powi(2)) / 4.0;
        assert!((value(&figures, Quantity::SquareOfLengths).unwrap() - squares).abs() < 1e-12);
        assert!(lengths(&[], 30).is_empty() && lengths(&[(1.0, 1.0)], 0).is_empty());
    }

    #[test]
    fn a_wrong_minimum_is_silent_where_nothing_is_doubted() {
        let of = |cost: f64, in_doubt: bool, from_truth: Option<f64>| {
            let figures = Whole { cost, redundancy: 100, image_points: 70, in_doubt, from_truth }.figures();
            (value(&figures, Quantity::IsWrongMinimum), value(&figures, Quantity::IsWrongMinimumAndSilent))
        };
        assert_eq!(of(100.0, false, Some(99.995)), (Some(0.0), Some(0.0)));
        assert_eq!(of(100.0, false, Some(99.9)), (Some(1.0), Some(1.0)));
        assert_eq!(of(100.0, true, Some(99.9)), (Some(1.0), Some(0.0)));
        assert_eq!(of(100.0, false, None), (None, None));
    }
}
