//! Least squares for a handful of unknowns: Gauss-Newton, with Marquardt's damping while it is needed.

pub(crate) mod descent;

use calibench_model::{Covariance, Rejection};
use descent::{Damping, Descent, Gone, descend};
use nalgebra::{SMatrix, SVector};

use crate::cholesky::{self, Factor};

/// The normal equations at one place, and the sum of the squared residuals there.
#[derive(Clone)]
pub(crate) struct Normal<const P: usize> {
    /// `J^T J`.
    pub(crate) n: SMatrix<f64, P, P>,
    /// `J^T r`, r observed minus modelled.
    pub(crate) b: SVector<f64, P>,
    /// `r^T r`.
    pub(crate) omega: f64,
}

/// What is fitted. The first two unknowns are the position, px.
pub(crate) trait Problem<const P: usize> {
    /// The normal equations at `x`; `None` where the model has no meaning.
    fn normal(&mut self, x: &SVector<f64, P>) -> Option<Normal<P>>;
    /// The smallest value of an unknown.
    fn lowest(&self, unknown: usize) -> f64;
    /// Observations minus unknowns.
    fn redundancy(&self) -> f64;
    /// The largest `r^T r` that differs from `omega` by rounding only.
    fn same(&self, omega: f64) -> f64 {
        omega * (1.0 + 1e-9)
    }
}

/// A solution.
pub(crate) struct Solution<const P: usize> {
    /// The unknowns.
    pub(crate) x: SVector<f64, P>,
    /// The normal equations one step, of no weight, before them.
    pub(crate) normal: Normal<P>,
}

/// The iteration also ends with one that moves the position by less than this, px.
pub(crate) const STILL: f64 = 1e-9;
const EVALUATIONS: usize = 60;
/// From so many evaluations on it is enough that the position stands, for where a target hardly tells its size from its blur and contrast.
const PATIENCE: usize = 10;
const DAMPING: Damping = Damping { first: 1e-3, again: 1e-3, least: 1e-9, rest: 1e-9, most: 1e8 };

/// Minimises, until a step is shorter than `short` standard deviations; it is still taken.
///
/// # Errors
/// [`Rejection::NotConverged`] when that takes too long or comes to a place of no meaning.
pub(crate) fn minimise<const P: usize>(
    problem: &mut impl Problem<P>,
    start: SVector<f64, P>,
    short: f64,
) -> Result<Solution<P>, Rejection> {
    let normal = problem.normal(&start).ok_or(Rejection::NotConverged)?;
    descend(&mut Minimisation { problem, x: start, normal, short }, &DAMPING, EVALUATIONS)
}

struct Minimisation<'a, const P: usize, Q> {
    problem: &'a mut Q,
    x: SVector<f64, P>,
    normal: Normal<P>,
    short: f64,
}

impl<const P: usize, Q: Problem<P>> Descent for Minimisation<'_, P, Q> {
    /// The step and how much it is to gain.
    type Step = (SVector<f64, P>, f64);
    type Found = Solution<P>;

    /// Unknowns that press against their bound stay there.
    fn step(&self, damping: f64) -> Result<Self::Step, Rejection> {
        let x = &self.x;
        self.normal.step(damping, |i, b| x[i] <= self.problem.lowest(i) && b <= 0.0).map(|(_, step, gain)| (step, gain))
    }

    fn found(&self, (step, gain): &Self::Step, weak: bool, trial: usize) -> Result<Option<Solution<P>>, Rejection> {
        let short = self.short * self.short * self.normal.omega / self.problem.redundancy();
        let rests = || step[0].hypot(step[1]) < STILL || trial >= PATIENCE && self.normal.position_rests(step, short);
        let found = || Solution { x: bounded(self.problem, &(self.x + step)), normal: self.normal.clone() };
        Ok((weak && (*gain <= short || rests())).then(found))
    }

    fn go(&mut self, (step, _): Self::Step, weak: bool) -> Result<Gone<Solution<P>>, Rejection> {
        let next = bounded(self.problem, &(self.x + step));
        Ok(match self.problem.normal(&next) {
            Some(better) if better.omega <= self.normal.omega => {
                (self.x, self.normal) = (next, better);
                Gone::Down
            }
            Some(same) if weak && same.omega <= self.problem.same(self.normal.omega) => {
                Gone::Level(Solution { x: self.x, normal: self.normal.clone() })
            }
            _ => Gone::Up,
        })
    }
}

fn bounded<const P: usize>(problem: &impl Problem<P>, x: &SVector<f64, P>) -> SVector<f64, P> {
    SVector::from_fn(|i, _| x[i].max(problem.lowest(i)))
}

/// Cholesky, after the unknowns are scaled alike; `None` for a matrix that is singular to rounding.
pub(crate) fn decompose<const P: usize>(n: &SMatrix<f64, P, P>) -> Option<Scaled<P>> {
    let scale: SVector<f64, P> = SVector::from_fn(|i, _| 1.0 / n[(i, i)].sqrt());
    if !scale.iter().all(|s| s.is_finite()) {
        return None;
    }
    let mut scaled = n.data.0;
    for (j, column) in scaled.iter_mut().enumerate() {
        for (i, product) in column.iter_mut().enumerate() {
            *product = *product * scale[i] * scale[j];
        }
    }
    Some(Scaled { factor: cholesky::factor(&scaled, P, SINGULAR)?, scale })
}

/// Pivots of the scaled normal equations that count as zero.
const SINGULAR: f64 = 1e-14;

pub(crate) struct Scaled<const P: usize> {
    factor: Factor<P>,
    scale: SVector<f64, P>,
}

impl<const P: usize> Scaled<P> {
    pub(crate) fn solve(&self, b: &SVector<f64, P>) -> SVector<f64, P> {
        let scaled: [f64; P] = std::array::from_fn(|i| b[i] * self.scale[i]);
        SVector::from(self.factor.solve(&scaled)).component_mul(&self.scale)
    }
}

/// Makes an unknown stay.
fn hold<const P: usize>(n: &mut SMatrix<f64, P, P>, unknown: usize) {
    n.row_mut(unknown).fill(0.0);
    n.column_mut(unknown).fill(0.0);
    n[(unknown, unknown)] = 1.0;
}

impl<const P: usize> Normal<P> {
    /// The factor of the damped normal matrix, the step and its squared length; unknowns that are `held`, by number and right-hand side, stay.
    ///
    /// # Errors
    /// [`Rejection::NotConverged`] where the matrix is singular.
    pub(crate) fn step(&self, damping: f64, held: impl Fn(usize, f64) -> bool) -> Result<(Scaled<P>, SVector<f64, P>, f64), Rejection> {
        let (mut n, mut b) = (self.n, self.b);
        for i in 0..P {
            n[(i, i)] *= 1.0 + damping;
            if held(i, b[i]) {
                hold(&mut n, i);
                b[i] = 0.0;
            }
        }
        let factor = decompose(&n).ok_or(Rejection::NotConverged)?;
        let step = factor.solve(&b);
        let square = step.dot(&b);
        if square.is_finite() { Ok((factor, step, square)) } else { Err(Rejection::NotConverged) }
    }

    /// Whether the step of the position is short against its standard deviation; `square` is the squared fraction times the variance of unit weight.
    pub(crate) fn position_rests(&self, step: &SVector<f64, P>, square: f64) -> bool {
        self.cofactors().is_some_and(|[[xx, _], [_, yy]]| step[0].powi(2) + step[1].powi(2) <= square * (xx + yy))
    }

    /// The cofactor of one unknown, of `N^-1`, where others are held; `None` when those that are free are not determined.
    pub(crate) fn cofactor(&self, unknown: usize, held: impl Fn(usize) -> bool) -> Option<f64> {
        let mut n = self.n;
        (0..P).filter(|i| held(*i)).for_each(|i| hold(&mut n, i));
        let unit = SVector::from_fn(|i, _| if i == unknown { 1.0 } else { 0.0 });
        Some(decompose(&n)?.solve(&unit)[unknown])
    }

    /// The cofactors of the first `M` unknowns, of `N^-1`; `None` when the unknowns are not determined.
    pub(crate) fn cofactors<const M: usize>(&self) -> Option<[[f64; M]; M]> {
        let Scaled { factor, scale } = decompose(&self.n)?;
        let inverse = factor.inverse::<M>();
        Some(std::array::from_fn(|i| std::array::from_fn(|j| inverse[i][j] * scale[i] * scale[j])))
    }
}

/// A position whose standard deviation is more than this, px, is none.
const VAGUE: f64 = 1.0;

/// The covariance of the position, px^2, with the variance of unit weight from the residuals; `None` when it is too vague.
pub(crate) fn covariance<const P: usize>(normal: &Normal<P>, redundancy: f64) -> Option<Covariance> {
    let ([[xx, xy], [_, yy]], variance) = (normal.cofactors()?, normal.omega / redundancy);
    let covariance = Covariance { sxx: variance * xx, sxy: variance * xy, syy: variance * yy };
    (covariance.sxx + covariance.syy <= VAGUE * VAGUE).then_some(covariance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A decaying exponential `a exp(-b t)`, sampled without error.
    struct Decay {
        lowest: f64,
    }

    impl Problem<2> for Decay {
        fn normal(&mut self, x: &SVector<f64, 2>) -> Option<Normal<2>> {
            let mut normal = Normal { n: SMatrix::zeros(), b: SVector::zeros(), omega: 0.0 };
            for t in (0..20).map(|i| f64::from(i) * 0.2) {
                let (e, r) = ((-x[1] * t).exp(), 3.0 * (-0.7 * t).exp() - x[0] * (-x[1] * t).exp());
                let j = SVector::from([e, -x[0] * t * e]);
                normal.n += j * j.transpose();
                normal.b += j * r;
                normal.omega += r * r;
            }
            Some(normal)
        }

        fn lowest(&self, unknown: usize) -> f64 {
            if unknown == 1 { self.lowest } else { f64::NEG_INFINITY }
        }

        fn redundancy(&self) -> f64 {
            18.0
        }
    }

    #[test]
    fn a_cofactor_with_others_held_is_that_of_the_matrix_without_them() {
        let n = SMatrix::<f64, 3, 3>::new(4.0, 30.0, -2e-3, 30.0, 900.0, 1e-2, -2e-3, 1e-2, 7e-6);
        let normal = Normal { n, b: SVector::zeros(), omega: 5.0 };
        let free = SMatrix::<f64, 2, 2>::new(900.0, 1e-2, 1e-2, 7e-6).try_inverse().unwrap()[(1, 1)];
        assert!((normal.cofactor(2, |unknown| unknown == 0).unwrap() / free - 1.0).abs() < 1e-12);
        let all = n.try_inverse().unwrap()[(2, 2)];
        assert!((normal.cofactor(2, |_| false).unwrap() / all - 1.0).abs() < 1e-9 && free < all);
    }

    #[test]
    fn cofactors_are_those_of_the_inverse_whatever_the_units() {
        let n = SMatrix::<f64, 3, 3>::new(4.0, 30.0, -2e-3, 30.0, 900.0, 1e-2, -2e-3, 1e-2, 7e-6);
        let normal = Normal { n, b: SVector::zeros(), omega: 5.0 };
        let (inverse, found) = (n.try_inverse().unwrap(), normal.cofactors::<3>().unwrap());
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            assert!((found[i][j] - inverse[(i, j)]).abs() < 1e-9 * inverse[(i, j)].abs(), "{i}, {j}");
        }
        let of_position = covariance(&Normal { omega: 0.02, ..normal }, 2.0).unwrap();
        for (found, expected) in [(of_position.sxx, (0, 0)), (of_position.sxy, (0, 1)), (of_position.syy, (1, 1))] {
            assert!((found - 0.01 * inverse[expected]).abs() < 1e-9 * found.abs(), "{expected:?}");
        }
    }

    #[test]
    fn a_far_start_arrives() {
        let solution = minimise(&mut Decay { lowest: 0.0 }, SVector::from([0.2, 4.0]), 1e-3).unwrap();
        assert!((solution.x - SVector::from([3.0, 0.7])).norm() < 1e-8, "{}", solution.x);
    }

    #[test]
    fn a_bound_is_kept_and_the_rest_solved() {
        let solution = minimise(&mut Decay { lowest: 0.9 }, SVector::from([1.0, 4.0]), 1e-3).unwrap();
        let (e, d) = (0..20).map(|i| f64::from(i) * 0.2).fold((0.0, 0.0), |(e, d), t| {
            let model = (-0.9 * t).exp();
            (e + model * 3.0 * (-0.7 * t).exp(), d + model * model)
        });
        assert_eq!(solution.x[1], 0.9);
        assert!((solution.x[0] - e / d).abs() < 1e-6, "{}", solution.x);
    }
}
