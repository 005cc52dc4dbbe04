//! What the adjustment of all photographs leaves of each corner.

use calibench_calibrate::CalibrationError;
use calibench_calibrate::choice::ModelChoice;
use calibench_model::PixelPoint;

use super::Options;
use super::calibrated::calibrate;
use super::material::Material;

/// A corner and its residual.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Remaining {
    /// The place of its photograph among those of the [`Material`].
    pub view: usize,
    /// Its place in the field.
    pub corner: usize,
    /// Where it was measured, px.
    pub at: PixelPoint,
    /// Adjusted less observed, x and y, px.
    pub v: [f64; 2],
}

/// The residuals of all corners of an operator, by its place, with a model: one adjustment, of the views in which it measured enough.
///
/// # Errors
/// What the corners do not determine, by name.
pub fn remaining(material: &Material, operator: usize, model: &ModelChoice, options: &Options) -> Result<Vec<Remaining>, CalibrationError> {
    let settings = model.settings(material.size, options.pitch_um);
    let found = calibrate(material, operator, &material.usable(operator), &settings)?;
    let corner = |view: usize, at: PixelPoint| material.operators[operator].at[view].iter().position(|own| *own == Some(at));
    let one = |(view, at, v)| Some(Remaining { view, corner: corner(view, at)?, at, v });
    Ok(found.left()?.into_iter().filter_map(one).collect())
}
