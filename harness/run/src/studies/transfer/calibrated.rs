//! Calibrations: bundles from control and from the board.

use calibench_adjust::approximate::{Control, planar_poses};
use calibench_adjust::{Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, Solution, Variance, adjust};
use calibench_calibrate::{BoardSolver, pose_of};
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel};
use calibench_scenario::studies::transfer::{Calibrates, Conditions, Method, NO_SOLVER, Solver};
use nalgebra::Point3;

use super::drawn::Drawn;
use super::{Campaign, Seen};

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
    /// Points in rendered images that were not measured.
    pub missed: usize,
}

/// What an adjustment says of itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Standard deviation of the principal distance, mm, with the estimated variance factor; none of a tool that gives none.
    pub sigma_c: Option<f64>,
    /// Standard deviation of unit weight, a number.
    pub sigma0: f64,
    /// Observations minus unknowns.
    pub redundancy: i64,
}

/// The calibration of the method at `place` under `conditions`. Exterior orientations of stations start from `near`, or from resections with the data sheet's camera.
///
/// # Errors
/// In words: what cannot be oriented, what the images do not determine, no convergence.
pub fn calibration(
    campaign: &Campaign<'_>,
    drawn: &Drawn<'_>,
    place: usize,
    conditions: &Conditions,
    near: Option<&[Pose]>,
) -> Result<Calibration, String> {
    let method = &campaign.transfer.methods[place];
    match method.calibrates {
        Calibrates::Never => Ok(Calibration { camera: method.start, poses: Vec::new(), quality: None, missed: 0 }),
        Calibrates::FromControl => from_control(campaign, drawn, method, conditions, near),
        Calibrates::FromBoard { sigma_px, solver } => {
            let sigma_px = conditions.board_sigma_px.unwrap_or(sigma_px);
            let (views, missed) = drawn.boards(place, sigma_px, conditions)?;
            let targets = campaign.transfer.board.iter().flat_map(|board| &board.field.targets);
            let corners: Vec<Point3<f64>> = targets.map(|target| target.surveyed).collect();
            let (board, pitch_um) = (Board { corners: &corners, views: &views, sigma_px }, campaign.transfer.pitch_um);
            let found = match solver {
                Solver::Own => from_board(method, &board, pitch_um)?,
                Solver::Opencv => by_another(campaign.tools.solver.ok_or(NO_SOLVER)?, method, &board, pitch_um)?,
            };
            Ok(Calibration { missed, ..found })
        }
    }
}

/// A board as it was measured.
struct Board<'a> {
    /// Where its corners are meant to be, the board's units.
    corners: &'a [Point3<f64>],
    /// What was measured in each view; nothing in one where it was not found.
    views: &'a [Vec<Seen>],
    /// Standard deviation of a coordinate, px.
    sigma_px: f64,
}

impl Board<'_> {
    /// The views in which it was found, with their numbers.
    fn found(&self) -> impl Iterator<Item = (usize, &[Seen], Vec<Control>)> {
        let control = |&(corner, image): &Seen| Control { object: self.corners[corner], image };
        let found = self.views.iter().zip(1..).filter(|(view, _)| !view.is_empty());
        found.map(move |(view, number)| (number, view.as_slice(), view.iter().map(control).collect()))
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
    let used = campaign.all_stations(conditions);
    let mut poses = match near {
        Some(poses) => poses.to_vec(),
        None => {
            let pose = |place: usize| {
                pose_of(&method.start, &some(&drawn.control(place, conditions)))
                    .map_err(|why| format!("image {}: {why}", stations[place].name))
            };
            (0..stations.len()).map(pose).collect::<Result<_, _>>()?
        }
    };
    let mut network = start(method)?;
    network.images = used.iter().map(|&place| Exterior::free(stations[place].name.as_str(), 0, poses[place])).collect();
    let mut places = vec![None; campaign.truth.len()];
    for &target in &transfer.control {
        places[target] = Some(network.points.len());
        let (name, at) = (campaign.subject.field.targets[target].id.as_str(), drawn.surveyed(target, conditions.survey));
        network.points.push(match transfer.survey_sigma {
            sigma if sigma > 0.0 => ObjectPoint::observed(name, at, [sigma; 3]),
            _ => ObjectPoint::fixed(name, at),
        });
    }
    for (image, &station) in used.iter().enumerate() {
        let seen = drawn.seen(station, conditions.measurement).iter();
        let of = |&(target, at): &(usize, _)| Some(ImageObservation::new(image, places[target]?, at, transfer.sigma_px));
        network.observations.extend(seen.filter_map(of));
    }
    let found = solved(&network, transfer.pitch_um)?;
    for (&station, pose) in used.iter().zip(&found.poses) {
        poses[station] = *pose;
    }
    let missed = if conditions.measurement { drawn.missed() } else { 0 };
    Ok(Calibration { poses, missed, ..found })
}

/// What another tool makes of the same corners, with all its parameters and no start but its own.
fn by_another(solver: &dyn BoardSolver, method: &Method, board: &Board<'_>, pitch_um: f64) -> Result<Calibration, String> {
    let views: Vec<Vec<Control>> = board.found().map(|(.., control)| control).collect();
    let found = solver.solve(method.start.size(), &views)?;
    let corners: usize = views.iter().map(Vec::len).sum();
    let redundancy = 2 * corners as i64 - 6 * views.len() as i64 - method.parameters.len() as i64;
    let sigma0 = found.rms_px / board.sigma_px * (corners as f64 / redundancy.max(1) as f64).sqrt();
    let sigma_c = found.sigma_f_px.map(|sigma| sigma * pitch_um * 1e-3);
    Ok(Calibration { camera: found.camera, poses: Vec::new(), quality: Some(Quality { sigma_c, sigma0, redundancy }), missed: 0 })
}

/// Some of many control points, spread over their order: start values need no more.
fn some(control: &[Control]) -> Vec<Control> {
    control.iter().step_by(control.len().div_ceil(ENOUGH).max(1)).copied().collect()
}

fn from_board(method: &Method, board: &Board<'_>, pitch_um: f64) -> Result<Calibration, String> {
    let mut network = start(method)?;
    network.points = board.corners.iter().zip(1..).map(|(at, i)| ObjectPoint::fixed(format!("corner {i}"), *at)).collect();
    for (image, (number, view, control)) in board.found().enumerate() {
        let name = format!("view {number}");
        let poses = planar_poses(&method.start, &control).map_err(|error| format!("{name}: {error}"))?;
        let best = poses.first().ok_or_else(|| format!("{name}: no pose before the board"))?;
        network.images.push(Exterior::free(name, 0, best.pose));
        network.observations.extend(view.iter().map(|&(corner, at)| ImageObservation::new(image, corner, at, board.sigma_px)));
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
    Ok(Calibration { camera: solution.cameras()[0], poses: solution.poses().to_vec(), quality: Some(quality), missed: 0 })
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
    let (sigma_c, sigma0) = (Some(variance.max(0.0).sqrt()), solution.sigma0().unwrap_or(0.0));
    Ok(Quality { sigma_c, sigma0, redundancy: solution.counts().redundancy() })
}

#[cfg(test)]
mod tests {
    use calibench_model::PixelPoint;

    use super::*;

    #[test]
    fn views_keep_their_numbers_where_the_board_was_not_found() {
        let corners = [0.0, 30.0, 60.0].map(|x| Point3::new(x, 0.0, 0.0));
        let at = |x| PixelPoint::new(x, 7.0);
        let views = [vec![(0, at(1.0))], Vec::new(), vec![(2, at(5.0)), (1, at(3.0))]];
        let board = Board { corners: &corners, views: &views, sigma_px: 0.1 };
        let found: Vec<_> = board.found().collect();
        assert_eq!(found.iter().map(|(number, view, _)| (*number, *view)).collect::<Vec<_>>(), [(1, &views[0][..]), (3, &views[2][..])]);
        let control: Vec<_> = found[1].2.iter().map(|control| (control.object, control.image)).collect();
        assert_eq!(control, [(corners[2], at(5.0)), (corners[1], at(3.0))]);
    }
}
