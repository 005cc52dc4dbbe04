//! A camera, and a camera file, as JSON.

use calibench_model::NamedCamera;
use calibench_model::camera::{CameraModel, CameraParameter, Convention, Verification, fold_radius, without_ray};
use calibench_model::named_camera::{ParameterCovariance, PoseFrame};
use schemars::JsonSchema;
use serde::Serialize;

use super::{Answer, Size};
use crate::camera_card::{Corner, corners, sigma, view};

/// What is in a camera file.
#[derive(Serialize, JsonSchema)]
pub struct CameraFileAnswer {
    /// The file, as it was named.
    file: String,
    /// Its format.
    format: Format,
    /// How many cameras it holds.
    count: usize,
    /// All of them, in the order of the file.
    cameras: Vec<Listed>,
    /// The one that was asked for, or the first.
    camera: CameraAnswer,
    /// What its parameters mean for the frame.
    frame: Frame,
}

impl Answer for CameraFileAnswer {
    const COMMAND: &'static str = "camera";
    const SCHEMA: u32 = 1;
}

impl CameraFileAnswer {
    /// What is in the file called `name`: its cameras, and of the one `chosen` what its parameters mean.
    pub fn new(name: &str, format: Format, cameras: &[NamedCamera], chosen: &NamedCamera) -> Self {
        let cameras: Vec<Listed> = cameras.iter().map(Listed::of).collect();
        let (camera, frame) = (CameraAnswer::new(chosen), Frame::of(chosen));
        Self { file: name.into(), format, count: cameras.len(), cameras, camera, frame }
    }
}

/// The format of a camera file.
#[derive(Serialize, JsonSchema)]
pub struct Format {
    /// Its name here: `calibench list formats`.
    pub name: String,
    /// The tool that it belongs to.
    pub tool: String,
    /// The tool's versions that it is known from.
    pub versions: String,
    /// Which of the tool's own numbers were reproduced; null: it is unverified.
    pub verified: Option<String>,
}

/// A camera of a file that holds several.
#[derive(Serialize, JsonSchema)]
struct Listed {
    /// Its name; empty where it has none.
    name: String,
    /// The convention of its parameters.
    convention: String,
    /// Size of its images.
    size: Size,
}

impl Listed {
    fn of(named: &NamedCamera) -> Self {
        Self { name: named.name.clone(), convention: named.camera.convention().name.into(), size: named.camera.size().into() }
    }
}

/// A camera: its parameters in a convention.
#[derive(Serialize, JsonSchema)]
#[schemars(rename = "Camera")]
pub struct CameraAnswer {
    /// Its name; empty where it has none.
    name: String,
    /// The convention of its parameters: `calibench list conventions`.
    convention: String,
    /// What of the convention is not confirmed by numbers of its tool; null: nothing.
    unverified: Option<String>,
    /// Size of its images.
    size: Size,
    /// Pixel pitch, um, where it is stated.
    pitch_um: Option<f64>,
    /// The parameters, in the convention's order.
    parameters: Vec<Parameter>,
    /// Covariance of the parameters that were estimated, where it is known.
    covariance: Option<Covariance>,
    /// Where it stood, in files that say it.
    pose: Option<Pose>,
    /// What was assumed and what was left out.
    notes: Vec<String>,
}

/// A parameter of a camera.
#[derive(Serialize, JsonSchema)]
struct Parameter {
    /// Its name in the convention.
    name: String,
    /// Its value.
    value: f64,
    /// The unit of value and sigma; empty for a number.
    unit: String,
    /// Standard deviation; null where it is not known or the parameter was fixed.
    sigma: Option<f64>,
}

impl Parameter {
    fn of(CameraParameter { name, value, unit, .. }: CameraParameter, covariance: Option<&ParameterCovariance>) -> Self {
        Self { name: name.into(), value, unit: unit.into(), sigma: covariance.and_then(|covariance| sigma(covariance, name)) }
    }
}

/// A covariance matrix.
#[derive(Serialize, JsonSchema)]
struct Covariance {
    /// Names of rows and columns.
    parameters: Vec<String>,
    /// Row by row, in the units of the parameters.
    values: Vec<Vec<f64>>,
}

impl Covariance {
    fn of(covariance: &ParameterCovariance) -> Self {
        let parameters = covariance.parameters.clone();
        Self { values: covariance.values.chunks(parameters.len().max(1)).map(<[f64]>::to_vec).collect(), parameters }
    }
}

/// The place of a camera.
#[derive(Serialize, JsonSchema)]
struct Pose {
    /// Projection centre, in the file's unit.
    position: [f64; 3],
    /// In whose axes: `world`, `first camera`, `rig` or `imu`.
    frame: String,
}

impl CameraAnswer {
    /// As a file holds it.
    pub fn new(named: &NamedCamera) -> Self {
        let NamedCamera { name, camera, pitch_um, pose, pose_frame, covariance, notes, .. } = named;
        let convention = camera.convention();
        let frame = match pose_frame {
            PoseFrame::World => "world",
            PoseFrame::FirstCamera => "first camera",
            PoseFrame::Rig => "rig",
            PoseFrame::Imu => "imu",
        };
        Self {
            name: name.clone(),
            convention: convention.name.into(),
            unverified: unverified(convention),
            size: camera.size().into(),
            pitch_um: *pitch_um,
            parameters: camera.parameters().into_iter().map(|parameter| Parameter::of(parameter, covariance.as_ref())).collect(),
            covariance: covariance.as_ref().map(Covariance::of),
            pose: pose.as_ref().map(|pose| Pose { position: pose.position, frame: frame.into() }),
            notes: notes.clone(),
        }
    }
}

fn unverified(convention: &Convention) -> Option<String> {
    match convention.verification {
        Verification::Unverified(open) => Some(open.into()),
        _ => None,
    }
}

/// What parameters mean for the frame.
#[derive(Serialize, JsonSchema)]
struct Frame {
    /// Angle of view from side to side by way of the middle, degrees; null where there is no ray.
    view_wide_deg: Option<f64>,
    /// From top to bottom.
    view_high_deg: Option<f64>,
    /// From corner to corner.
    view_diagonal_deg: Option<f64>,
    /// How far the corners (clockwise from top left) are from where the same camera without distortion pictures their rays, px; null in a place where it does not, and for
    /// all if no camera without distortion agrees with this one on its axis.
    distortion_px: Option<[Option<f64>; 4]>,
    /// Share of the frame whose pixels have no ray, 0 to 1.
    without_ray: f64,
    /// Distance from the image of the axis at which the distortion folds over, px; null if it does not within the frame.
    fold_px: Option<f64>,
    /// Why the camera is not to be taken for what the file says; null: nothing.
    doubt: Option<String>,
}

impl Frame {
    fn of(named: &NamedCamera) -> Self {
        let camera = &named.camera;
        let [view_wide_deg, view_high_deg, view_diagonal_deg] = view(camera);
        let moved = |corner| if let Corner::Moved(px) = corner { Some(px) } else { None };
        Self {
            view_wide_deg,
            view_high_deg,
            view_diagonal_deg,
            distortion_px: corners(camera).map(|corners| corners.map(moved)),
            without_ray: without_ray(camera),
            fold_px: fold_radius(camera),
            doubt: named.doubt(),
        }
    }
}
