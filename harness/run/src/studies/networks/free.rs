//! A free network of a trial.

use calibench_adjust::{Options, adjust};
use calibench_calibrate::{AdjustedLength, Calibration, calibrate, prepare_free};
use calibench_model::{MeasuredDistance, TestLength};
use calibench_random::{Key, Purpose, stream};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::studies::acceptance::TestLines;
use calibench_scenario::studies::networks::Bar;
use nalgebra::DVector;
use rand_distr::{Distribution, StandardNormal};

use super::errors::{ITERATIONS, Whole, lengths, together};
use crate::studies::accepted;
use crate::studies::told::Trial;

/// The figures of a network from image points and distances alone.
///
/// # Errors
/// Why it cannot be adjusted, in words.
pub(super) fn figures(
    trial: &Trial<'_>,
    (distances, asked, acceptance): (&[Bar], &[[usize; 2]], Option<&TestLines>),
    key: Key<'_>,
) -> Result<Vec<Figure>, String> {
    let names = |between: &[usize; 2]| between.map(|target| trial.subject.field.targets[target].id.clone());
    let mut settings = trial.settings(vec![trial.optics("camera", "*")?]);
    settings.distances = distances.iter().filter_map(|bar| measured(trial, names(&bar.between), bar.sigma, key)).collect();
    let tested = acceptance.map(|plan| accepted::calibrated(plan, trial, key)).unwrap_or_default();
    let is_there = |length: &&TestLength| length.targets.iter().all(|name| trial.images_of(name) > 1);
    settings.lengths = asked.iter().map(names).chain(tested.iter().filter(is_there).map(|length| length.targets.clone())).collect();
    let prepared = prepare_free(trial.points.clone(), &[], &settings).map_err(|error| error.to_string())?;
    let figures = |found: &Calibration<'_>| {
        let lengths = found.lengths().map_err(|error| error.to_string())?;
        // Those that are looked at were asked for before those that are tested.
        let free: Vec<AdjustedLength> = lengths.into_iter().filter(|length| length.measured.is_none()).collect();
        let (looked_at, measured) = free.split_at(asked.len());
        let mut figures = of(trial, found, looked_at)?;
        let kept = acceptance.map(|plan| accepted::lengths(plan, tested.clone(), measured, &settings.distances, trial.subject.unit.name()));
        figures.extend(kept.into_iter().flatten());
        Ok(figures)
    };
    calibrate(&prepared, &[], figures).map_err(|error| error.to_string())?
}

/// A distance as it is measured in the trial of `key`.
fn measured(trial: &Trial<'_>, targets: [String; 2], sigma: f64, key: Key<'_>) -> Option<MeasuredDistance> {
    let [from, to] = targets.each_ref().map(|name| trial.target(name));
    // It is a part of the trial's survey, beside its points.
    let name = targets.join(" ");
    let error: f64 = StandardNormal.sample(&mut stream(Key { view: "", target: &name, ..key }, Purpose::Control));
    Some(MeasuredDistance { value: (to? - from?).norm() + sigma * error, sigma, targets })
}

fn of(trial: &Trial<'_>, found: &Calibration<'_>, looked_at: &[AdjustedLength]) -> Result<Vec<Figure>, String> {
    let counts = found.solution.counts();
    let whole = Whole {
        cost: found.solution.cost(),
        redundancy: counts.redundancy(),
        image_points: counts.image_coordinates / 2,
        in_doubt: !found.doubts().is_empty(),
        from_truth: from_truth(trial, found),
    };
    let mut figures = whole.figures();
    let (names, covariance) = found.covariances.of_camera(0);
    let camera = found.camera(0);
    let errors: Option<Vec<f64>> = names.iter().map(|name| trial.error(camera, name)).collect();
    let errors = errors.ok_or("the model has other parameters than [camera]")?;
    figures.extend(together(&DVector::from_vec(errors), &covariance, whole.redundancy));
    for (place, name) in names.iter().enumerate() {
        let parameter = calibench_model::camera::CameraModel::parameters(camera).into_iter().find(|parameter| parameter.name == *name);
        figures.extend(parameter.map(|parameter| Figure {
            name: Quantity::Parameter.of(&[name]),
            value: parameter.value,
            sigma: Some(covariance[(place, place)].max(0.0).sqrt()),
            error: trial.error(camera, name),
            unit: parameter.unit,
        }));
    }
    let error = |length: &AdjustedLength| {
        let [from, to] = length.targets.each_ref().map(|name| trial.target(name));
        Some((length.value - (to? - from?).norm(), length.sigma))
    };
    let all: Vec<(f64, f64)> = looked_at.iter().filter_map(error).collect();
    figures.extend(lengths(&all, whole.redundancy));
    Ok(figures)
}

/// The weighted sum of squares of the minimum that the truth leads to, of the same image points.
fn from_truth(trial: &Trial<'_>, found: &Calibration<'_>) -> Option<f64> {
    let mut network = found.prepared.network.clone();
    network.cameras.iter_mut().for_each(|interior| interior.camera = trial.camera);
    for image in &mut network.images {
        image.pose = trial.pose(&image.name)?;
    }
    for point in &mut network.points {
        point.position = trial.target(&point.name)?;
    }
    let left_out = found.found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
    Some(adjust(&network, &Options { left_out, most_iterations: ITERATIONS, ..Options::default() }).ok()?.cost())
}
