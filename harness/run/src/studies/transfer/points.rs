//! Check points from a camera that is applied: exterior orientations, then intersections.

use calibench_adjust::approximate::{ApproximateError, Sight, fit_pose, intersect};
use calibench_calibrate::pose_of;
use calibench_model::Pose;
use calibench_model::camera::Camera;
use calibench_scenario::studies::transfer::Conditions;
use nalgebra::{Point3, Vector3};

use super::Campaign;
use super::drawn::Drawn;

/// Rays that meet at less are parallel, rad.
const PARALLEL: f64 = 1e-3;

/// A check point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked {
    /// Its place in the field.
    pub target: usize,
    /// Where it was found, object units.
    pub at: Point3<f64>,
    /// Found less true, object units.
    pub error: Vector3<f64>,
    /// Found less surveyed, object units.
    pub to_survey: Vector3<f64>,
}

/// Intersects the check points that are measured in two stations, in the order of the scenario. `held` are the exterior orientations of all stations, which
/// are resected with `camera` where `conditions` do not hold them.
///
/// # Errors
/// In words: a station that is not resected, a point whose rays do not meet, no point in two stations.
pub fn checked(
    campaign: &Campaign<'_>,
    drawn: &Drawn<'_>,
    camera: &Camera,
    held: &[Pose],
    conditions: &Conditions,
) -> Result<Vec<Checked>, String> {
    let transfer = campaign.transfer;
    let stations = campaign.check_stations(conditions);
    let poses: Vec<Pose> = if conditions.held {
        stations.iter().map(|&station| held[station]).collect()
    } else {
        stations
            .iter()
            .map(|&station| resected(campaign, drawn, camera, (station, &held[station]), conditions))
            .collect::<Result<_, _>>()?
    };
    let mut sights: Vec<Vec<Sight<'_>>> = vec![Vec::new(); campaign.truth.len()];
    for (&station, pose) in stations.iter().zip(&poses) {
        for &(target, image) in drawn.seen(station, conditions.measurement) {
            sights[target].push(Sight { camera, pose, image });
        }
    }
    let point = |&target: &usize| {
        let found = intersect(&sights[target], PARALLEL, None).map_err(|error| told(campaign, (drawn, conditions), target, &error))?;
        let (at, surveyed) = (found.point, drawn.surveyed(target, conditions.survey));
        Ok(Checked { target, at, error: at - campaign.truth[target], to_survey: at - surveyed })
    };
    let found: Vec<Checked> =
        transfer.check.iter().filter(|target| sights[**target].len() > 1).map(point).collect::<Result<_, String>>()?;
    if found.is_empty() { Err("no check point was measured in two of the images".into()) } else { Ok(found) }
}

/// Why a check point is not intersected, with the image that it is about.
fn told(campaign: &Campaign<'_>, (drawn, conditions): (&Drawn<'_>, &Conditions), target: usize, error: &ApproximateError) -> String {
    let name = &campaign.subject.field.targets[target].id;
    let image = |index: usize| {
        let sees = |station: usize| drawn.seen(station, conditions.measurement).iter().any(|seen| seen.0 == target);
        let mut stations = campaign.check_stations(conditions).iter().filter(|&&station| sees(station));
        stations.nth(index).map_or("", |&station| &campaign.subject.stations[station].name)
    };
    match *error {
        ApproximateError::NotInCamera { index } => format!("point {name} in image {}: the camera pictures nothing there", image(index)),
        ApproximateError::Behind { index } => format!("point {name}: the rays meet behind image {}", image(index)),
        _ => format!("point {name}: {error}"),
    }
}

fn resected(
    campaign: &Campaign<'_>,
    drawn: &Drawn<'_>,
    camera: &Camera,
    (station, near): (usize, &Pose),
    conditions: &Conditions,
) -> Result<Pose, String> {
    let control = drawn.control(station, conditions);
    let found = fit_pose(camera, near, &control).map(|found| found.pose).or_else(|_| pose_of(camera, &control));
    found.map_err(|why| format!("image {}: {why}", campaign.subject.stations[station].name))
}
