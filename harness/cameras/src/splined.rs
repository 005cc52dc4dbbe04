//! Splines of a file in another convention.

use calibench_model::PixelPoint;
use calibench_model::camera::Camera;
use calibench_model::convert::{Conversion, ConvertOptions, Method, Region, Rotation, Spread, Verdict};

use super::Splines;
use super::fit::{FitError, best, chosen};
use super::splines::turned_where_needed;
use super::target::{Goal, Way};

/// Splines in another model: as they are where the format is their own and no model is asked for, or else fitted to them directly.
pub(super) fn converted(
    splines: &Splines,
    camera: Camera,
    goal: &Goal,
    (model, pitch_um): (Option<&str>, Option<f64>),
    options: &ConvertOptions,
) -> Result<(Conversion, Option<&'static str>), FitError> {
    let refused = |why| FitError::Refused { format: goal.format.name, why };
    match &goal.way {
        Way::One(target) => turned_where_needed(&splines.model, *target, options).map(|found| (found, None)).map_err(refused),
        Way::Best if goal.format.keeps.splines && model.is_none() => Ok((as_they_are(camera), None)),
        Way::AnyOf(_) | Way::Best => {
            let models = if let Way::AnyOf(models) = &goal.way { models.clone() } else { chosen(goal.format, model, pitch_um)? };
            best(&models, |target| turned_where_needed(&splines.model, target, options))
                .map(|(found, model)| (found, Some(model.name)))
                .map_err(refused)
        }
    }
}

pub(super) fn as_they_are(camera: Camera) -> Conversion {
    Conversion {
        camera,
        method: Method::Exact,
        residual: Spread { rms_px: 0.0, max_px: 0.0, at: PixelPoint::default() },
        residuals: Vec::new(),
        region: Region::Frame,
        rotation: Rotation::identity(),
        covariance: None,
        verdict: Verdict::Good,
    }
}
