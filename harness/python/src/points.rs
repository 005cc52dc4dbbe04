//! Points of several images: a list of arrays, each with a row for every point of the board.

use calibench_model::{Covariance, Points, Start};
use pyo3::prelude::*;

use crate::arrays::{matrices, positions};
use crate::boards::Board;
use crate::error::input;
use crate::measuring::{Measured, covariance};

/// Names of images: those given, or their places counted from 0.
///
/// # Errors
/// Another number of names, a name that stands twice.
pub fn image_names(given: Option<Vec<String>>, count: usize) -> PyResult<Vec<String>> {
    let Some(names) = given else { return Ok((0..count).map(|index| index.to_string()).collect()) };
    if names.len() != count {
        return Err(input(format!("images: found {} names for the points of {count} images; expected one for each", names.len())));
    }
    if let Some(twice) = names.iter().enumerate().find_map(|(i, name)| names[..i].contains(name).then_some(name)) {
        return Err(input(format!("images: `{twice}` stands twice; expected each once")));
    }
    Ok(names)
}

/// The points of images called `names`: rows of NaN are points that nobody measured.
///
/// # Errors
/// An array of another number of rows than the board has points, a covariance that is none; no point at all.
pub fn points(given: &[Bound<'_, PyAny>], names: &[String], board: &Board) -> PyResult<Points> {
    let mut points = Points::default();
    for (image, (name, array)) in names.iter().zip(given).enumerate() {
        let what = format!("xy[{image}]");
        let (array, covariances) = match array.cast::<Measured>() {
            Ok(measured) => (array.getattr("xy")?, Some(array.getattr("cov")?).filter(|_| measured.get().has_covariances(array.py()))),
            Err(_) => (array.clone(), None),
        };
        let found = positions(&array, &what)?;
        if found.len() != board.control.len() {
            return Err(input(format!(
                "{what}: found {} rows; expected one for each of the {} points of the board, NaN where a point was not measured",
                found.len(),
                board.control.len()
            )));
        }
        let covariances = covariances.map(|all| matrices(&all, found.len(), &what)).transpose()?;
        for (index, (position, target)) in found.into_iter().zip(board.names()).enumerate() {
            if position.x.is_nan() || position.y.is_nan() {
                continue;
            }
            if !position.is_finite() {
                return Err(input(format!("{what}: row {index} is not finite; expected px, or NaN for a point that was not measured")));
            }
            let own: Option<Covariance> = covariances.as_ref().map(|all| covariance(all[index])).filter(|own| own.sxx.is_finite());
            points.push(name, target, Start { covariance: own, ..Start::at(position) });
        }
    }
    if points.is_empty() { Err(input("xy: no point was measured")) } else { Ok(points) }
}
