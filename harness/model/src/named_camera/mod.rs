//! A camera as files have it: with a name, a pose, and what is known of its parameters.

mod covariance;
mod pose;
mod splines;

use serde::{Deserialize, Serialize};

use crate::camera::{Camera, Eucm, Splined};
use crate::convert::Region;

pub use covariance::ParameterCovariance;
pub use pose::{Pose, PoseFrame};
pub use splines::{Splines, within};

/// A camera of a file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedCamera {
    /// Its name in the file: of a sensor or of an image; empty where the format has none.
    pub name: String,
    /// The camera; of a file of splines the one of another model that is nearest to them.
    pub camera: Camera,
    /// The splines of such a file.
    pub splines: Option<Box<Splines>>,
    /// Pixel pitch, um, where the file states it.
    pub pitch_um: Option<f64>,
    /// Where the camera stood, in files that say it.
    pub pose: Option<Pose>,
    /// What the world of the pose is.
    pub pose_frame: PoseFrame,
    /// Covariance of the parameters, where the file states it.
    pub covariance: Option<ParameterCovariance>,
    /// What the user should know: what was assumed, what was left out.
    pub notes: Vec<String>,
    /// Whether one of these says that no lens has the camera.
    pub implausible: bool,
}

impl NamedCamera {
    /// A camera of which nothing else is known.
    pub fn new(name: impl Into<String>, camera: Camera) -> Self {
        Self {
            name: name.into(),
            camera,
            splines: None,
            pitch_um: None,
            pose: None,
            pose_frame: PoseFrame::World,
            covariance: None,
            notes: Vec::new(),
            implausible: false,
        }
    }

    /// Splines of which no other camera is known to be near: [`Self::camera`] has their core and is stereographic as they are without control points, and
    /// [`Self::doubt`] refuses it.
    pub fn splined(name: impl Into<String>, model: Splined) -> Self {
        let (size, [fx, fy, cx, cy]) = (model.size, model.core);
        let flat = Eucm { size, fx, fy, cx, cy, alpha: 0.5, beta: 1.0 };
        let splines = Splines { model, residual_px: f64::INFINITY, region: Region::Frame };
        Self { splines: Some(Box::new(splines)), ..Self::new(name, flat.into()) }
    }

    /// Why [`Self::camera`] is not to be taken for what the file says, if so: splines that no other model comes near.
    pub fn doubt(&self) -> Option<String> {
        self.splines.as_ref()?.doubt()
    }
}
