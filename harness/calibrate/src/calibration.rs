//! The adjustment of a network, and its quality.

use std::sync::OnceLock;

use calibench_adjust::{
    Covariances, Found, Network, Options, Reliability, Significance, Solution, Status, Test, Variance, adjust, adjust_robustly, snoop,
};
use calibench_model::NamedCamera;
use calibench_model::camera::Camera;
use calibench_model::named_camera::ParameterCovariance;

use crate::allowed::Verdicts;
use crate::ended::{ITERATIONS, ended};
use crate::{CalibrationError, Checked, Compared, Doubt, GrossErrors, MeasuredBoard, OverFrame, Prepared, Resampled};

/// A calibration and its quality.
#[derive(Clone, Debug)]
pub struct Calibration<'n> {
    /// What was adjusted.
    pub prepared: &'n Prepared,
    /// The result.
    pub solution: Solution<'n>,
    /// Image points that were rejected, if they were looked for.
    pub found: Vec<Found>,
    /// Bound of Huber's weights, in a-priori standard deviations of an image point, if there was one: that of the settings, times what residuals show.
    pub huber: Option<f64>,
    /// Covariances, with the estimated variance factor where there is redundancy.
    pub covariances: Covariances,
    /// Redundancy numbers and tests of the image points; `None` if the test cannot be made for want of redundancy.
    pub reliability: Option<Reliability>,
    /// The same observations with other sets of parameters; `None` until [`Calibration::compare`].
    pub compared: Option<Compared>,
    /// Standard deviations from leaving images out, or why there are none; `None` until [`Calibration::resample`].
    pub resampled: Option<Result<Resampled, String>>,
    /// The board as these images show it, or why it cannot be told; `None` where it was not asked for, and until [`Calibration::measure_board`].
    pub measured_board: Option<Result<MeasuredBoard, String>>,
    /// What the model may leave out; empty until [`Calibration::examine`].
    pub checked: Vec<Checked>,
    /// How well each camera is known over its frame; `None` where its interior orientation is not adjusted. Empty until [`Calibration::examine`].
    pub over_frame: Vec<Option<OverFrame>>,
    /// Folds inside the frame where a fisheye may see nothing more, in words: no doubts. Empty until [`Calibration::examine`].
    pub rims: Vec<String>,
    /// Cameras that are hardly known; empty until [`Calibration::examine`].
    pub uncertain: Vec<Doubt>,
    /// What cannot be as it is said to be, whatever the model; empty until [`Calibration::examine`].
    pub impossible: Vec<Doubt>,
    /// Gross errors were sought, and what does not fit is kept, since it is not wrong for itself.
    pub(crate) is_off_together: bool,
    /// What checks that adjust again found, once they were made.
    pub(crate) allowed: OnceLock<Verdicts>,
}

impl Prepared {
    /// Adjusts.
    ///
    /// # Errors
    /// What the network does not determine, by name; what else [`adjust`] refuses.
    pub fn adjust(&self) -> Result<Calibration<'_>, CalibrationError> {
        let (solution, found, huber) = self.solution()?;
        let (mut covariances, reliability) = if solution.counts().redundancy() > 0 {
            let (covariances, reliability) = solution.quality(Variance::Estimated, self.test())?;
            (covariances, Some(reliability))
        } else {
            (solution.covariances(Variance::Apriori)?, None)
        };
        if let Some(scale) = &self.settings.board.scale {
            scale.add_to(&mut covariances, solution.poses().iter().map(|pose| pose.centre), solution.points());
        }
        Ok(Calibration {
            prepared: self,
            solution,
            found,
            huber,
            covariances,
            reliability,
            compared: None,
            resampled: None,
            measured_board: None,
            checked: Vec::new(),
            over_frame: Vec::new(),
            rims: Vec::new(),
            uncertain: Vec::new(),
            impossible: Vec::new(),
            is_off_together: false,
            allowed: OnceLock::new(),
        })
    }

    /// The solution alone, with what was rejected and the bound of Huber's weights.
    pub(crate) fn solution(&self) -> Result<(Solution<'_>, Vec<Found>, Option<f64>), CalibrationError> {
        let options = Options { most_iterations: ITERATIONS, ..Options::default() };
        Ok(match self.settings.gross {
            GrossErrors::Weighted(bound) => {
                let (solution, scaled) = adjust_robustly(&self.network, &options, bound)?;
                (solution, Vec::new(), Some(scaled))
            }
            GrossErrors::Rejected(risk) => {
                let snooping = risk.snooping(self.network.observations.len(), self.settings.tested());
                let (solution, found) = snoop(&self.network, &options, snooping)?;
                (solution, found, None)
            }
            GrossErrors::Sought | GrossErrors::Kept => (adjust(&self.network, &options)?, Vec::new(), None),
        })
    }

    /// How image points are tested.
    fn test(&self) -> Test {
        Test { variance: self.settings.tested(), ..Test::default() }
    }
}

impl Calibration<'_> {
    /// The interior orientation of a camera.
    pub fn camera(&self, index: usize) -> &Camera {
        &self.solution.cameras()[index]
    }

    /// A camera as files hold it: with its covariance and, if there are several, its name.
    ///
    /// # Errors
    /// A covariance that is not one, in words.
    pub fn named_camera(&self, index: usize) -> Result<NamedCamera, String> {
        let (names, covariance) = self.covariances.of_camera(index);
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        let covariance = Some(ParameterCovariance::named(names, &covariance)?);
        let optics = &self.prepared.settings.cameras[index];
        let name = if self.cameras() > 1 { optics.name.as_str() } else { "" };
        Ok(NamedCamera { pitch_um: optics.pitch_um, covariance, ..NamedCamera::new(name, *self.camera(index)) })
    }

    /// The variance factor of [`Self::covariances`].
    pub(crate) fn variance(&self) -> Variance {
        if self.solution.counts().redundancy() > 0 { Variance::Estimated } else { Variance::Apriori }
    }

    /// How many cameras there are.
    pub fn cameras(&self) -> usize {
        self.solution.cameras().len()
    }

    /// The name of a camera.
    pub fn name_of(&self, camera: usize) -> &str {
        &self.prepared.settings.cameras[camera].name
    }

    /// ` of NAME`, if there are several cameras.
    pub fn of(&self, camera: usize) -> String {
        if self.cameras() > 1 { format!(" of {}", self.name_of(camera)) } else { String::new() }
    }

    /// A parameter's name; with its camera's if there are several.
    pub fn parameter_name(&self, &(camera, name): &(usize, &'static str)) -> String {
        if self.cameras() > 1 { format!("{}.{name}", self.name_of(camera)) } else { name.to_owned() }
    }

    /// The camera of an image.
    pub fn owner(&self, image: usize) -> usize {
        self.prepared.network.images[image].camera
    }

    /// Tests of the unknown parameters against zero; none without redundancy.
    pub fn significance(&self) -> Vec<Significance> {
        self.solution.significance(&self.covariances).unwrap_or_default()
    }

    /// Root mean square of the residuals in use, px: `sqrt(mean(vx^2 + vy^2))`.
    pub fn rms_px(&self) -> f64 {
        let used = self.solution.each_residual().filter(|r| r.used != calibench_adjust::Use::LeftOut).filter_map(|r| r.v);
        let (sum, count) = used.fold((0.0, 0), |(sum, count), [x, y]| (sum + x * x + y * y, count + 1));
        (sum / f64::from(count.max(1))).sqrt()
    }

    /// Adjusts once more without each of some groups of images, and keeps the scatter in [`Self::resampled`]: `Err` with the reason where that cannot be.
    /// Systematic errors that an image shares with itself alone, as of its own focus or of corners that lie off together, show here and not in the
    /// covariances.
    ///
    /// Source: Efron & Tibshirani 1993, chapter 11.
    pub fn resample(&mut self) {
        let has_unknown_points = self.prepared.network.points.iter().any(|point| point.coordinates != [Status::Fixed; 3]);
        self.resampled = Some(if has_unknown_points {
            Err("object points are unknown too".into())
        } else {
            Resampled::of(&self.ended(), &self.options(), &self.covariances.parameters)
        });
    }

    /// The same network with the end of the adjustment as its start.
    pub(crate) fn ended(&self) -> Network {
        ended(&self.solution)
    }

    /// How it was adjusted, without what was rejected.
    pub(crate) fn options(&self) -> Options {
        let left_out = self.found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
        Options { huber: self.huber, most_iterations: ITERATIONS, left_out, ..Options::default() }
    }
}
