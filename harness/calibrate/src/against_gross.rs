//! Start values, where image points may be in gross error and where they may not.

use calibench_adjust::{Options, Residual, adjust_robustly};
use calibench_model::camera::Camera;
use calibench_model::upper_median;

use crate::neighbours::Likeness;
use crate::start::{self, Starts};
use crate::{CalibrationError, GrossErrors, Rival, Settings, Survey, network, search, stages};

/// Image points up to which starts are compared by adjusting all of them.
const MOST_SIGHTS: usize = 100_000;
/// Iterations of that at most.
const ITERATIONS: usize = 100;
/// Its bound of Huber's weights, in standard deviations.
const BOUND: f64 = 1.5;
/// Mean likeness of residuals and those of their neighbours from which they are no errors of single points.
const TOGETHER: f64 = 0.1;
/// Half of the residuals of an image beyond so many standard deviations are no errors of single points.
const LOST: f64 = 5.0;

/// Start values.
pub(crate) struct Found {
    /// The cameras of the usual start, if there is one.
    pub(crate) plain: Option<Vec<Camera>>,
    pub(crate) starts: Starts,
    pub(crate) rivals: Vec<Rival>,
}

/// The start values of a survey. Where gross errors are looked for, those of all points alike come first, which few gross errors do not spoil: they are taken if a
/// robust adjustment leaves nothing from them but errors of single points. Else others are sought against gross errors; but weights that hold these back may take
/// the strong distortion of a wide lens for them, so that of both the better ones are taken.
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
    if settings.gross.of_start().is_none() || survey.sights() > MOST_SIGHTS {
        return of(settings);
    }
    let even = of(&Settings { gross: GrossErrors::Kept, ..settings.clone() });
    let left = |found: &Result<Found, CalibrationError>| Left::of(survey, owners, settings, &found.as_ref().ok()?.starts);
    let left_of_even = left(&even);
    if left_of_even.is_some_and(|left| left.is_single) {
        return even;
    }
    let held_back = of(settings);
    let scale = |left: Option<Left>| left.map_or(f64::INFINITY, |left| left.scale);
    if scale(left_of_even) < scale(left(&held_back)) { even } else { held_back }
}

/// What a robust adjustment leaves.
#[derive(Clone, Copy)]
struct Left {
    /// The scale of the residuals, in a-priori standard deviations.
    scale: f64,
    /// They are errors of single points, in every image.
    is_single: bool,
}

impl Left {
    /// From some start values; `None` where they lead nowhere.
    fn of(survey: &Survey, owners: &[usize], settings: &Settings, starts: &Starts) -> Option<Self> {
        let (network, ..) = network::network(survey, owners, starts, settings).ok()?;
        let options = Options { most_iterations: ITERATIONS, ..Options::default() };
        let solution = adjust_robustly(&network, &options, BOUND).ok()?.0;
        let scale = solution.scale()?;
        let mut lengths = vec![Vec::new(); network.images.len()];
        let white = |residual: Residual| {
            let v = network.observations[residual.observation].precision.whitened(residual.v?);
            Some((residual.image, v[0].hypot(v[1])))
        };
        solution.each_residual().filter_map(white).for_each(|(image, length)| lengths[image].push(length));
        // An image whose pose is wrong.
        let is_lost = |lengths: Vec<f64>| upper_median(lengths).is_some_and(|half| half > LOST * scale);
        let is_single = Likeness::in_images(&solution, |_| true).mean() < TOGETHER && !lengths.into_iter().any(is_lost);
        Some(Self { scale, is_single })
    }
}
