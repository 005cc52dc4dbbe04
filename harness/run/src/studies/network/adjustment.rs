//! The first step: interior and exterior orientations of all images together.

use calibench_adjust::approximate::Control;
use calibench_adjust::{
    Covariances, Distance, Exterior, ImageObservation, Interior, Network, ObjectPoint, Options, Solution, Variance, adjust,
    frame_uncertainty,
};
use calibench_calibrate::pose_of;
use calibench_model::Pose;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::convert::{DifferenceOptions, difference};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use nalgebra::Point3;

use super::{Job, Observed, angles, discs};

/// An adjusted camera with its figures.
#[derive(Clone, Debug)]
pub struct Adjusted {
    /// The interior orientation.
    pub camera: Camera,
    /// The exterior orientations.
    pub poses: Vec<Pose>,
    /// What was asked for.
    pub figures: Vec<Figure>,
}

/// Which figures of an adjustment are wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wanted {
    /// Interior orientation and sigma0.
    Interior,
    /// Exterior orientations, the camera over the frame and residuals by image as well.
    All,
    /// Every residual as well.
    Points,
}

/// Adjusts what `method` measured from `starts`, with `parameters` of the camera free.
///
/// # Errors
/// In words: what the network does not determine, or no convergence.
pub fn adjusted(
    job: &Job<'_>,
    observed: &Observed,
    method: usize,
    parameters: &[&str],
    starts: &[Pose],
    wanted: Wanted,
) -> Result<Adjusted, String> {
    let camera: Camera = job.calibration.start.into();
    let interior = Interior::fixed("the camera", camera).free(parameters).map_err(|error| error.to_string())?;
    let mut network = network(job, observed, method, interior, starts);
    if job.calibration.eccentricity {
        discs::centred(job, &mut network)?;
    }
    let solution = adjust(&network, &Options::default()).map_err(|error| error.to_string())?;
    let covariances = solution.covariances(Variance::Estimated).map_err(|error| error.to_string())?;
    let mut figures = interior_figures(job, &solution, &covariances);
    if wanted >= Wanted::All {
        figures.extend(rest(job, &solution, &covariances));
        figures.extend(residuals(job, &solution, wanted));
    }
    Ok(Adjusted { camera: solution.cameras()[0], poses: solution.poses().to_vec(), figures })
}

/// The pose of every image from what `method` measured in it, the survey and the data sheet's camera.
///
/// Poses are in the object's frame, object units.
///
/// # Errors
/// In words, the first image without a pose.
pub fn resections(job: &Job<'_>, observed: &Observed, method: usize) -> Result<Vec<Pose>, String> {
    let camera: Camera = job.calibration.start.into();
    let pose = |(view, station): (usize, &calibench_synth::stations::Station)| {
        let seen = observed.points.iter().filter(|point| point.method == method && point.view == view);
        let control: Vec<Control> = seen.map(|point| Control { object: observed.control[point.target], image: point.at }).collect();
        pose_of(&camera, &control).map_err(|why| format!("image {}: {why}", station.name))
    };
    job.stations.iter().enumerate().map(pose).collect()
}

/// All images that `method` measured points in.
fn network(job: &Job<'_>, observed: &Observed, method: usize, interior: Interior, starts: &[Pose]) -> Network {
    let images = job.stations.iter().zip(starts).map(|(station, pose)| Exterior::free(station.name.clone(), 0, *pose)).collect();
    let mine: Vec<_> = observed.points.iter().filter(|point| point.method == method).collect();
    let mut places = vec![None; job.field.targets.len()];
    let mut points = Vec::new();
    for point in &mine {
        if places[point.target].is_none() {
            places[point.target] = Some(points.len());
            points.push(control_point(job, &job.field.targets[point.target].id, observed.control[point.target]));
        }
    }
    let sigma = job.calibration.sigma_px;
    let observation = |point: &&super::ImagePoint| Some(ImageObservation::new(point.view, places[point.target]?, point.at, sigma));
    let observations = mine.iter().filter_map(observation).collect();
    Network { cameras: vec![interior], images, points, observations, ..Network::default() }
}

/// Control as the scenario tells the adjustment: weighted, or fixed.
pub(crate) fn control_point(job: &Job<'_>, name: &str, at: Point3<f64>) -> ObjectPoint {
    let sigma = job.calibration.control_sigma;
    if sigma > 0.0 { ObjectPoint::observed(name, at, [sigma; 3]) } else { ObjectPoint::fixed(name, at) }
}

fn interior_figures(job: &Job<'_>, solution: &Solution<'_>, covariances: &Covariances) -> Vec<Figure> {
    let (names, matrix) = covariances.of_camera(0);
    let truth = job.camera.parameters();
    let mut figures = Vec::new();
    for parameter in solution.cameras()[0].parameters() {
        let Some(row) = names.iter().position(|name| *name == parameter.name) else { continue };
        let error = truth.iter().find(|t| t.name == parameter.name).map(|t| parameter.value - t.value);
        let sigma = Some(matrix[(row, row)].max(0.0).sqrt());
        figures.push(Figure {
            name: Quantity::Parameter.of(&[parameter.name]),
            value: parameter.value,
            sigma,
            error,
            unit: parameter.unit,
        });
    }
    figures.extend(solution.sigma0().map(|sigma0| Figure::plain(Quantity::Sigma0, sigma0 * job.calibration.sigma_px, "px")));
    let counts = solution.counts();
    figures.push(Figure::plain(Quantity::Redundancy, counts.redundancy() as f64, ""));
    figures.push(Figure::plain(Quantity::ImagePoints, counts.image_coordinates as f64 / 2.0, ""));
    figures
}

fn rest(job: &Job<'_>, solution: &Solution<'_>, covariances: &Covariances) -> Vec<Figure> {
    let mut figures = Vec::new();
    let unit = job.unit.name();
    for ((station, pose), covariance) in job.stations.iter().zip(solution.poses()).zip(&covariances.poses) {
        let figure = |quantity: Quantity, value, sigma, error, unit| Figure {
            name: quantity.of(&[&station.name]),
            value,
            sigma,
            error: Some(error),
            unit,
        };
        for (axis, name) in CENTRE.into_iter().enumerate() {
            let (value, sigma) = (pose.centre[axis], covariance[(axis, axis)].max(0.0).sqrt());
            figures.push(figure(name, value, Some(sigma), value - station.pose.centre[axis], unit));
        }
        let sigmas = angles::sigmas(pose, &covariance.fixed_view::<3, 3>(3, 3).into_owned());
        let (found, truth) = (pose.angles(), station.pose.angles());
        for (k, name) in ANGLES.into_iter().enumerate() {
            let sigma = sigmas.map(|sigmas| sigmas[k].to_degrees());
            let error = angles::difference(found[k], truth[k]).to_degrees();
            figures.push(figure(name, found[k].to_degrees(), sigma, error, "deg"));
        }
    }
    let options = DifferenceOptions { columns: FRAME_COLUMNS, ..DifferenceOptions::default() };
    if let Ok(found) = difference(job.camera, &solution.cameras()[0], &options) {
        let sigma = predicted(&solution.cameras()[0], covariances);
        figures.push(Figure { name: Quantity::OverFrame.into(), value: found.spread.rms_px, sigma, error: None, unit: "px" });
    }
    figures
}

/// The projection centre and the angles of an image.
const CENTRE: [Quantity; 3] = [Quantity::CentreX, Quantity::CentreY, Quantity::CentreZ];
const ANGLES: [Quantity; 3] = [Quantity::Omega, Quantity::Phi, Quantity::Kappa];
/// Columns of the grid over which cameras are compared.
const FRAME_COLUMNS: usize = 16;

/// What the covariance of the camera predicts of its distance from the true one over the frame, px: root mean square, after the best rotation.
fn predicted(camera: &Camera, covariances: &Covariances) -> Option<f64> {
    let (names, matrix) = covariances.of_camera(0);
    let names: Vec<&str> = names.iter().map(AsRef::as_ref).collect();
    let map = frame_uncertainty(camera, (&names, &matrix), (FRAME_COLUMNS, FRAME_COLUMNS * 3 / 4), Distance::Far).ok()?;
    let sum: f64 = map.iter().map(|place| place.covariance.sxx + place.covariance.syy).sum();
    (!map.is_empty()).then(|| (sum / map.len() as f64).sqrt())
}

fn residuals(job: &Job<'_>, solution: &Solution<'_>, wanted: Wanted) -> Vec<Figure> {
    let network = solution.network();
    let mut squares = vec![(0.0, 0_usize); job.stations.len()];
    let mut figures = Vec::new();
    for residual in solution.residuals() {
        let Some(v) = residual.v else { continue };
        let (sum, count) = &mut squares[residual.image];
        *sum += v[0] * v[0] + v[1] * v[1];
        *count += 2;
        for (value, of) in v.into_iter().zip([Quantity::ResidualX, Quantity::ResidualY]).filter(|_| wanted == Wanted::Points) {
            let name = of.of(&[&network.images[residual.image].name, &network.points[residual.point].name]);
            figures.push(Figure::plain(name, value, "px"));
        }
    }
    for (station, (sum, count)) in job.stations.iter().zip(squares).filter(|(_, (_, count))| *count > 0) {
        figures.push(Figure::plain(Quantity::ImageResidual.of(&[&station.name]), (sum / count as f64).sqrt(), "px"));
    }
    figures
}
