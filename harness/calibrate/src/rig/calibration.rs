//! The adjustment of a rig, and what is to be said of it.

use calibench_adjust::{Distance, Found, RigCovariances, RigSolution, Use, frame_weight};
use calibench_model::NamedCamera;
use calibench_model::named_camera::{ParameterCovariance, PoseFrame};

use super::doubted::RigDoubt;
use super::held::Held;
use super::leave_out::BySets;
use super::one_rig::OneRig;
use super::prepared::RigPrepared;
use crate::over_frame::GRID;
use crate::{OverFrame, usual_limit_px};

/// A calibrated rig.
#[derive(Clone, Debug)]
pub struct RigCalibration<'p> {
    /// What was adjusted.
    pub prepared: &'p RigPrepared,
    /// The result.
    pub solution: RigSolution<'p>,
    /// Image points that were rejected, if they were looked for.
    pub found: Vec<Found>,
    /// Covariances, with the estimated variance factor where there is redundancy.
    pub covariances: RigCovariances,
    /// Whether the cameras are one rig, or why that was not tested.
    pub one_rig: Result<OneRig, String>,
    /// Standard deviations from leaving sets out, or why there are none.
    pub by_sets: Result<BySets, String>,
    /// How well each camera is known over its frame; `None` where its interior orientation is not adjusted.
    pub over_frame: Vec<Option<OverFrame>>,
    /// The same with the cameras held as their files say, where all have one and are adjusted.
    pub held: Option<Held>,
    /// Why the result is in doubt.
    pub doubts: Vec<RigDoubt>,
}

/// What of a camera's images is to be told.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RigCamera {
    /// Its images that take part.
    pub images: usize,
    /// Its image points in use.
    pub points: usize,
    /// Root mean square of their residuals (2D), px.
    pub rms_px: f64,
}

impl RigCalibration<'_> {
    /// The name of a camera.
    pub fn name_of(&self, camera: usize) -> &str {
        &self.prepared.asked.settings.cameras[camera].name
    }

    /// The name of the camera that defines the frame of the rig.
    pub fn origin(&self) -> &str {
        self.name_of(self.prepared.rig.origin)
    }

    /// Images and residuals of each camera.
    pub fn by_camera(&self) -> Vec<RigCamera> {
        let network = &self.prepared.rig.network;
        let mut found = vec![RigCamera::default(); network.cameras.len()];
        network.images.iter().for_each(|image| found[image.camera].images += 1);
        for residual in self.solution.residuals().iter().filter(|residual| residual.used != Use::LeftOut) {
            let Some([x, y]) = residual.v else { continue };
            let camera = &mut found[network.images[residual.image].camera];
            (camera.points, camera.rms_px) = (camera.points + 1, camera.rms_px + x * x + y * y);
        }
        found.iter_mut().for_each(|camera| camera.rms_px = (camera.rms_px / camera.points.max(1) as f64).sqrt());
        found
    }

    /// Root mean square of the residuals in use (2D), px.
    pub fn rms_px(&self) -> f64 {
        let all = self.by_camera();
        let points: usize = all.iter().map(|camera| camera.points).sum();
        (all.iter().map(|camera| camera.rms_px.powi(2) * camera.points as f64).sum::<f64>() / points.max(1) as f64).sqrt()
    }

    /// The cameras as files hold them: with names, covariances and where they sit, x right, y down, z forward, against the first of them.
    ///
    /// # Errors
    /// A covariance that is not one, in words.
    pub fn named_cameras(&self) -> Result<Vec<NamedCamera>, String> {
        let of = |camera: usize| {
            let (names, covariance) = self.covariances.of_camera(camera);
            let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
            let covariance = (!names.is_empty()).then(|| ParameterCovariance::named(names, &covariance)).transpose()?;
            let optics = &self.prepared.asked.settings.cameras[camera];
            Ok(NamedCamera {
                pitch_um: optics.pitch_um,
                covariance,
                pose: Some(self.pose_against(0, camera)),
                pose_frame: PoseFrame::FirstCamera,
                ..NamedCamera::new(optics.name.as_str(), self.solution.cameras()[camera])
            })
        };
        (0..self.solution.cameras().len()).map(of).collect()
    }

    /// A camera as another sees it, both with axes x right, y down, z forward.
    pub fn pose_against(&self, first: usize, second: usize) -> calibench_model::named_camera::Pose {
        let pose = self.covariances.relative(first, second).pose;
        // y and z are reversed on both sides.
        let sign = [1.0, -1.0, -1.0];
        let camera_from_world = std::array::from_fn(|i| std::array::from_fn(|j| sign[i] * pose.rotation[(i, j)] * sign[j]));
        let position = std::array::from_fn(|i| sign[i] * pose.centre[i]);
        calibench_model::named_camera::Pose { camera_from_world, position }
    }

    pub(super) fn over_frame(&self, camera: usize) -> Option<OverFrame> {
        let (names, covariance) = self.covariances.of_camera(camera);
        if names.is_empty() {
            return None;
        }
        let own = &self.solution.cameras()[camera];
        let weight = frame_weight(own, &names, GRID, Distance::Far).ok();
        let root = |square: Option<f64>| square.filter(|square| !square.is_nan()).map_or(f64::INFINITY, |square| square.max(0.0).sqrt());
        let rows: Vec<usize> = (0..self.covariances.parameters.len()).filter(|&k| self.covariances.parameters[k].0 == camera).collect();
        let by_images_px = self.by_sets.as_ref().ok().zip(weight.as_ref()).map(|(sets, weight)| {
            let scatter = nalgebra::DMatrix::from_fn(rows.len(), rows.len(), |i, j| sets.parameters[(rows[i], rows[j])]);
            root(Some(scatter.component_mul(weight).sum()))
        });
        let limit_px = {
            use calibench_model::camera::CameraModel;
            self.prepared.asked.settings.limit_px.unwrap_or_else(|| usual_limit_px(own.size()))
        };
        Some(OverFrame { formal_px: root(weight.map(|weight| weight.component_mul(&covariance).sum())), by_images_px, limit_px })
    }
}
