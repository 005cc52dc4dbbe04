//! A rig of a trial.

use calibench_adjust::{Options, adjust_rig, mounted, relative};
use calibench_calibrate::rig::{Pairing, RigCalibration, RigSettings, calibrate_rig, motion, prepare_rig};
use calibench_model::{ControlRow, Pose};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;
use calibench_scenario::studies::networks::Mount;
use nalgebra::DVector;

use super::errors::{ITERATIONS, Whole, lengths, together};
use crate::studies::told::Trial;

/// The figures of a rig from image points and surveyed targets alone.
///
/// # Errors
/// Why it cannot be adjusted, in words.
pub(super) fn figures(trial: &Trial<'_>, mounts: &[Mount]) -> Result<Vec<Figure>, String> {
    let cameras = mounts.iter().map(|mount| trial.optics(&mount.name, &mount.image("*"))).collect::<Result<Vec<_>, String>>()?;
    let pairing = Pairing::Names(cameras.iter().map(|optics| optics.images.clone()).collect());
    let row = |target: &calibench_model::ObjectTarget| ControlRow::new(&target.id, target.surveyed.coords.into());
    let control: Vec<ControlRow> = trial.subject.field.targets.iter().map(row).collect();
    let asked = RigSettings { settings: trial.settings(cameras), pairing, origin: 0 };
    let prepared = prepare_rig(&trial.points, &control, &asked).map_err(|error| error.to_string())?;
    let found = calibrate_rig(&prepared).map_err(|error| error.to_string())?;
    of(trial, mounts, &found)
}

/// Where a camera truly sits on the rig, whose frame is the first camera's.
fn truth(mounts: &[Mount], camera: usize) -> Pose {
    relative(&mounts[0].pose, &mounts[camera].pose)
}

fn of(trial: &Trial<'_>, mounts: &[Mount], found: &RigCalibration<'_>) -> Result<Vec<Figure>, String> {
    let counts = found.solution.counts();
    let whole = Whole {
        cost: found.solution.cost(),
        redundancy: counts.redundancy(),
        image_points: counts.image_coordinates / 2,
        in_doubt: !found.doubts.is_empty(),
        from_truth: from_truth(trial, mounts, found),
    };
    let mut figures = whole.figures();
    let covariances = &found.covariances;
    let mut errors = DVector::zeros(covariances.kept.nrows());
    for (row, (camera, name)) in covariances.parameters.iter().enumerate() {
        errors[row] = trial.error(&found.solution.cameras()[*camera], name).ok_or("the model has other parameters than [camera]")?;
    }
    let (unit, mut bases) = (trial.subject.unit.name(), Vec::new());
    for (camera, own) in mounts.iter().enumerate() {
        let Some(first) = covariances.first_of_mount(camera) else { continue };
        let (mount, truth) = (covariances.mount(camera), truth(mounts, camera));
        errors.fixed_rows_mut::<6>(first).copy_from(&motion(&truth, &mount.pose));
        let (distance, sigma) = mount.distance();
        bases.push((distance - truth.centre.coords.norm(), sigma));
        let places = [Quantity::CentreX, Quantity::CentreY, Quantity::CentreZ].into_iter().zip(mount.centre_sigmas()).enumerate();
        figures.extend(places.map(|(axis, (quantity, sigma))| Figure {
            name: quantity.of(&[&own.name]),
            value: mount.pose.centre[axis],
            sigma: Some(sigma),
            error: Some(mount.pose.centre[axis] - truth.centre[axis]),
            unit,
        }));
    }
    figures.extend(together(&errors, &covariances.kept, whole.redundancy));
    figures.extend(lengths(&bases, whole.redundancy));
    Ok(figures)
}

/// The weighted sum of squares of the minimum that the truth leads to, of the same image points.
fn from_truth(trial: &Trial<'_>, mounts: &[Mount], found: &RigCalibration<'_>) -> Option<f64> {
    let mut rig = found.prepared.rig.clone();
    rig.network.cameras.iter_mut().for_each(|interior| interior.camera = trial.camera);
    rig.mounts = (0..mounts.len()).map(|camera| truth(mounts, camera)).collect();
    for station in &mut rig.stations {
        station.pose = trial.pose(&mounts[0].image(&station.name))?;
    }
    for (image, &station) in rig.network.images.iter_mut().zip(&rig.station_of) {
        image.pose = mounted(&rig.mounts[image.camera], &rig.stations[station].pose);
    }
    let left_out = found.found.iter().filter(|found| found.left_out).map(|found| found.observation).collect();
    Some(adjust_rig(&rig, &Options { left_out, most_iterations: ITERATIONS, ..Options::default() }).ok()?.cost())
}
