//! Covariances through a conversion.

use nalgebra::{DMatrix, DVector, Matrix2, Matrix2x3, Matrix3x2, Vector3};

use super::ConvertError;
use super::fit::{Problem, State, scale_columns};
use super::grid::Sight;
use crate::camera::{Camera, CameraModel, Ray};

/// Relative size of the part of a column that is not in the columns before it, below which its parameter is not estimable.
const RANK: f64 = 1e-7;

/// Effect in the image of the steps by which second derivatives are found, px.
const STEP_PX: f64 = 0.1;

/// d(target) / d(source) of a fit: rows the target's parameters, columns the source's.
///
/// The normal equations `A^T v = 0`, `v = f(t, ray(s)) - pixel`, define t as a function of s. With the pixel fixed, a change ds moves the ray by
/// `-h_ray^+ h_s ds`, where h is the source's projection; hence `(A^T A + A_t^T v) dt = (A^T f_ray R h_ray^+ h_s - A_s^T v) ds`. The terms with v, which
/// vanish with the residuals, take the derivatives of A from differences.
pub(super) fn jacobian(problem: &Problem, state: &State<Camera>, source: &Camera) -> Result<DMatrix<f64>, ConvertError> {
    let (mut a, v) = problem.linearise(state).ok_or(ConvertError::NotConverged)?;
    let norms = scale_columns(&mut a);
    check_rank(&a, problem, state)?;
    let mut effects = DMatrix::zeros(a.nrows(), source.parameters().len());
    for (i, sight) in problem.sights.iter().enumerate() {
        effects.rows_mut(2 * i, 2).copy_from(&(effect(state, source, sight.ray)? * sight.node.weight.sqrt()));
    }
    let slope = |problem: &Problem, state: &State<Camera>| problem.linearise(state).map(|(a, _)| a.tr_mul(&v).component_div(&norms));
    let mut normal = a.tr_mul(&a);
    for k in 0..normal.ncols() {
        let at = |share: f64| {
            let step = DVector::from_fn(norms.len(), |i, _| if i == k { share * STEP_PX / norms[i] } else { 0.0 });
            slope(problem, &problem.moved(state, &step))
        };
        let (high, low) = at(1.0).zip(at(-1.0)).ok_or(ConvertError::NotConverged)?;
        normal.column_mut(k).axpy(0.5 / STEP_PX, &(high - low), 1.0);
    }
    let mut right = a.tr_mul(&effects);
    for k in 0..right.ncols() {
        let step = STEP_PX / effects.column(k).norm();
        if step.is_finite() {
            let at = |change: f64| slope(&Problem { sights: &changed(problem, source, k, change)?, ..*problem }, state);
            let (high, low) = at(step).zip(at(-step)).ok_or(ConvertError::NotConverged)?;
            right.column_mut(k).axpy(-0.5 / step, &(high - low), 1.0);
        }
    }
    let solved = normal.lu().solve(&right).ok_or(ConvertError::NotConverged)?;
    let mut jacobian = DMatrix::zeros(state.camera.parameters().len(), right.ncols());
    for (row, &parameter) in problem.free.iter().enumerate() {
        jacobian.row_mut(parameter).copy_from(&(solved.row(row) / norms[row]));
    }
    Ok(jacobian)
}

/// The sights by a source of which one parameter is changed.
fn changed(problem: &Problem, source: &Camera, parameter: usize, change: f64) -> Option<Vec<Sight>> {
    let mut values = values(source);
    values[parameter] += change;
    let source = source.with_parameters(&values);
    problem.sights.iter().map(|sight| Some(Sight { ray: source.unproject(sight.node.point).ok()?, ..*sight })).collect()
}

/// Names the first parameter whose effect the ones before it have as well.
fn check_rank(a: &DMatrix<f64>, problem: &Problem, state: &State<Camera>) -> Result<(), ConvertError> {
    let r = a.clone().qr().r();
    let Some(lost) = (0..a.ncols()).find(|&i| r[(i, i)].abs() < RANK) else { return Ok(()) };
    let parameter = problem.free.get(lost).map_or("rotation", |&parameter| state.camera.parameters()[parameter].name);
    Err(ConvertError::NotEstimable { parameter })
}

/// What a change of the source's parameters does to the pixel at which the target pictures the source's ray, with the source's pixel fixed; sign reversed.
fn effect(state: &State<Camera>, source: &Camera, ray: Ray) -> Result<DMatrix<f64>, ConvertError> {
    let from = source.derivatives(ray)?;
    let to = state.camera.derivatives(state.rotation.apply(ray))?;
    let rows = |by: &[[f64; 3]; 2]| Matrix2x3::from_fn(|i, j| by[i][j]);
    let h = rows(&from.by_ray);
    let inverse: Matrix2<f64> = (h * h.transpose()).try_inverse().ok_or(ConvertError::NotConverged)?;
    // The rotation turns the change of the ray with the ray.
    let change = h.transpose() * inverse;
    let turned = Matrix3x2::from_columns(&[0, 1].map(|k| {
        let column = change.column(k);
        let ray = state.rotation.apply(Ray { x: column[0], y: column[1], z: column[2] });
        Vector3::new(ray.x, ray.y, ray.z)
    }));
    let transfer = rows(&to.by_ray) * turned;
    let by_source = DMatrix::from_fn(2, from.by_parameters.len(), |axis, parameter| from.by_parameters[parameter][axis]);
    Ok(DMatrix::from_fn(2, 2, |i, j| transfer[(i, j)]) * by_source)
}

/// d(target) / d(source) of a closed form, by central differences: the formulas are linear or nearly so.
pub(super) fn jacobian_of(form: impl Fn(&Camera) -> Option<Camera>, source: &Camera) -> Option<DMatrix<f64>> {
    let values = values(source);
    let columns = (0..values.len()).map(|i| {
        let step = if values[i] == 0.0 { 1e-7 } else { 1e-5 * values[i].abs() };
        let at = |change: f64| {
            let mut changed = values.clone();
            changed[i] += change;
            form(&source.with_parameters(&changed)).map(|camera| self::values(&camera))
        };
        let (high, low) = (at(step)?, at(-step)?);
        Some(DVector::from_iterator(high.len(), high.iter().zip(&low).map(|(h, l)| (h - l) / (2.0 * step))))
    });
    Some(DMatrix::from_columns(&columns.collect::<Option<Vec<_>>>()?))
}

fn values(camera: &Camera) -> Vec<f64> {
    camera.parameters().iter().map(|p| p.value).collect()
}

/// `J Q J^T`.
pub(super) fn propagate(jacobian: &DMatrix<f64>, covariance: &DMatrix<f64>) -> Result<DMatrix<f64>, ConvertError> {
    let expected = jacobian.ncols();
    if covariance.shape() != (expected, expected) {
        return Err(ConvertError::CovarianceShape { expected, rows: covariance.nrows(), columns: covariance.ncols() });
    }
    Ok(jacobian * covariance * jacobian.transpose())
}
