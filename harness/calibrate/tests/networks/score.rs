//! Whether a calibration arrived, by class.

use calibench_adjust::{Distance, Network, Options, Solution, adjust, frame_uncertainty};
use calibench_calibrate::{Optics, Settings, prepare};
use calibench_model::camera::{Camera, CameraModel};

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

/// What a calibration from nothing gives.
pub struct Calibrated {
    network: Network,
    /// Sum of squares, px^2 in units of the noise.
    cost: Result<f64, String>,
    warned: bool,
}

fn settings(class: Class, drawn: &Drawn, start: Option<Camera>) -> Settings {
    let optics = Optics { model: Some(class.model.into()), start, ..Optics::new(drawn.camera.size()) };
    Settings { sigma_px: Some(drawn.sigma), ..Settings::new(vec![optics]) }
}

/// Calibrates a network from nothing; an error where nothing can be adjusted.
pub fn calibrated(class: Class, drawn: &Drawn) -> Result<Calibrated, String> {
    let prepared = prepare(drawn.points.clone(), &drawn.control, &settings(class, drawn, None)).map_err(|error| error.to_string())?;
    let adjusted = adjust(&prepared.network, &Options { most_iterations: 1000, ..Options::default() });
    let cost = adjusted.map(|solution| solution.cost()).map_err(|error| error.to_string());
    Ok(Calibrated { cost, warned: !prepared.rivals.is_empty(), network: prepared.network })
}

/// Compares a calibration with the adjustment from the truth. Where nothing could be adjusted that one has the camera as its start; where not even then,
/// nobody can say whether the network determines the camera, and it counts as if it did.
pub fn ended(class: Class, drawn: &Drawn, calibrated: Result<Calibrated, String>) -> Ended {
    let calibrated = match calibrated {
        Ok(calibrated) => calibrated,
        Err(error) => {
            let prepared = prepare(drawn.points.clone(), &drawn.control, &settings(class, drawn, Some(drawn.camera)));
            let least = prepared.map_or(Some(f64::NAN), |prepared| from_truth(drawn, &prepared.network));
            return Ended { end: if least.is_some() { End::Stopped(error) } else { End::Undetermined }, least };
        }
    };
    let Some(least) = from_truth(drawn, &calibrated.network) else { return Ended { end: End::Undetermined, least: None } };
    let end = match calibrated.cost {
        Ok(cost) if cost <= least * (1.0 + REACHED) => End::Reached,
        Ok(cost) => End::Above { ratio: cost / least, warned: calibrated.warned },
        Err(error) => End::Stopped(error),
    };
    Ended { end, least: Some(least) }
}
