//! Whether a calibration arrived, by class.

use calibench_adjust::{Distance, Network, Options, Solution, adjust, frame_uncertainty};
use calibench_calibrate::{Optics, Settings, prepare};
use calibench_model::camera::CameraModel;

use crate::draw::{Class, Drawn};

/// A sum of squares that is no more than this above the one from the truth is the same minimum.
const REACHED: f64 = 1e-4;

/// How a calibration ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The network determines no camera, whatever the start.
    Undetermined,
    /// At the minimum.
    Reached,
    /// Above it, with a warning or without one.
    Above { ratio: f64, warned: bool },
    /// An error.
    Stopped(String),
}

/// The adjustment from the truth, and whether the network determines the camera: sigma of fx below 5 %, predicted error over the frame below 2 px.
fn from_truth(drawn: &Drawn, network: &Network) -> Option<f64> {
    let mut network = network.clone();
    network.cameras[0].camera = drawn.camera;
    for image in &mut network.images {
        image.pose = drawn.poses[image.name[1..].parse::<usize>().ok()?];
    }
    let solution: Solution<'_> = adjust(&network, &Options::default()).ok()?;
    let covariances = solution.covariances(calibench_adjust::Variance::Apriori).ok()?;
    let (names, covariance) = covariances.of_camera(0);
    let fx = solution.cameras()[0].parameters()[0].value;
    let sigma = covariance[(0, 0)].sqrt();
    let map = frame_uncertainty(&solution.cameras()[0], (&names, &covariance), (12, 9), Distance::Far).ok()?;
    let squares = map.iter().map(|place| place.covariance.sxx + place.covariance.syy);
    let rms = (squares.sum::<f64>() / map.len().max(1) as f64).sqrt();
    (sigma < 0.05 * fx && rms < 2.0).then(|| solution.cost())
}

/// How a calibration ended, and the least sum of squares, px^2 in units of the noise: that of the adjustment from the truth, if it determines the camera.
#[derive(Clone, Debug)]
pub struct Ended {
    pub end: End,
    pub least: Option<f64>,
}

/// Calibrates a network from nothing and compares.
pub fn ended(class: Class, drawn: &Drawn) -> Ended {
    let optics = Optics { model: Some(class.model.into()), ..Optics::new(drawn.camera.size()) };
    let settings = Settings { sigma_px: Some(drawn.sigma), ..Settings::new(vec![optics]) };
    let prepared = match prepare(drawn.points.clone(), &drawn.control, &settings) {
        Ok(prepared) => prepared,
        Err(error) => return Ended { end: End::Stopped(error.to_string()), least: None },
    };
    let Some(least) = from_truth(drawn, &prepared.network) else { return Ended { end: End::Undetermined, least: None } };
    let end = match adjust(&prepared.network, &Options { most_iterations: 1000, ..Options::default() }) {
        Ok(solution) if solution.cost() <= least * (1.0 + REACHED) => End::Reached,
        Ok(solution) => End::Above { ratio: solution.cost() / least, warned: !prepared.rivals.is_empty() },
        Err(error) => End::Stopped(error.to_string()),
    };
    Ended { end, least: Some(least) }
}
