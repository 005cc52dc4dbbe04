//! Least squares in a few unknowns: normal equations that are summed up, and damped steps.

use std::convert::Infallible;

use nalgebra::{SMatrix, SVector};

use crate::descent::{Damping, Descent, descend};

/// None at last.
const DAMPING: Damping = Damping { first: 1e-5, again: 1e-16, least: 2e-15, rest: 0.0, most: 2e9, factors: (0.05, 20.0) };

/// Steps at most.
const MOST_STEPS: usize = 100;
/// A predicted fall of the sum of squares, px^2 for each row, below which nothing is left to gain.
const NOTHING: f64 = 1e-22;
/// Share of the sum of squares that is beyond its digits.
const DIGITS: f64 = 1e-13;
/// Of a normal matrix of unit diagonal: the inverse's diagonal is 1 / (1 - R^2), with R the multiple correlation with the other unknowns.
const MOST_INFLATION: f64 = 1e13;

/// Normal equations of rows `v = a dx + w`, of weight one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Normal<const N: usize> {
    matrix: SMatrix<f64, N, N>,
    right: SVector<f64, N>,
    /// The sum of the squares of `w`.
    pub(super) squares: f64,
    rows: usize,
}

impl<const N: usize> Normal<N> {
    pub(super) fn new() -> Self {
        Self { matrix: SMatrix::zeros(), right: SVector::zeros(), squares: 0.0, rows: 0 }
    }

    /// Adds the row `v = a dx + w`; only the lower triangle of the matrix is kept.
    pub(super) fn add(&mut self, a: &SVector<f64, N>, w: f64) {
        for j in 0..N {
            for i in j..N {
                self.matrix[(i, j)] += a[i] * a[j];
            }
            self.right[j] -= a[j] * w;
        }
        self.squares += w * w;
        self.rows += 1;
    }

    /// Adds `rows` rows by the products of their columns with each other: unknowns, then `w`; `width` numbers a row of products, of which those on and below the diagonal count.
    pub(super) fn add_products(&mut self, products: &[f64], width: usize, rows: usize) {
        for j in 0..N {
            for i in j..N {
                self.matrix[(i, j)] += products[i * width + j];
            }
            self.right[j] -= products[N * width + j];
        }
        self.squares += products[N * width + N];
        self.rows += rows;
    }

    /// The same equations for other unknowns, of which `by` makes these.
    pub(super) fn of_others(&self, by: &SMatrix<f64, N, N>) -> Self {
        let whole = SMatrix::from_fn(|i, j| self.matrix[(i.max(j), i.min(j))]);
        Self { matrix: by.transpose() * whole * by, right: by.transpose() * self.right, ..*self }
    }

    /// Rows minus unknowns, none if negative.
    pub(super) fn redundancy(&self) -> usize {
        self.rows.saturating_sub(N)
    }

    /// Lengths that scale the matrix to a unit diagonal; `None` if an unknown has no effect.
    fn scales(&self) -> Option<SVector<f64, N>> {
        let scales = SVector::<f64, N>::from_fn(|i, _| 1.0 / self.matrix[(i, i)].sqrt());
        scales.iter().all(|scale| scale.is_finite()).then_some(scales)
    }

    fn scaled(&self, scales: &SVector<f64, N>, damping: f64) -> SMatrix<f64, N, N> {
        let damped = |i: usize, j: usize| if i == j { damping } else { 0.0 };
        SMatrix::from_fn(|i, j| self.matrix[(i.max(j), i.min(j))] * scales[i] * scales[j] + damped(i, j))
    }

    /// The damped step and the fall of the squares that it predicts.
    fn step(&self, damping: f64) -> Option<(SVector<f64, N>, f64)> {
        let scales = self.scales()?;
        let right = self.right.component_mul(&scales);
        let scaled = self.scaled(&scales, damping).cholesky()?.solve(&right);
        let step = scaled.component_mul(&scales);
        step.iter().all(|value| value.is_finite()).then(|| (step, right.dot(&scaled)))
    }

    /// The inverse of the normal matrix; `None` if the rows do not determine every unknown.
    pub(super) fn cofactor(&self) -> Option<SMatrix<f64, N, N>> {
        let scales = self.scales()?;
        let inverse = self.scaled(&scales, 0.0).cholesky()?.inverse();
        let determined = inverse.diagonal().iter().all(|&inflation| inflation < MOST_INFLATION);
        determined.then(|| SMatrix::from_fn(|i, j| inverse[(i, j)] * scales[i] * scales[j]))
    }
}

/// Values at which the squares stand, on their way down.
struct Place<S, N, M, const U: usize> {
    state: S,
    here: Normal<U>,
    step: SVector<f64, U>,
    /// The sum of the squares before the last step.
    before: f64,
    normal: N,
    moved: M,
}

impl<S, N, M, const U: usize> Descent for Place<S, N, M, U>
where
    N: Fn(&S) -> Option<Normal<U>>,
    M: Fn(&S, &SVector<f64, U>) -> S,
{
    type Lost = Infallible;

    fn step(&mut self, damping: f64) -> Option<f64> {
        let (step, promised) = self.here.step(damping)?;
        self.step = step;
        Some(promised)
    }

    fn arrives(&mut self, promised: f64) -> bool {
        let arrives = promised <= DIGITS * self.here.squares;
        if arrives {
            self.state = (self.moved)(&self.state, &self.step);
        }
        arrives
    }

    fn go(&mut self) -> Result<bool, Infallible> {
        self.before = self.here.squares;
        let trial = (self.moved)(&self.state, &self.step);
        let better = (self.normal)(&trial).filter(|trial| trial.squares < self.before);
        let lower = better.is_some();
        if let Some(better) = better {
            (self.state, self.here) = (trial, better);
        }
        Ok(lower)
    }

    fn ends(&self, promised: f64, _: f64, lower: bool) -> bool {
        promised <= NOTHING * self.here.rows as f64 || (!lower && promised <= DIGITS * self.before)
    }
}

/// The least-squares solution from `start`, with its normal equations. `None` if `normal` has none for the start.
///
/// The last step is that of Gauss-Newton, where the sum of squares has no digits left to judge it by.
pub(super) fn minimise<S, const U: usize>(
    start: S,
    normal: impl Fn(&S) -> Option<Normal<U>>,
    moved: impl Fn(&S, &SVector<f64, U>) -> S,
) -> Option<(S, Normal<U>)> {
    let here = normal(&start).filter(|normal| normal.squares.is_finite())?;
    let mut place = Place { state: start, here, step: SVector::zeros(), before: here.squares, normal, moved };
    let Ok(_) = descend(&mut place, &DAMPING, MOST_STEPS);
    Some((place.state, place.here))
}

#[cfg(test)]
impl<const N: usize> Normal<N> {
    /// The largest difference of two, of matrices and right sides of unit diagonal, and of the squares.
    pub(super) fn differs(&self, other: &Self) -> f64 {
        let Some(scales) = self.scales() else { return f64::INFINITY };
        let matrices = (self.scaled(&scales, 0.0) - other.scaled(&scales, 0.0)).amax();
        let size = self.squares.sqrt();
        let right = (self.right - other.right).component_mul(&scales).amax() / size;
        let squares = (self.squares / other.squares - 1.0).abs();
        if self.rows == other.rows { matrices.max(right).max(squares) } else { f64::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// y = a exp(b x), without noise: the end is exact.
    #[test]
    fn an_exponential_is_found_from_afar() {
        let truth = SVector::<f64, 2>::new(2.0, -0.7);
        let at = |p: &SVector<f64, 2>, x: f64| p[0] * (p[1] * x).exp();
        let normal = |p: &SVector<f64, 2>| {
            let mut normal = Normal::new();
            for x in [0.0, 0.5, 1.0, 2.0, 4.0] {
                normal.add(&SVector::<f64, 2>::new((p[1] * x).exp(), x * at(p, x)), at(p, x) - at(&truth, x));
            }
            Some(normal)
        };
        let (found, normal) = minimise(SVector::<f64, 2>::new(0.5, 0.5), normal, |p, step| p + step).unwrap();
        assert!((found - truth).norm() < 1e-14, "{found}");
        assert_eq!(normal.redundancy(), 3);
        assert!(normal.cofactor().is_some());
    }

    #[test]
    fn what_the_rows_do_not_determine_has_no_cofactor() {
        let mut normal = Normal::<2>::new();
        [1.0, 2.0, 3.0].iter().for_each(|&x| normal.add(&SVector::<f64, 2>::new(x, 2.0 * x), 1.0));
        assert!(normal.cofactor().is_none());
        assert!(Normal::<2>::new().cofactor().is_none());
    }
}
