//! Whether all reach one optimum, and who is nearer to it.
//!
//! Relative differences of parameters mislead: at 17 views a weakly determined coefficient of OpenCV's differs by 1.1e-6 of itself where its sum of
//! squares agrees to 15 digits. What counts is a difference in standard deviations of the parameter. Who is right tells a further adjustment from each
//! result: it takes Newton's steps until they gain nothing, and from both it must end at one place.

use std::error::Error;

use calibench_adjust::{Network, Options, Solution, Variance, adjust};
use calibench_model::camera::CameraModel;

use crate::ceres::{self, in_sigmas};
use crate::peers::Mrcal;
use crate::problem;
use crate::theirs::Theirs;

/// Differences above which the optima are not one: of the RMS (relative) and of parameters (in standard deviations).
struct Same {
    rms: f64,
    sigmas: f64,
}

const OPENCV: Same = Same { rms: 1e-9, sigmas: 1e-5 };
const CERES: Same = Same { rms: 1e-9, sigmas: 1e-3 };
/// mrcal lets nobody set when it stops.
const MRCAL: Same = Same { rms: 1e-8, sigmas: 1e-2 };
/// By how much two adjustments from different starts, both of the last step, may differ, in standard deviations.
const ONE_PLACE: f64 = 1e-6;

impl Same {
    fn check(&self, what: &str, rms: f64, sigmas: f64) -> Result<String, Box<dyn Error>> {
        let text = format!("differs by {rms:.1e} in the RMS, {sigmas:.1e} sigma in the parameters");
        // Not a number is no agreement either.
        if rms <= self.rms && sigmas <= self.sigmas { Ok(text) } else { Err(format!("{what} {text}: the optima are not one").into()) }
    }
}

/// mrcal's optimum is ours.
pub(crate) fn mrcal(ours: &Solution, found: &Mrcal) -> Result<String, Box<dyn Error>> {
    if found.parameters.len() != ours.cameras()[0].parameters().len() {
        return Err(format!("mrcal has {} parameters", found.parameters.len()).into());
    }
    MRCAL.check("mrcal", (found.rms / rms(ours) - 1.0).abs(), in_sigmas(ours, &found.parameters)?)
}

/// That of Ceres is ours.
pub(crate) fn ceres(ours: &Solution, found: &ceres::Found) -> Result<String, Box<dyn Error>> {
    let differs = found.differs(ours)?;
    let text = CERES.check("Ceres", differs.root, differs.parameters)?;
    Ok(if found.covariance.is_some() { format!("{text}, {:.1e} in the sigmas", differs.sigmas) } else { text })
}

/// That of OpenCV is ours; it must be one, after as many iterations as it wants.
pub(crate) fn opencv(ours: &Solution, found: &Theirs) -> Result<String, Box<dyn Error>> {
    let text = OPENCV.check("OpenCV", (found.rms / rms(ours) - 1.0).abs(), in_sigmas(ours, &found.parameters)?)?;
    // Up to 4.6 it divides the sum of squares by points less unknowns, not by coordinates less unknowns.
    let sigma = ours.covariances(Variance::Estimated)?.interior[(0, 0)].sqrt();
    Ok(format!("{text}; its sigma of fx is {:.4} times ours", found.sigmas[0] / sigma))
}

/// How far OpenCV's result is from ours: RMS and parameters, relative, and the latter in standard deviations.
pub(crate) fn differences(ours: &Solution, found: &Theirs) -> Result<String, Box<dyn Error>> {
    let pairs = ours.cameras()[0].parameters().into_iter().zip(found.parameters);
    let relative = pairs.map(|(ours, theirs)| (theirs / ours.value - 1.0).abs()).fold(0.0, f64::max);
    let sigmas = in_sigmas(ours, &found.parameters)?;
    let rms = (found.rms / rms(ours) - 1.0).abs();
    Ok(format!("differs by {rms:.1e} in the RMS, {sigmas:.1e} sigma ({relative:.1e} of itself) in the parameters"))
}

/// How far a further adjustment moves OpenCV's parameters and ours, in standard deviations.
pub(crate) fn nearer(network: &Network, ours: &Solution, found: &Theirs) -> Result<String, Box<dyn Error>> {
    let options = Options::default();
    let mut from_ours = network.clone();
    from_ours.cameras[0].camera = ours.cameras()[0];
    for (image, pose) in from_ours.images.iter_mut().zip(ours.poses()) {
        image.pose = *pose;
    }
    let from_theirs = problem::from_theirs(network, found);
    let (end, other) = (adjust(&from_ours, &options)?, adjust(&from_theirs, &options)?);
    let values = |solution: &Solution| solution.cameras()[0].parameters().iter().map(|parameter| parameter.value).collect::<Vec<_>>();
    let apart = in_sigmas(&end, &values(&other))?;
    if apart.is_nan() || apart > ONE_PLACE {
        return Err(format!("adjustments from OpenCV's result and from ours end {apart:.1e} sigma apart").into());
    }
    let (we, they) = (in_sigmas(&end, &values(ours))?, in_sigmas(&end, &found.parameters)?);
    Ok(format!("a further adjustment moves ours by {we:.1e} sigma, OpenCV's by {they:.1e}; from both starts it ends within {apart:.1e}"))
}

/// `sqrt(mean(vx^2 + vy^2))`, px.
fn rms(solution: &Solution) -> f64 {
    let sigma = match solution.network().observations[0].precision {
        calibench_adjust::Precision::Sigma(sigma) => sigma,
        calibench_adjust::Precision::Covariance(_) => 1.0,
    };
    (solution.cost() / solution.network().observations.len() as f64).sqrt() * sigma
}
