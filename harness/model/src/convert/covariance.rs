//! Covariances through a conversion.

use nalgebra::{DMatrix, Matrix2, Matrix2x3};

use super::ConvertError;
use super::fit::{Problem, State, scale_columns};
use crate::camera::{Camera, CameraModel};

/// Relative size of the part of a column that is not in the columns before it, below which its parameter is not estimable.
const RANK: f64 = 1e-10;

/// d(target) / d(source) of a fit: rows the target's parameters, columns the source's.
///
/// The normal equations `A^T (f(t, ray(s)) - pixel) = 0` define t as a function of s. With the pixel fixed, a change ds moves the ray by
/// `-h_ray^+ h_s ds`, where h is the source's projection; hence `dt = (A^T A)^-1 A^T f_ray R h_ray^+ h_s ds`. Second derivatives times residuals are left
/// out: they are smaller by the ratio of the residuals to the distances over which derivatives change.
pub(super) fn jacobian(problem: &Problem, state: &State<Camera>, source: &Camera) -> Result<DMatrix<f64>, ConvertError> {
    let (mut a, _) = problem.linearise(state).ok_or(ConvertError::NotConverged)?;
    let norms = scale_columns(&mut a);
    let mut right = DMatrix::zeros(a.nrows(), source.parameters().len());
    for (i, sight) in problem.sights.iter().enumerate() {
        let effect = effect(state, source, sight.ray)? * sight.node.weight.sqrt();
        right.rows_mut(2 * i, 2).copy_from(&effect);
    }
    let unknowns = a.ncols();
    let qr = a.qr();
    let r = qr.r();
    if let Some(lost) = (0..unknowns).find(|&i| r[(i, i)].abs() < RANK) {
        let name = problem.free.get(lost).map_or("rotation", |&parameter| state.camera.parameters()[parameter].name);
        return Err(ConvertError::NotEstimable { parameter: name });
    }
    qr.q_tr_mul(&mut right);
    let solved = r.solve_upper_triangular(&right.rows(0, unknowns).into_owned()).ok_or(ConvertError::NotConverged)?;
    let mut jacobian = DMatrix::zeros(state.camera.parameters().len(), right.ncols());
    for (row, &parameter) in problem.free.iter().enumerate() {
        jacobian.row_mut(parameter).copy_from(&(solved.row(row) / norms[row]));
    }
    Ok(jacobian)
}

/// What a change of the source's parameters does to the pixel at which the target pictures the source's ray, with the source's pixel fixed; sign reversed.
fn effect(state: &State<Camera>, source: &Camera, ray: crate::camera::Ray) -> Result<DMatrix<f64>, ConvertError> {
    let from = source.derivatives(ray)?;
    let to = state.camera.derivatives(state.rotation.apply(ray))?;
    let rows = |by: &[[f64; 3]; 2]| Matrix2x3::from_fn(|i, j| by[i][j]);
    let h = rows(&from.by_ray);
    let inverse: Matrix2<f64> = (h * h.transpose()).try_inverse().ok_or(ConvertError::NotConverged)?;
    // The rotation turns the change of the ray with the ray.
    let change = h.transpose() * inverse;
    let turned = nalgebra::Matrix3x2::from_columns(&[0, 1].map(|k| {
        let column = change.column(k);
        let ray = state.rotation.apply(crate::camera::Ray { x: column[0], y: column[1], z: column[2] });
        nalgebra::Vector3::new(ray.x, ray.y, ray.z)
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
        Some(nalgebra::DVector::from_iterator(high.len(), high.iter().zip(&low).map(|(h, l)| (h - l) / (2.0 * step))))
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
