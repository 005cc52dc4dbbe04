//! A camera of a file in another convention: its model, its covariance and its pose.

use calibench_model::camera::{Camera, CameraModel, Ray};
use calibench_model::convert::{Conversion, ConvertError, ConvertOptions, Method, Rotation, Target, convert};
use thiserror::Error;

use super::fit::{FitError, calibrated_as, chosen, fit_to_format, fit_to_models};
use super::format::Model;
use super::recognised::are_within;
use super::target::{Goal, Way};
use super::{CameraFormat, NamedCamera, ParameterCovariance, ReadOptions, camera_bytes, parse_camera, splined};

/// A file gives a camera back that pictures the same within so many px: rounding.
const BACK: f64 = 1e-8;

/// A converted camera and how it came about.
#[derive(Clone, Debug)]
pub struct Converted {
    /// The camera with its pitch, its covariance and its pose; the pose is turned as the fit turned the camera.
    pub camera: NamedCamera,
    /// The conversion.
    pub conversion: Conversion,
    /// The name of the tool's model, if the tool has several.
    pub model: Option<&'static str>,
    /// Of a fit the model, by its name in `calibrate --model`, of which every camera is held exactly, if there is one.
    pub held_exactly: Option<&'static str>,
}

/// A camera that cannot be converted.
#[derive(Debug, Error)]
pub enum ConversionError {
    /// A model was asked for where the target names it.
    #[error("the convention names the model already")]
    ModelNamed,
    /// The conversion.
    #[error(transparent)]
    Convert(#[from] ConvertError),
    /// The fit of one of the format's models.
    #[error(transparent)]
    Fit(#[from] FitError),
    /// The covariance of the source or of the result.
    #[error("{0}")]
    Covariance(String),
}

/// Converts `source` to `goal`. `model` is one of the format's, where it has several; `pitch_um` that of the source where the file does not state it.
/// The covariance of `options` is that of the source's file.
///
/// # Errors
/// A fit that is refused, a model that the format does not have, a covariance that is not the camera's.
pub fn converted(
    source: &NamedCamera,
    goal: &Goal,
    model: Option<&str>,
    pitch_um: Option<f64>,
    options: &ConvertOptions,
) -> Result<Converted, ConversionError> {
    let covariance = source.covariance.as_ref().map(|covariance| covariance.whole(&source.camera)).transpose();
    let options = ConvertOptions { covariance: covariance.map_err(ConversionError::Covariance)?, ..options.clone() };
    let pitch_um = pitch_um.or(source.pitch_um);
    let named = |(conversion, model): (Conversion, Model)| (conversion, Some(model.name), Some(model.target));
    let exact =
        if matches!(goal.way, Way::Best) && source.splines.is_none() { exact_model(goal.format, source, model, pitch_um)? } else { None };
    let (conversion, model, target) = match &goal.way {
        Way::One(_) | Way::AnyOf(_) if model.is_some() => return Err(ConversionError::ModelNamed),
        _ if let Some(splines) = &source.splines => {
            let (conversion, model) = splined::converted(splines, source.camera, goal, (model, pitch_um), &options)?;
            (conversion, model, None)
        }
        Way::Best if let Some(exact) = exact => named(fit_to_models(goal.format, &[exact], &source.camera, &options)?),
        // A fisheye was asked for: no other camera that the file holds too.
        Way::One(Target::OpenCvFisheye) | Way::Best
            if model.is_none()
                && (matches!(goal.way, Way::Best) || matches!(source.camera, Camera::OpenCvFisheye(_)))
                && holds_only_as_it_is(source, goal, pitch_um) =>
        {
            let covariance = options.covariance.clone();
            (Conversion { covariance, ..splined::as_they_are(source.camera) }, None, None)
        }
        Way::One(target) => (convert(&source.camera, *target, &options)?, None, Some(*target)),
        Way::AnyOf(models) => {
            let (conversion, name, target) = named(fit_to_models(goal.format, models, &source.camera, &options)?);
            let fitted = conversion.method == Method::Fitted;
            (conversion, name.filter(|_| fitted), target)
        }
        Way::Best => named(fit_to_format(goal.format, &source.camera, model, pitch_um, &options)?),
    };
    let held_exactly = target.filter(|_| conversion.method == Method::Fitted).and_then(|target| calibrated_as(&target));
    let splines = source.splines.clone().filter(|_| conversion.method == Method::Exact);
    let covariance = conversion.covariance.as_ref().map(|q| ParameterCovariance::of(&conversion.camera, q)).transpose();
    let camera = NamedCamera {
        splines,
        pitch_um,
        covariance: covariance.map_err(ConversionError::Covariance)?,
        pose: source.pose.map(|pose| pose.turned_by(in_file_axes(&conversion.rotation))),
        pose_frame: source.pose_frame,
        ..NamedCamera::new(source.name.clone(), conversion.camera)
    };
    Ok(Converted { camera, conversion, model, held_exactly })
}

/// The first of the format's models, or of those that `model` names, of which a formula makes the camera.
fn exact_model(format: &CameraFormat, source: &NamedCamera, model: Option<&str>, pitch_um: Option<f64>) -> Result<Option<Model>, FitError> {
    let models = chosen(format, model, pitch_um)?;
    Ok(models.into_iter().find(|model| model.target.is_exact_for(&source.camera)))
}

/// `source` as it is, in its own convention.
pub fn unchanged(source: &NamedCamera) -> Converted {
    let camera = NamedCamera { notes: Vec::new(), ..source.clone() };
    Converted { conversion: splined::as_they_are(camera.camera), camera, model: None, held_exactly: None }
}

/// Whether none of the goal's models has a formula for the camera, and yet a file of the format gives it back: what the tool holds beyond the models that others are
/// fitted to.
fn holds_only_as_it_is(source: &NamedCamera, goal: &Goal, pitch_um: Option<f64>) -> bool {
    let has_formula = goal.targets(pitch_um).iter().any(|target| target.is_exact_for(&source.camera));
    let camera = NamedCamera { pitch_um, ..NamedCamera::new(String::new(), source.camera) };
    !has_formula && holds(goal.format, &camera)
}

/// Whether a file of a format gives a camera back as it is.
pub(super) fn holds(format: &'static CameraFormat, camera: &NamedCamera) -> bool {
    let options = ReadOptions { from: Some(format), ..ReadOptions::of_written(format, camera.camera.size()) };
    let given_back = || {
        let bytes = camera_bytes(format, std::slice::from_ref(camera)).ok()?;
        let read = parse_camera("", &bytes, &options).ok()?;
        Some(are_within(BACK, &camera.camera, &read.cameras.first()?.camera))
    };
    given_back().unwrap_or(false)
}

/// A rotation of rays in the axes of camera files, where y points down and z forward.
fn in_file_axes(rotation: &Rotation) -> [[f64; 3]; 3] {
    let columns = [(1.0, 0.0, 0.0), (0.0, -1.0, 0.0), (0.0, 0.0, -1.0)].map(|(x, y, z)| {
        let ray = rotation.apply(Ray { x, y, z });
        [ray.x, -ray.y, -ray.z]
    });
    std::array::from_fn(|row| std::array::from_fn(|column| columns[column][row]))
}
