//! What the adjustment is given in a trial: image points with the error that all methods share, and a survey.

use std::collections::HashMap;

use calibench_model::{Measurement, PixelPoint};
use calibench_random::{Key, Purpose, stream};
use calibench_records::results::{Outcome, PointResult};
use calibench_synth::pointing::{Hand, MapError};
use nalgebra::{Point3, Vector3};
use rand_distr::{Distribution, StandardNormal};

use super::Job;

/// An image point by its place in the lists.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImagePoint {
    /// The method.
    pub method: usize,
    /// The station.
    pub view: usize,
    /// The target.
    pub target: usize,
    /// Image coordinates, px.
    pub at: PixelPoint,
}

/// What a trial's adjustments are given.
#[derive(Clone, Debug, PartialEq)]
pub struct Observed {
    /// All image points that were measured, lost ones among them: nobody knows which they are.
    pub points: Vec<ImagePoint>,
    /// Of each target, as surveyed for this trial, object units.
    pub control: Vec<Point3<f64>>,
}

/// The image points of a trial with their common error, and its survey.
pub fn observe(job: &Job<'_>, points: &[PointResult], key: Key<'_>) -> Observed {
    let views: HashMap<&str, usize> = job.stations.iter().enumerate().map(|(i, station)| (station.name.as_str(), i)).collect();
    let targets: HashMap<&str, usize> = job.field.targets.iter().enumerate().map(|(i, target)| (target.id.as_str(), i)).collect();
    let floor = Hand { sigma: job.calibration.floor_px, whole_pixels: false, map: MapError::default() };
    let point = |point: &PointResult| {
        let Outcome::Measured { position, .. } = point.outcome else { return None };
        let at = if floor.sigma > 0.0 {
            floor.point(position, &mut stream(Key { view: &point.view, target: &point.target, ..key }, Purpose::CommonError))
        } else {
            position
        };
        Some(ImagePoint { method: point.method, view: *views.get(&*point.view)?, target: *targets.get(&*point.target)?, at })
    };
    let sigma = job.calibration.survey_sigma;
    let survey = |target: &calibench_model::ObjectTarget| {
        let mut rng = stream(Key { view: "", target: &target.id, ..key }, Purpose::Control);
        let error: Vector3<f64> = Vector3::from_fn(|_, _| StandardNormal.sample(&mut rng));
        target.surveyed + error * sigma
    };
    Observed { points: points.iter().filter_map(point).collect(), control: job.field.targets.iter().map(survey).collect() }
}

/// A coordinate that is drawn in place of a measurement: the truth with an error of `sigma` px per axis.
pub fn draw(truth: PixelPoint, sigma: f64, method: &str, key: Key<'_>) -> Measurement {
    // Methods must not share their errors: the label is part of the key.
    let name = format!("{method} {}", key.target);
    let hand = Hand { sigma, whole_pixels: false, map: MapError::default() };
    Measurement { position: hand.point(truth, &mut stream(Key { target: &name, ..key }, Purpose::DrawnPoint)), covariance: None }
}
