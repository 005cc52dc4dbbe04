//! The adjustment of a rig, and what is to be said of it.

use calibench_adjust::{
    AdjustError, Distance, Found, Options, RigCovariances, RigSolution, Use, Variance, adjust_rig, frame_weight, scale_of, snoop_rig,
};
use calibench_model::NamedCamera;
use calibench_model::named_camera::{ParameterCovariance, PoseFrame};
use statrs::distribution::{Binomial, DiscreteCDF};

use super::doubts::{RigDoubt, doubts};
use super::held::Held;
use super::leave_out::BySets;
use super::one_rig::OneRig;
use super::prepared::RigPrepared;
use crate::ended::ITERATIONS;
use crate::over_frame::GRID;
use crate::{CalibrationError, GrossErrors, OverFrame, Risk, usual_limit_px};

/// Residuals (as vectors) beyond so many of their standard deviations are counted.
const BEYOND: f64 = 4.0;
/// Probability of as many by chance, below which gross errors are sought.
const ALPHA: f64 = 1e-4;
/// Share of the image points that is left out of itself, at most: more are no errors of single points.
const MOST_LEFT_OUT: f64 = 0.1;

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

/// Adjusts a rig, leaves out image points in gross error where these are sought, and asks whether it is one rig, how far its mounts are known, and what is doubtful.
///
/// # Errors
/// An adjustment that does not converge or whose unknowns are not determined, by name.
pub fn calibrate_rig(prepared: &RigPrepared) -> Result<RigCalibration<'_>, CalibrationError> {
    let (solution, found) = adjusted(prepared).map_err(|error| match error {
        CalibrationError::Adjust(why @ AdjustError::NotConverged { .. }) => CalibrationError::Rig(format!(
            "no rig that images of one moment see at once: {why}; are the pairs of images of one moment (--sync, --times), and did no camera move?"
        )),
        other => other,
    })?;
    let left_out: Vec<usize> = found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
    let variance = if solution.counts().redundancy() > 0 { Variance::Estimated } else { Variance::Apriori };
    let covariances = solution.covariances(variance)?;
    let one_rig = OneRig::of(&solution, &left_out);
    let by_sets = BySets::of(&solution, &left_out);
    let held = Held::of(prepared, &solution, &left_out);
    let mut calibration =
        RigCalibration { prepared, solution, found, covariances, one_rig, by_sets, over_frame: Vec::new(), held, doubts: Vec::new() };
    calibration.over_frame = (0..prepared.rig.mounts.len()).map(|camera| calibration.over_frame(camera)).collect();
    calibration.doubts = doubts(&calibration);
    Ok(calibration)
}

fn adjusted(prepared: &RigPrepared) -> Result<(RigSolution<'_>, Vec<Found>), CalibrationError> {
    let (rig, settings) = (&prepared.rig, &prepared.asked.settings);
    let options = Options { most_iterations: ITERATIONS, ..Options::default() };
    let points = rig.network.observations.len();
    match settings.gross {
        GrossErrors::Rejected(risk) => Ok(snoop_rig(rig, &options, risk.snooping(points, settings.tested()))?),
        GrossErrors::Kept | GrossErrors::Weighted(_) => Ok((adjust_rig(rig, &options)?, Vec::new())),
        GrossErrors::Sought => {
            let all = adjust_rig(rig, &options);
            if all.as_ref().is_ok_and(|all| !has_gross_errors(all)) {
                return Ok((all?, Vec::new()));
            }
            match snoop_rig(rig, &options, Risk::WholeSet.snooping(points, settings.tested())) {
                Ok((rest, found)) if found.iter().filter(|found| found.left_out).count() as f64 <= MOST_LEFT_OUT * points as f64 => {
                    Ok((rest, found))
                }
                _ => Ok((all?, Vec::new())),
            }
        }
    }
}

/// Whether residuals are not those of normal errors: more are long than chance makes, or one is longer.
fn has_gross_errors(solution: &RigSolution<'_>) -> bool {
    let given = &solution.rig().network.observations;
    let white: Vec<[f64; 2]> = solution
        .residuals()
        .iter()
        .filter(|r| r.used != Use::LeftOut)
        .filter_map(|r| Some(given[r.observation].precision.whitened(r.v?)))
        .collect();
    let Some(scale) = scale_of(white.iter().copied()).filter(|scale| *scale > 1e-5) else { return false };
    let of = white.len() as u64;
    let beyond = white.iter().filter(|[x, y]| x.hypot(*y) > BEYOND * scale).count() as u64;
    let Ok(chance) = Binomial::new((-0.5 * BEYOND * BEYOND).exp(), of) else { return false };
    let longest = white.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
    let p = if beyond == 0 { 1.0 } else { chance.sf(beyond - 1) };
    p < ALPHA || of as f64 * (-0.5 * (longest / scale).powi(2)).exp() < ALPHA
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

    fn over_frame(&self, camera: usize) -> Option<OverFrame> {
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
