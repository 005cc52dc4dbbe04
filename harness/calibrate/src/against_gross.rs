//! Start values, where image points may be in gross error and where they may not.

use calibench_adjust::{Options, adjust_robustly};
use calibench_model::camera::Camera;

use crate::start::{self, Starts};
use crate::{CalibrationError, Rival, Settings, Survey, network, search, stages};

/// Image points up to which starts are compared by adjusting all of them.
const MOST_SIGHTS: usize = 100_000;
/// Iterations of that at most.
const ITERATIONS: usize = 100;
/// Its bound of Huber's weights, in standard deviations.
const BOUND: f64 = 1.5;

/// Start values.
pub(crate) struct Found {
    /// The cameras of the usual start, if there is one.
    pub(crate) plain: Option<Vec<Camera>>,
    pub(crate) starts: Starts,
    pub(crate) rivals: Vec<Rival>,
}

/// The start values of a survey. Where gross errors are looked for, weights that hold them back may take the strong distortion of a wide lens for them; so
/// the start without such weights is found too, and the better one taken.
///
/// # Errors
/// Those of the start.
pub(crate) fn found(survey: &Survey, owners: &[usize], settings: &Settings) -> Result<Found, CalibrationError> {
    let of = |settings: &Settings| -> Result<Found, CalibrationError> {
        let usual = start::starts(survey, owners, settings).and_then(|rough| stages::refined(survey, owners, rough, settings));
        let plain = usual.as_ref().map(|usual| usual.cameras.clone()).ok();
        let (starts, rivals) = search::better(survey, owners, settings, usual)?;
        Ok(Found { plain, starts, rivals })
    };
    let held_back = of(settings);
    if settings.start_huber().is_none() || survey.sights() > MOST_SIGHTS {
        return held_back;
    }
    let even = of(&Settings { huber: None, snoop: false, ..settings.clone() });
    let scale = |found: &Result<Found, CalibrationError>| {
        found.as_ref().ok().and_then(|found| scale(survey, owners, settings, &found.starts)).unwrap_or(f64::INFINITY)
    };
    if scale(&even) < scale(&held_back) { even } else { held_back }
}

/// The scale of the residuals to which a robust adjustment from some start values comes, in a-priori standard deviations.
fn scale(survey: &Survey, owners: &[usize], settings: &Settings, starts: &Starts) -> Option<f64> {
    let (network, ..) = network::network(survey, owners, starts, settings).ok()?;
    let options = Options { most_iterations: ITERATIONS, ..Options::default() };
    adjust_robustly(&network, &options, BOUND).ok()?.0.scale()
}
