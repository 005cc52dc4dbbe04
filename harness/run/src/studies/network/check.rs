//! The second step: object points from a few images, with the camera of the first held and a few control points.

use calibench_adjust::approximate::{Control, Sight, intersect};
use calibench_adjust::{Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, adjust};
use calibench_calibrate::pose_of;
use calibench_model::camera::Camera;
use calibench_model::{ControlRow, Pose};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::studies::network::CheckPlan;
use nalgebra::Point3;

use super::adjustment::control_point;
use super::{ImagePoint, Job, Observed};
use crate::rmse::Rmse;
use crate::studies::accepted;

/// Rays that meet at less are parallel, rad.
const PARALLEL: f64 = 1e-3;

/// Errors of the check points, against the truth and against the survey; the camera is held at `camera`.
///
/// # Errors
/// In words: an image without a pose, no check point, or what the network does not determine.
pub fn check(job: &Job<'_>, plan: &CheckPlan, observed: &Observed, method: usize, camera: &Camera) -> Result<Vec<Figure>, String> {
    let mine = observed.points.iter().filter(|point| point.method == method && plan.views.contains(&point.view));
    let mine: Vec<&ImagePoint> = mine.collect();
    let poses = poses(job, plan, observed, &mine, camera)?;
    let (mut points, mut targets) = (Vec::new(), Vec::new());
    for &target in plan.control.iter().chain(&plan.points) {
        let sights: Vec<Sight<'_>> = mine.iter().filter(|p| p.target == target).filter_map(|p| sight(plan, &poses, camera, p)).collect();
        let name = &job.field.targets[target].id;
        if plan.control.contains(&target) {
            if !sights.is_empty() {
                targets.push(target);
                points.push(control_point(job, name, observed.control[target]));
            }
        } else if sights.len() > 1
            && let Ok(found) = intersect(&sights, PARALLEL, None)
        {
            targets.push(target);
            points.push(ObjectPoint::free(name.as_str(), found.point));
        }
    }
    let place = |list: &[usize], value: usize| list.iter().position(|known| *known == value);
    let observation = |p: &&ImagePoint| {
        let (image, point) = (place(&plan.views, p.view)?, place(&targets, p.target)?);
        Some(ImageObservation::new(image, point, p.at, job.calibration.sigma_px))
    };
    let observations = mine.iter().filter_map(observation).collect();
    let images = plan.views.iter().zip(&poses).map(|(&view, pose)| Exterior::free(job.stations[view].name.clone(), 0, *pose)).collect();
    let network = Network { cameras: vec![Interior::fixed("the camera", *camera)], images, points, observations, ..Network::default() };
    let solution = adjust(&network, &Options::default()).map_err(|error| error.to_string())?;
    figures(job, plan, observed, &targets, solution.points())
}

fn poses(job: &Job<'_>, plan: &CheckPlan, observed: &Observed, mine: &[&ImagePoint], camera: &Camera) -> Result<Vec<Pose>, String> {
    let pose = |&view: &usize| {
        let seen = mine.iter().filter(|p| p.view == view && plan.control.contains(&p.target));
        let control: Vec<Control> = seen.map(|p| Control { object: observed.control[p.target], image: p.at }).collect();
        pose_of(camera, &control).map_err(|why| format!("image {}: {why}", job.stations[view].name))
    };
    plan.views.iter().map(pose).collect()
}

fn sight<'a>(plan: &CheckPlan, poses: &'a [Pose], camera: &'a Camera, point: &ImagePoint) -> Option<Sight<'a>> {
    let image = plan.views.iter().position(|view| *view == point.view)?;
    Some(Sight { camera, pose: &poses[image], image: point.at })
}

/// RMSE_XY is 2D, `sqrt(mean(dx^2 + dy^2))`; the distance is the mean from the true stations to the check points.
fn figures(job: &Job<'_>, plan: &CheckPlan, observed: &Observed, targets: &[usize], points: &[Point3<f64>]) -> Result<Vec<Figure>, String> {
    let checked: Vec<(usize, Point3<f64>)> =
        targets.iter().zip(points).filter(|(target, _)| plan.points.contains(target)).map(|(target, point)| (*target, *point)).collect();
    if checked.is_empty() {
        return Err("no check point was measured in two of the images".into());
    }
    let count = checked.len() as f64;
    let rmse = |reference: &dyn Fn(usize) -> Point3<f64>| {
        let Rmse { axes: [.., z], planimetric, .. } = Rmse::of(checked.iter().map(|(target, point)| point - reference(*target)));
        [planimetric, z]
    };
    let truth = |target: usize| job.field.position(&job.field.targets[target]);
    let surveyed = |target: usize| observed.control[target];
    let distances = plan.views.iter().flat_map(|&view| checked.iter().map(move |(target, _)| (view, *target)));
    let sum: f64 = distances.map(|(view, target)| (job.stations[view].pose.centre - truth(target)).norm()).sum();
    let distance = sum / (count * plan.views.len() as f64);
    let unit = job.unit.name();
    let [xy, z] = rmse(&truth);
    let [xy_survey, z_survey] = rmse(&surveyed);
    let mut figures = vec![
        Figure::plain(Quantity::RmseXy, xy, unit),
        Figure::plain(Quantity::RmseZ, z, unit),
        Figure::plain(Quantity::RmseXySurvey, xy_survey, unit),
        Figure::plain(Quantity::RmseZSurvey, z_survey, unit),
        Figure::plain(Quantity::Distance, distance, unit),
        Figure::plain(Quantity::CheckPoints, count, ""),
    ];
    if let Some(classes) = plan.acceptance {
        let row = |target: usize, at: Point3<f64>| ControlRow::new(&job.field.targets[target].id, at.coords.into());
        let sigmas = Some([job.calibration.survey_sigma; 3]);
        let control = |&target: &usize| ControlRow { sigmas, ..row(target, observed.control[target]) };
        let measured: Vec<ControlRow> = checked.iter().map(|&(target, at)| row(target, at)).collect();
        figures.extend(accepted::points(classes, &plan.points.iter().map(control).collect::<Vec<_>>(), &measured));
    }
    Ok(figures)
}
