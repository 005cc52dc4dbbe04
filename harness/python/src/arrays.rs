//! Positions, covariances and matrices as arrays, both ways.

use calibench_model::{Affine, Covariance, PixelPoint};
use nalgebra::DMatrix;
use numpy::{PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray2, PyReadonlyArray3, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;

use crate::error::input;

/// An array of `N` numbers a row, of any type of number and any strides; `what` is its name in errors.
///
/// # Errors
/// Anything else, by its type and shape.
pub fn rows<const N: usize>(array: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<[f64; N]>> {
    // As most are given, nothing is asked of numpy.
    if let Ok(values) = array.extract::<PyReadonlyArray2<'_, f64>>()
        && values.as_array().ncols() == N
    {
        return Ok(values.as_array().rows().into_iter().map(|row| std::array::from_fn(|i| row[i])).collect());
    }
    let array = as_numbers(array, what)?;
    let shape = array.cast::<PyUntypedArray>().map_err(PyErr::from)?.shape().to_vec();
    // No point is an array of no row, whatever its shape.
    if shape.first() == Some(&0) {
        return Ok(Vec::new());
    }
    let wrong = || input(format!("{what}: found an array of shape {shape:?}; expected (n, {N})"));
    // As OpenCV has them.
    let array = if matches!(shape[..], [_, 1, _]) { array.call_method1("reshape", (shape[0], shape[2]))? } else { array };
    let values: PyReadonlyArray2<'_, f64> = array.extract().map_err(|_| wrong())?;
    let values = values.as_array();
    if values.ncols() != N {
        return Err(wrong());
    }
    Ok(values.rows().into_iter().map(|row| std::array::from_fn(|i| row[i])).collect())
}

/// An array of `n` matrices of 2 x 2; `what` is its name in errors.
///
/// # Errors
/// Anything else, by its type and shape.
pub fn matrices(array: &Bound<'_, PyAny>, n: usize, what: &str) -> PyResult<Vec<[[f64; 2]; 2]>> {
    let array = as_numbers(array, what)?;
    let shape = array.cast::<PyUntypedArray>().map_err(PyErr::from)?.shape().to_vec();
    if shape != [n, 2, 2] {
        return Err(input(format!("{what}: found an array of shape {shape:?}; expected ({n}, 2, 2)")));
    }
    let values: PyReadonlyArray3<'_, f64> = array.extract()?;
    let values = values.as_array();
    Ok((0..n).map(|i| [[values[[i, 0, 0]], values[[i, 0, 1]]], [values[[i, 1, 0]], values[[i, 1, 1]]]]).collect())
}

/// Anything that numpy takes for numbers, as 64-bit ones.
fn as_numbers<'py>(array: &Bound<'py, PyAny>, what: &str) -> PyResult<Bound<'py, PyAny>> {
    let numpy = array.py().import("numpy")?;
    let as_given =
        numpy.call_method1("asarray", (array,)).map_err(|error| input(format!("{what}: {error}; expected an array of numbers")))?;
    let kind: String = as_given.getattr("dtype")?.getattr("kind")?.extract()?;
    if !["f", "i", "u"].contains(&kind.as_str()) {
        return Err(input(format!("{what}: found an array of {}; expected numbers", as_given.getattr("dtype")?)));
    }
    as_given.call_method1("astype", ("float64",))
}

/// Positions of (n, 2), px.
///
/// # Errors
/// As [`rows`].
pub fn positions(array: &Bound<'_, PyAny>, what: &str) -> PyResult<Vec<PixelPoint>> {
    Ok(rows::<2>(array, what)?.into_iter().map(|[x, y]| PixelPoint::new(x, y)).collect())
}

/// Rows of `N` as an array of (n, N).
pub fn table<const N: usize>(py: Python<'_>, rows: &[[f64; N]]) -> PyResult<Py<PyArray2<f64>>> {
    shaped(py, rows.iter().flatten().copied().collect(), [rows.len(), N])
}

/// Positions as an array of (n, 2).
pub fn of_positions(py: Python<'_>, points: impl IntoIterator<Item = PixelPoint>) -> PyResult<Py<PyArray2<f64>>> {
    table(py, &points.into_iter().map(|point| [point.x, point.y]).collect::<Vec<_>>())
}

/// A matrix as an array.
pub fn of_matrix(py: Python<'_>, matrix: &DMatrix<f64>) -> PyResult<Py<PyArray2<f64>>> {
    shaped(py, matrix.transpose().iter().copied().collect(), [matrix.nrows(), matrix.ncols()])
}

/// What [`of_matrix`] made of a matrix.
///
/// # Errors
/// Anything else.
pub fn matrix(array: &Bound<'_, PyAny>) -> PyResult<DMatrix<f64>> {
    let values: PyReadonlyArray2<'_, f64> = array.extract()?;
    let values = values.as_array();
    Ok(DMatrix::from_fn(values.nrows(), values.ncols(), |row, column| values[[row, column]]))
}

/// No position.
pub const NOWHERE: PixelPoint = PixelPoint::new(f64::NAN, f64::NAN);

/// Covariances as an array of (n, 2, 2), px^2; NaN where there is none.
pub fn of_covariances(py: Python<'_>, all: impl IntoIterator<Item = Option<Covariance>>) -> PyResult<Py<PyArray3<f64>>> {
    of_matrices(py, all.into_iter().map(|covariance| covariance.map(|s| [s.sxx, s.sxy, s.sxy, s.syy])))
}

/// Own axes of targets as an array of (n, 2, 2), px: the columns; NaN where they are not known.
pub fn of_axes(py: Python<'_>, all: impl IntoIterator<Item = Option<Affine>>) -> PyResult<Py<PyArray3<f64>>> {
    of_matrices(py, all.into_iter().map(|map| map.map(|a| [a.axx, a.axy, a.ayx, a.ayy])))
}

/// Matrices of 2 x 2, row by row.
fn of_matrices(py: Python<'_>, all: impl IntoIterator<Item = Option<[f64; 4]>>) -> PyResult<Py<PyArray3<f64>>> {
    let values: Vec<f64> = all.into_iter().flat_map(|matrix| matrix.unwrap_or([f64::NAN; 4])).collect();
    let n = values.len() / 4;
    Ok(PyArray1::from_vec(py, values).reshape([n, 2, 2])?.unbind())
}

fn shaped(py: Python<'_>, values: Vec<f64>, shape: [usize; 2]) -> PyResult<Py<PyArray2<f64>>> {
    Ok(PyArray1::from_vec(py, values).reshape(shape)?.unbind())
}
