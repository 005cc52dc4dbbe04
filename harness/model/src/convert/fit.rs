//! Levenberg-Marquardt over the pixels of a grid.

use nalgebra::{DMatrix, DVector};

use super::ConvertError;
use super::grid::{Sight, Vector};
use super::rotation::{Rotation, by_rotation};
use crate::camera::CameraModel;

const MOST_STEPS: usize = 300;
/// Sights that a fit begins with, of more.
const FEW: usize = 150;
/// Slope of the sum of squares below which nothing is left to gain, px.
const FLAT: f64 = 1e-11;
/// Share of the sum of squares below which a sum over a grid is rounding: a step that promises less gains nothing.
const ROUNDING: f64 = 1e-15;
/// Slope, px, above which a fit that ran out of steps has failed.
const STEEP: f64 = 1e-6;

/// A camera that pictures the rays of `sights`, once rotated, where they came from.
#[derive(Clone, Copy)]
pub(super) struct Problem<'a> {
    pub(super) sights: &'a [Sight],
    /// Indices of the parameters that may change.
    pub(super) free: &'a [usize],
    /// The rays may be rotated: three more unknowns.
    pub(super) rotation: bool,
}

/// Where the iteration is.
#[derive(Clone, Debug)]
pub(super) struct State<T> {
    pub(super) camera: T,
    pub(super) rotation: Rotation,
}

impl Problem<'_> {
    /// Free parameters, and the three of the rotation if it is free.
    pub(super) fn unknowns(&self) -> usize {
        self.free.len() + if self.rotation { 3 } else { 0 }
    }

    /// Pictured minus given; `None` if a ray is not pictured.
    pub(super) fn residuals<T: CameraModel>(&self, state: &State<T>) -> Option<Vec<Vector>> {
        let residual = |sight: &Sight| {
            let (found, at) = (state.camera.project(state.rotation.apply(sight.ray)).ok()?, sight.node.point);
            found.is_finite().then_some(Vector { at, dx: found.x - at.x, dy: found.y - at.y })
        };
        self.sights.iter().map(residual).collect()
    }

    /// Weighted mean square, px^2.
    pub(super) fn cost<T: CameraModel>(&self, state: &State<T>) -> Option<f64> {
        let residuals = self.residuals(state)?;
        let sum: f64 = self.sights.iter().zip(&residuals).map(|(s, v)| s.node.weight * (v.dx * v.dx + v.dy * v.dy)).sum();
        sum.is_finite().then_some(sum)
    }

    /// Weighted derivatives (free parameters, then the rotation) and residuals.
    pub(super) fn linearise<T: CameraModel>(&self, state: &State<T>) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let mut a = DMatrix::zeros(2 * self.sights.len(), self.unknowns());
        let mut v = DVector::zeros(2 * self.sights.len());
        for (i, sight) in self.sights.iter().enumerate() {
            let rotated = state.rotation.apply(sight.ray);
            let found = state.camera.derivatives(rotated).ok()?;
            let by_rotation = by_rotation(&found.by_ray, rotated);
            let root = sight.node.weight.sqrt();
            let misclosure = [found.point.x - sight.node.point.x, found.point.y - sight.node.point.y];
            for (axis, misclosure) in misclosure.into_iter().enumerate() {
                let row = 2 * i + axis;
                v[row] = root * misclosure;
                for (column, &parameter) in self.free.iter().enumerate() {
                    a[(row, column)] = root * found.by_parameters[parameter][axis];
                }
                if self.rotation {
                    (0..3).for_each(|k| a[(row, self.free.len() + k)] = root * by_rotation[axis][k]);
                }
            }
        }
        Some((a, v))
    }

    pub(super) fn moved<T: CameraModel>(&self, state: &State<T>, step: &DVector<f64>) -> State<T> {
        let mut values: Vec<f64> = state.camera.parameters().iter().map(|p| p.value).collect();
        self.free.iter().zip(step.iter()).for_each(|(&parameter, change)| values[parameter] += change);
        let turn = if self.rotation { std::array::from_fn(|k| step[self.free.len() + k]) } else { [0.0; 3] };
        State {
            camera: state.camera.with_parameters(&values),
            rotation: if self.rotation { state.rotation.then(turn) } else { state.rotation },
        }
    }

    /// The least-squares solution from `start`: that of a few of the sights is where the rest begin. What does not converge with these does not with all, and takes as
    /// many times longer to show it.
    ///
    /// # Errors
    /// [`ConvertError::NotPictured`] if the start does not picture a ray, [`ConvertError::NotConverged`].
    pub(super) fn solve<T: CameraModel>(&self, start: State<T>) -> Result<State<T>, ConvertError> {
        self.cost(&start).ok_or_else(|| self.not_pictured(&start))?;
        let few = thinned(self.sights);
        if few.len() == self.sights.len() || few.len() < FEW.max(self.unknowns()) {
            return self.descend(start);
        }
        let near = Problem { sights: &few, ..*self }.descend(self.moved(&start, &DVector::zeros(self.unknowns())))?;
        self.descend(if self.cost(&near).is_some() { near } else { start })
    }

    fn descend<T: CameraModel>(&self, start: State<T>) -> Result<State<T>, ConvertError> {
        let mut state = start;
        let mut cost = self.cost(&state).ok_or_else(|| self.not_pictured(&state))?;
        let mut damping = 1e-6;
        let mut slope = f64::INFINITY;
        for _ in 0..MOST_STEPS {
            let (mut a, v) = self.linearise(&state).ok_or(ConvertError::NotConverged)?;
            let norms = scale_columns(&mut a);
            slope = a.tr_mul(&v).amax();
            if slope < FLAT {
                break;
            }
            let Some((better, lower)) = self.improve(&state, cost, (&a, &v, &norms), &mut damping) else { break };
            (state, cost) = (better, lower);
        }
        if slope < STEEP.max(1e-6 * cost.sqrt()) { Ok(state) } else { Err(ConvertError::NotConverged) }
    }

    /// The first damped step that lowers the cost; `None` if none does.
    fn improve<T: CameraModel>(
        &self,
        state: &State<T>,
        cost: f64,
        (a, v, norms): (&DMatrix<f64>, &DVector<f64>, &DVector<f64>),
        damping: &mut f64,
    ) -> Option<(State<T>, f64)> {
        while *damping < 1e12 {
            let scaled = damped_step(a, v, *damping)?;
            if promised(a, v, &scaled) < ROUNDING * cost {
                return None;
            }
            let trial = self.moved(state, &scaled.component_div(norms));
            if let Some(found) = self.cost(&trial).filter(|&found| found < cost) {
                *damping = (*damping * 0.1).max(1e-16);
                return Some((trial, found));
            }
            *damping *= 10.0;
        }
        None
    }

    fn not_pictured<T: CameraModel>(&self, state: &State<T>) -> ConvertError {
        let lost = |sight: &&Sight| state.camera.project(state.rotation.apply(sight.ray)).is_err();
        ConvertError::NotPictured { share: self.sights.iter().filter(lost).map(|sight| sight.node.weight).sum() }
    }
}

/// By how much a step lowers the sum of squares, as far as the image is linear.
fn promised(a: &DMatrix<f64>, v: &DVector<f64>, step: &DVector<f64>) -> f64 {
    let change = a * step;
    -change.dot(&(2.0 * v + &change))
}

/// About [`FEW`] sights, spread evenly over a grid of any width: by multiples of the golden ratio.
fn thinned(sights: &[Sight]) -> Vec<Sight> {
    let share = FEW as f64 / sights.len() as f64;
    let is_kept = |index: usize| (index as f64 * 0.618_033_988_749_894_9).fract() < share;
    sights.iter().enumerate().filter(|(index, _)| is_kept(*index)).map(|(_, sight)| *sight).collect()
}

/// Divides each column by its norm (k3 in mm^-6 lies twelve powers of ten below c) and returns the norms; those of columns of zeros are one.
pub(super) fn scale_columns(a: &mut DMatrix<f64>) -> DVector<f64> {
    let norms = DVector::from_iterator(a.ncols(), a.column_iter().map(|column| column.norm()).map(|n| if n > 0.0 { n } else { 1.0 }));
    a.column_iter_mut().zip(norms.iter()).for_each(|(mut column, norm)| column /= *norm);
    norms
}

/// The minimum of |a x + v|^2 + damping |x|^2, by QR.
fn damped_step(a: &DMatrix<f64>, v: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let (rows, columns) = a.shape();
    let mut matrix = DMatrix::zeros(rows + columns, columns);
    matrix.rows_mut(0, rows).copy_from(a);
    matrix.rows_mut(rows, columns).fill_diagonal(damping.sqrt());
    let mut right = DVector::zeros(rows + columns);
    right.rows_mut(0, rows).copy_from(&(-v));
    let qr = matrix.qr();
    qr.q_tr_mul(&mut right);
    qr.r().solve_upper_triangular(&right.rows(0, columns).into_owned()).filter(|x| x.iter().all(|value| value.is_finite()))
}
