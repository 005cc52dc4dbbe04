//! From measured points to a calibrated camera, for users: start values without truth, the adjustment, and what is to be said of it.

pub mod choice;
mod datum;
mod error;
mod model;
mod network;
mod optics;
mod prior;
mod sets;
mod stages;
mod start;
mod survey;

use calibench_adjust::{Covariances, Found, Network, Options, Reliability, Snooping, Solution, Test, Variance, adjust, snoop};
use calibench_exchange::{ControlRow, LostRow, ObservedStation, PointRow};
use calibench_model::camera::Camera;

pub use datum::{DatumChoice, NoDatum};
pub use error::CalibrationError;
pub use model::{MODELS, parameters};
pub use optics::Optics;
pub use prior::{NoPrior, Prior};
pub use sets::{Compared, ComparedSet, SetResult, compare_sets};
pub use start::{control_of, pose_of};
pub use survey::{LeftOut, Sight, Survey};

/// How to calibrate.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The cameras: at least one.
    pub cameras: Vec<Optics>,
    /// What fixes the frame of the object.
    pub datum: DatumChoice,
    /// Bound of Huber's weights, in standard deviations.
    pub huber: Option<f64>,
    /// Leave out what Baarda's test rejects?
    pub snoop: bool,
    /// A-priori standard deviation of an image coordinate, px; `None` for [`USUAL_SIGMA`], about which nothing is known but its order of magnitude.
    pub sigma_px: Option<f64>,
    /// Weigh image points by their own covariances, where they have them?
    pub covariances: bool,
    /// Poses that were observed, or parts of them.
    pub stations: Vec<ObservedStation>,
}

/// The a-priori standard deviation of an image coordinate where none is given, px.
pub const USUAL_SIGMA: f64 = 0.1;

/// Iterations at most: parameters that do nearly the same, as xi and k1 of an omnidirectional camera, approach their minimum slowly.
const ITERATIONS: usize = 1000;

impl Settings {
    /// The usual ones for some cameras, at least one.
    pub fn new(cameras: Vec<Optics>) -> Self {
        Self { cameras, datum: DatumChoice::Control, huber: None, snoop: false, sigma_px: None, covariances: false, stations: Vec::new() }
    }

    /// The a-priori standard deviation of an image coordinate, px.
    pub fn sigma(&self) -> f64 {
        self.sigma_px.unwrap_or(USUAL_SIGMA)
    }

    /// Whose variance factor tests and standard deviations take: the a-priori one means something only if the user stated it.
    fn tested(&self) -> Variance {
        if self.sigma_px.is_some() { Variance::Apriori } else { Variance::Estimated }
    }
}

/// A network with its start values.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// How it was asked for.
    pub settings: Settings,
    /// Who measured what.
    pub survey: Survey,
    /// Where the interior orientation of each camera started.
    pub origins: Vec<String>,
    /// What is adjusted.
    pub network: Network,
    /// The sight behind each observation of the network.
    pub sights: Vec<usize>,
    /// Rows that take no part, with the reason.
    pub left_out: Vec<LeftOut>,
    /// Targets that a method was given and that have no position; [`prepare`] leaves it empty. They have a row in the residuals' table.
    pub unmeasured: Vec<LostRow>,
}

/// A calibration and its quality.
#[derive(Clone, Debug)]
pub struct Calibration<'n> {
    /// What was adjusted.
    pub prepared: &'n Prepared,
    /// The result.
    pub solution: Solution<'n>,
    /// Image points that were rejected, if they were looked for.
    pub found: Vec<Found>,
    /// Covariances, with the estimated variance factor where there is redundancy.
    pub covariances: Covariances,
    /// Redundancy numbers and tests of the image points; `None` if the test cannot be made for want of redundancy.
    pub reliability: Option<Reliability>,
    /// The same observations with other sets of parameters; `None` until [`Calibration::compare`].
    pub compared: Option<Compared>,
}

/// Joins points with control and finds start values for everything.
///
/// # Errors
/// No point in common, an unknown model or parameter, too few control points in an image, a datum of unknown targets.
pub fn prepare(points: &[PointRow], control: &[ControlRow], settings: &Settings) -> Result<Prepared, CalibrationError> {
    let survey = Survey::new(points, control)?;
    let owners = optics::owners(&settings.cameras, &survey.images)?;
    let starts = start::starts(&survey, &owners, settings)?;
    let (network, sights, left_out) = network::network(&survey, &owners, &starts, settings)?;
    Ok(Prepared { settings: settings.clone(), survey, origins: starts.origins, network, sights, left_out, unmeasured: Vec::new() })
}

impl Prepared {
    /// Adjusts.
    ///
    /// # Errors
    /// What the network does not determine, by name; what else [`adjust`] refuses.
    pub fn adjust(&self) -> Result<Calibration<'_>, CalibrationError> {
        let options = Options { huber: self.settings.huber, most_iterations: ITERATIONS, ..Options::default() };
        let test = Test { variance: self.settings.tested(), ..Test::default() };
        let (solution, found) = if self.settings.snoop {
            snoop(&self.network, &options, Snooping { test, ..Snooping::default() })?
        } else {
            (adjust(&self.network, &options)?, Vec::new())
        };
        let checked = solution.counts().redundancy() > 0;
        let covariances = solution.covariances(if checked { Variance::Estimated } else { Variance::Apriori })?;
        let reliability = if checked { Some(solution.reliability(test)?) } else { None };
        Ok(Calibration { prepared: self, solution, found, covariances, reliability, compared: None })
    }
}

impl Calibration<'_> {
    /// Adjusts with other sets of parameters as well; report and summary then have a table of them.
    ///
    /// # Errors
    /// As [`compare_sets`].
    pub fn compare(&mut self, sets: &[Vec<String>]) -> Result<(), CalibrationError> {
        self.compared = Some(compare_sets(self, sets)?);
        Ok(())
    }

    /// The interior orientation of a camera.
    pub fn camera(&self, index: usize) -> &Camera {
        &self.solution.cameras()[index]
    }

    /// How many cameras there are.
    pub fn cameras(&self) -> usize {
        self.solution.cameras().len()
    }

    /// The name of a camera.
    pub fn name_of(&self, camera: usize) -> &str {
        &self.prepared.settings.cameras[camera].name
    }

    /// A parameter's name; with its camera's if there are several.
    pub fn parameter_name(&self, &(camera, name): &(usize, &'static str)) -> String {
        if self.cameras() > 1 { format!("{}.{name}", self.name_of(camera)) } else { name.to_owned() }
    }

    /// The camera of an image.
    pub fn owner(&self, image: usize) -> usize {
        self.prepared.network.images[image].camera
    }

    /// Root mean square of the residuals in use, px: `sqrt(mean(vx^2 + vy^2))`.
    pub fn rms_px(&self) -> f64 {
        let used = self.solution.residuals().into_iter().filter(|r| r.used != calibench_adjust::Use::LeftOut).filter_map(|r| r.v);
        let (sum, count) = used.fold((0.0, 0), |(sum, count), [x, y]| (sum + x * x + y * y, count + 1));
        (sum / f64::from(count.max(1))).sqrt()
    }
}
