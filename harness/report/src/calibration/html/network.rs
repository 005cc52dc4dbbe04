//! Stations, points and rays of a network.

use calibench_model::upper_median;

use crate::camera_card::view;
use crate::html::{Scene, ScenePoint, Station};
use calibench_adjust::Status;
use calibench_calibrate::Calibration;

/// Rays that are drawn at most.
const RAYS: usize = 60_000;

pub(super) fn figure(calibration: &Calibration<'_>) -> String {
    let (stations, points, rays) = (stations(calibration), points(calibration), rays(calibration));
    let factor = factor(&stations, &points);
    let shown = if rays.len() < calibration.prepared.network.observations.len() { " Not all rays are there." } else { "" };
    let ellipsoids = if points.iter().any(|point| point.covariance.is_some()) {
        format!(" Error ellipsoids are {factor} times too large.")
    } else {
        " The points are fixed: they have no error ellipsoids.".to_owned()
    };
    let scene = Scene { stations, points, rays, factor };
    scene.figure(&format!("Stations and object points.{ellipsoids}{shown}"))
}

pub(in super::super) fn stations(calibration: &Calibration<'_>) -> Vec<Station> {
    let station = |(image, pose): (usize, &calibench_model::Pose)| {
        let [wide, high, _] = view(calibration.camera(calibration.owner(image)));
        Station {
            name: calibration.prepared.survey.images[image].clone(),
            group: image,
            centre: [pose.centre.x, pose.centre.y, pose.centre.z],
            rotation: std::array::from_fn(|i| pose.rotation[(i / 3, i % 3)]),
            half: [wide, high].map(tangent),
        }
    };
    calibration.solution.poses().iter().enumerate().map(station).collect()
}

/// Of half an angle of view, degrees; a fisheye's frustum is drawn as wide as can be.
fn tangent(angle: Option<f64>) -> f64 {
    (angle.unwrap_or(90.0) / 2.0).min(70.0).to_radians().tan()
}

pub(in super::super) fn points(calibration: &Calibration<'_>) -> Vec<ScenePoint> {
    let known = &calibration.prepared.network.points;
    let point = |(index, place): (usize, &nalgebra::Point3<f64>)| {
        let c = &calibration.covariances.points[index];
        let covariance = [c[(0, 0)], c[(0, 1)], c[(0, 2)], c[(1, 1)], c[(1, 2)], c[(2, 2)]];
        ScenePoint {
            name: known[index].name.clone(),
            place: [place.x, place.y, place.z],
            covariance: covariance.iter().any(|value| *value > 0.0).then_some(covariance),
            is_control: !known[index].coordinates.contains(&Status::Free),
        }
    };
    calibration.solution.points().iter().enumerate().map(point).collect()
}

fn rays(calibration: &Calibration<'_>) -> Vec<[usize; 2]> {
    let observations = &calibration.prepared.network.observations;
    let every = observations.len().div_ceil(RAYS).max(1);
    observations.iter().step_by(every).map(|observation| [observation.image, observation.point]).collect()
}

/// The longest side of the box around everything, object units; positive.
pub(in super::super) fn extent(stations: &[Station], points: &[ScenePoint]) -> f64 {
    let all = || stations.iter().map(|s| s.centre).chain(points.iter().map(|p| p.place));
    let side = |axis: usize| {
        let (low, high) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| (low.min(p[axis]), high.max(p[axis])));
        high - low
    };
    [0, 1, 2].map(side).into_iter().fold(f64::MIN_POSITIVE, f64::max)
}

/// A round number of times by which the median ellipsoid is about a hundredth of the network.
pub(in super::super) fn factor(stations: &[Station], points: &[ScenePoint]) -> f64 {
    let sigmas = points.iter().filter_map(|p| p.covariance).map(|c| c[0].max(c[3]).max(c[5]).sqrt());
    match upper_median(sigmas) {
        Some(middle) if middle > 0.0 => crate::field::stretch(0.01 * extent(stations, points), middle),
        _ => 1.0,
    }
}
