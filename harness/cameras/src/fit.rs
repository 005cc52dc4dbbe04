//! A camera for a format: which of its models holds it, and what else is lost.

use calibench_model::camera::{AgisoftVersion, Camera};
use calibench_model::convert::{Conversion, ConvertError, ConvertOptions, Target, Verdict, convert};
use thiserror::Error;

use super::behind::{Behind, behind};
use super::format::{CameraFormat, Keeps, KeptCovariance, KeptPose, Model};
use super::{NamedCamera, ParameterCovariance, PoseFrame};

/// Why a format does not hold a camera.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum FitError {
    /// The format is read only, or is written through its convention alone.
    #[error("{format} has no models to choose from")]
    NoModels {
        /// Its name.
        format: &'static str,
    },
    /// No model of that name.
    #[error("{format} holds no model `{model}`; it holds {known}")]
    UnknownModel {
        /// The format's name.
        format: &'static str,
        /// What was asked for.
        model: String,
        /// The names that there are.
        known: String,
    },
    /// None of the models can be fitted.
    #[error("{format} cannot hold the camera: {why}")]
    Refused {
        /// The format's name.
        format: &'static str,
        /// The reason of the best model.
        why: ConvertError,
    },
}

/// The models, by their names in `calibrate --model`, whose cameras `format` holds exactly.
pub fn calibrated_models(format: &CameraFormat) -> Vec<&'static str> {
    let mut names: Vec<&str> = format.models(None).iter().filter_map(|model| calibrated_as(&model.target)).collect();
    names.dedup();
    names
}

/// The model, by its name in `calibrate --model`, of which every camera is one of `target`.
pub(super) fn calibrated_as(target: &Target) -> Option<&'static str> {
    Some(match target {
        Target::Photogrammetric { radial: 3, tangential: true, affinity: true, .. } => "photogrammetric",
        Target::OpenCv { coefficients: 4 } => "opencv4",
        Target::OpenCv { coefficients: 5 } => "opencv5",
        Target::OpenCv { coefficients: 8 } => "opencv8",
        Target::OpenCv { coefficients: 12 } => "opencv12",
        Target::OpenCv { coefficients: 14 } => "opencv14",
        Target::OpenCvFisheye => "opencv-fisheye",
        Target::Agisoft { version: AgisoftVersion::Metashape, radial: 3.., tangential: 2.., affinity: true } => "metashape",
        Target::Pix4d { .. } => "pix4d",
        Target::DoubleSphere => "double-sphere",
        Target::Eucm => "eucm",
        Target::Omni { distortion: true } => "omni",
        Target::Fov => "fov",
        Target::PrismFisheye => "prism-fisheye",
        _ => return None,
    })
}

/// `camera` in one of the models of `format`, and which: exact in the first that holds it, or fitted in the one whose residuals are smallest. With `model`
/// in that one alone.
///
/// # Errors
/// A format without models, a model that it has not, a camera that no model can be fitted to.
pub fn fit_to_format(
    format: &CameraFormat,
    camera: &Camera,
    model: Option<&str>,
    pitch_um: Option<f64>,
    options: &ConvertOptions,
) -> Result<(Conversion, Model), FitError> {
    fit_to_models(format, &chosen(format, model, pitch_um)?, camera, options)
}

/// As [`fit_to_format`], of models that are given.
pub(super) fn fit_to_models(
    format: &CameraFormat,
    models: &[Model],
    camera: &Camera,
    options: &ConvertOptions,
) -> Result<(Conversion, Model), FitError> {
    let exact = ConvertOptions { covariance: options.covariance.clone(), ..ConvertOptions::default() };
    for model in models {
        if model.target.is_exact_for(camera) {
            let found = convert(camera, model.target, &exact);
            return found.map(|found| (found, *model)).map_err(|why| FitError::Refused { format: format.name, why });
        }
    }
    best(models, |target| convert(camera, target, options)).map_err(|why| FitError::Refused { format: format.name, why })
}

/// The models of a format; with `model` that one alone.
pub(super) fn chosen(format: &CameraFormat, model: Option<&str>, pitch_um: Option<f64>) -> Result<Vec<Model>, FitError> {
    let mut models = format.models(pitch_um);
    if models.is_empty() {
        return Err(FitError::NoModels { format: format.name });
    }
    if let Some(wanted) = model {
        let known = models.iter().map(|model| model.name).collect::<Vec<_>>().join(", ");
        models.retain(|model| model.name.eq_ignore_ascii_case(wanted));
        if models.is_empty() {
            return Err(FitError::UnknownModel { format: format.name, model: wanted.to_owned(), known });
        }
    }
    Ok(models)
}

/// The fit with the smallest residuals; a good one ends the search.
pub(super) fn best(
    models: &[Model],
    converted: impl Fn(Target) -> Result<Conversion, ConvertError>,
) -> Result<(Conversion, Model), ConvertError> {
    let mut found: Option<(Conversion, Model)> = None;
    let mut refused: Option<ConvertError> = None;
    for model in models {
        match converted(model.target) {
            Ok(conversion) => {
                let good = conversion.verdict == Verdict::Good;
                if found.as_ref().is_none_or(|(before, _)| conversion.residual.max_px < before.residual.max_px) {
                    found = Some((conversion, *model));
                }
                if good {
                    break;
                }
            }
            Err(why) => refused = Some(better(refused, why)),
        }
    }
    match (found, refused) {
        (Some(found), _) => Ok(found),
        (None, why) => Err(why.unwrap_or(ConvertError::NotConverged)),
    }
}

/// The reason that says most: the smallest residual.
fn better(before: Option<ConvertError>, why: ConvertError) -> ConvertError {
    match (before, why) {
        (Some(ConvertError::Residual { rms_px, max_px, at }), ConvertError::Residual { max_px: other, .. }) if max_px <= other => {
            ConvertError::Residual { rms_px, max_px, at }
        }
        (Some(before @ ConvertError::Residual { .. }), why) if !matches!(why, ConvertError::Residual { .. }) => before,
        (_, why) => why,
    }
}

/// What of a camera a format has no place for, or what it needs and is not known, in words.
pub fn losses(format: &CameraFormat, camera: &NamedCamera) -> Vec<String> {
    let Keeps { name, pitch, pose, covariance, .. } = format.keeps;
    let mut lost = Vec::new();
    let mut say = |is: bool, what: String| {
        if is {
            lost.push(format!("{what}: {} has no place for it", format.name));
        }
    };
    say(!name && !camera.name.is_empty(), format!("the name `{}`", camera.name));
    say(!pitch && camera.pitch_um.is_some(), format!("the pixel pitch, {} um", camera.pitch_um.unwrap_or(0.0)));
    let of = match camera.pose_frame {
        PoseFrame::World => "the pose",
        PoseFrame::FirstCamera | PoseFrame::Rig => "the pose in the rig",
        PoseFrame::Imu => "the pose against the inertial sensor",
    };
    let posed = camera.pose.is_some_and(|pose| pose != super::Pose::IDENTITY);
    say(pose == KeptPose::None && posed, of.to_owned());
    let known = camera.covariance.as_ref();
    say(covariance == KeptCovariance::None && known.is_some(), "the covariance of the parameters".to_owned());
    let correlated = |q: &ParameterCovariance| {
        let n = q.parameters.len();
        (0..n * n).any(|i| i / n != i % n && q.values[i] != 0.0)
    };
    say(covariance == KeptCovariance::Variances && known.is_some_and(correlated), "the correlations of the parameters".to_owned());
    if let Some(Behind { share, elsewhere_px }) = format.half_space.then(|| behind(&camera.camera)).flatten() {
        lost.push(format!(
            "{:.1} % of the frame, which see rays beyond 90 degrees from the axis: {} divides by z and pictures these up to {elsewhere_px:.0} px elsewhere",
            100.0 * share,
            format.tool
        ));
    }
    if pose == KeptPose::InRig && posed && camera.pose_frame == PoseFrame::World {
        lost.push(format!("the world of the pose: {} holds poses of a rig, against each other or a sensor", format.name));
    }
    lost
}
