//! Calibrations: bundles from control and from the board.

use calibench_adjust::approximate::{Control, planar_poses};
use calibench_adjust::{Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, Solution, Variance, adjust};
use calibench_calibrate::pose_of;
use calibench_model::Pose;
use calibench_model::camera::Camera;
use calibench_scenario::transfer::{Calibrates, Conditions, Method};

use super::Campaign;
use super::drawn::Drawn;

/// Control points from which an image is resected for a start.
const ENOUGH: usize = 12;

/// A calibrated camera.
#[derive(Clone, Debug)]
pub struct Calibration {
    /// Its interior orientation, in the model of the method.
    pub camera: Camera,
    /// The exterior orientations of the stations, object units; none from a board.
    pub poses: Vec<Pose>,
    /// What the adjustment says of itself, if there was one.
    pub quality: Option<Quality>,
}

/// What an adjustment says of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Standard deviation of the principal distance, mm, with the estimated variance factor.
    pub sigma_c: f64,
    /// Standard deviation of unit weight, a number.
    pub sigma0: f64,
    /// Observations minus unknowns.
    pub redundancy: i64,
}

/// The calibration of `method` under `conditions`. Exterior orientations of stations start from `near`, or from resections with the data sheet's camera.
///
/// # Errors
/// In words: what cannot be oriented, what the images do not determine, no convergence.
pub fn calibration(
    campaign: &Campaign<'_>,
    drawn: &Drawn<'_>,
    method: &Method,
    conditions: &Conditions,
    near: Option<&[Pose]>,
) -> Result<Calibration, String> {
    match method.calibrates {
        Calibrates::Never => Ok(Calibration { camera: method.start, poses: Vec::new(), quality: None }),
        Calibrates::FromControl => from_control(campaign, drawn, method, conditions, near),
        Calibrates::FromBoard { sigma_px } => {
            let board = campaign.transfer.board.as_ref().ok_or("there is no board")?;
            let sigma_px = conditions.board_sigma_px.unwrap_or(sigma_px);
            let views = drawn.boards(board, method, sigma_px, conditions)?;
            from_board(method, &views, sigma_px, campaign.transfer.pitch_um)
        }
    }
}

fn from_control(
    campaign: &Campaign<'_>,
    drawn: &Drawn<'_>,
    method: &Method,
    conditions: &Conditions,
    near: Option<&[Pose]>,
) -> Result<Calibration, String> {
    let (transfer, stations) = (campaign.transfer, &campaign.subject.stations);
    let poses = match near {
        Some(poses) => poses.to_vec(),
        None => {
            let pose = |(place, station): (usize, &calibench_synth::stations::Station)| {
                pose_of(&method.start, &some(&drawn.control(place, conditions))).map_err(|why| format!("image {}: {why}", station.name))
            };
            stations.iter().enumerate().map(pose).collect::<Result<_, _>>()?
        }
    };
    let mut network = start(method)?;
    network.images = stations.iter().zip(&poses).map(|(station, pose)| Exterior::free(station.name.as_str(), 0, *pose)).collect();
    let mut places = vec![None; campaign.truth.len()];
    for &target in &transfer.control {
        places[target] = Some(network.points.len());
        let (name, at) = (campaign.subject.field.targets[target].id.as_str(), drawn.surveyed(target, conditions.survey));
        network.points.push(match transfer.survey_sigma {
            sigma if sigma > 0.0 => ObjectPoint::observed(name, at, [sigma; 3]),
            _ => ObjectPoint::fixed(name, at),
        });
    }
    for image in 0..stations.len() {
        let seen = drawn.seen(image, conditions.measurement);
        let of = |(target, at): (usize, _)| Some(ImageObservation::new(image, places[target]?, at, transfer.sigma_px));
        network.observations.extend(seen.filter_map(of));
    }
    solved(&network, transfer.pitch_um)
}

/// Some of many control points, spread over their order: start values need no more.
fn some(control: &[Control]) -> Vec<Control> {
    control.iter().step_by(control.len().div_ceil(ENOUGH).max(1)).copied().collect()
}

fn from_board(method: &Method, views: &[Vec<Control>], sigma_px: f64, pitch_um: f64) -> Result<Calibration, String> {
    let mut network = start(method)?;
    let corners = views.first().map_or(&[][..], Vec::as_slice);
    network.points = corners.iter().enumerate().map(|(i, corner)| ObjectPoint::fixed(format!("corner {}", i + 1), corner.object)).collect();
    for (image, view) in views.iter().enumerate() {
        let name = format!("view {}", image + 1);
        let poses = planar_poses(&method.start, view).map_err(|error| format!("{name}: {error}"))?;
        let best = poses.first().ok_or_else(|| format!("{name}: no pose before the board"))?;
        network.images.push(Exterior::free(name, 0, best.pose));
        network
            .observations
            .extend(view.iter().enumerate().map(|(point, corner)| ImageObservation::new(image, point, corner.image, sigma_px)));
    }
    Ok(Calibration { poses: Vec::new(), ..solved(&network, pitch_um)? })
}

/// A network of the method's camera alone.
fn start(method: &Method) -> Result<Network, String> {
    let free: Vec<&str> = method.parameters.iter().map(String::as_str).collect();
    let interior = Interior::fixed("the camera", method.start).free(&free).map_err(|error| error.to_string())?;
    Ok(Network { cameras: vec![interior], ..Network::default() })
}

fn solved(network: &Network, pitch_um: f64) -> Result<Calibration, String> {
    let solution = adjust(network, &Options::default()).map_err(|error| error.to_string())?;
    let quality = quality(&solution, pitch_um)?;
    Ok(Calibration { camera: solution.cameras()[0], poses: solution.poses().to_vec(), quality: Some(quality) })
}

fn quality(solution: &Solution<'_>, pitch_um: f64) -> Result<Quality, String> {
    let covariances = solution.covariances(Variance::Estimated).map_err(|error| error.to_string())?;
    let (names, matrix) = covariances.of_camera(0);
    // The principal distance is one parameter, or the mean of two.
    let weight = |name: &str| match name {
        "c" => 1.0,
        "f" | "F" => pitch_um * 1e-3,
        "fx" | "fy" => 0.5 * pitch_um * 1e-3,
        _ => 0.0,
    };
    let weights: Vec<f64> = names.iter().map(|name| weight(name)).collect();
    let variance: f64 = (0..weights.len())
        .flat_map(|i| (0..weights.len()).map(move |j| (i, j)))
        .map(|(i, j)| weights[i] * matrix[(i, j)] * weights[j])
        .sum();
    Ok(Quality { sigma_c: variance.max(0.0).sqrt(), sigma0: solution.sigma0().unwrap_or(0.0), redundancy: solution.counts().redundancy() })
}
