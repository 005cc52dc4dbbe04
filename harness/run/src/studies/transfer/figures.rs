//! What is reported of a calibration that is applied.

use calibench_model::camera::{Camera, CameraModel};
use calibench_model::convert::{DifferenceOptions, difference};
use calibench_records::figures::Quantity;
use calibench_records::results::Figure;

use super::Campaign;
use super::calibrated::Calibration;
use super::camera::interior;
use super::points::Checked;
use crate::rmse::Rmse;

/// Columns of the grid on which cameras are compared: twice as many change the root mean square by 0.3 % in the median, and by 13 % where nearly all of it lies in the corners.
const COLUMNS: usize = 21;

/// How far `camera` is from the `truth`, px: the root mean square over the frame after the best rotation.
///
/// # Errors
/// In words: cameras that cannot be compared.
pub fn over_frame(truth: &Camera, camera: &Camera) -> Result<f64, String> {
    let options = DifferenceOptions { columns: COLUMNS, ..DifferenceOptions::default() };
    difference(truth, camera, &options).map(|found| found.spread.rms_px).map_err(|error| error.to_string())
}

/// Principal distance and point of what is applied, mm, beside the truth; all parameters of a photogrammetric camera; sigma0 of the calibration.
///
/// # Errors
/// In words: a camera without an axis.
pub fn of_camera(campaign: &Campaign<'_>, calibration: &Calibration, applied: &Camera) -> Result<Vec<Figure>, String> {
    let (found, truth) = (interior(applied, campaign.transfer.pitch_um)?, campaign.interior);
    let sigma = calibration.quality.and_then(|quality| quality.sigma_c);
    let of = |(i, name): (usize, &str)| {
        let sigma = sigma.filter(|_| i == 0);
        Figure { name: Quantity::Parameter.of(&[name]), value: found[i], sigma, error: Some(found[i] - truth[i]), unit: "mm" }
    };
    let mut figures: Vec<Figure> = ["c", "x0", "y0"].into_iter().enumerate().map(of).collect();
    if let Camera::Photogrammetric(camera) = applied {
        let rest = camera.parameters().into_iter().skip(3);
        figures.extend(rest.map(|parameter| Figure::plain(Quantity::Parameter.of(&[parameter.name]), parameter.value, parameter.unit)));
    }
    if let Some(quality) = calibration.quality {
        figures.push(Figure::plain(Quantity::Sigma0, quality.sigma0, ""));
        figures.push(Figure::plain(Quantity::Redundancy, quality.redundancy as f64, ""));
        if campaign.transfer.measured_by.is_some() {
            figures.push(Figure::plain(Quantity::Missed, calibration.missed as f64, ""));
        }
    }
    Ok(figures)
}

/// Root mean square errors of check points: per axis, in the plane of X and Y, in space; those against the survey beside them.
pub fn of_points(checked: &[Checked], unit: &'static str) -> Vec<Figure> {
    let Rmse { axes: [x, y, z], planimetric, spatial } = Rmse::of(checked.iter().map(|point| point.error));
    let to_survey = Rmse::of(checked.iter().map(|point| point.to_survey)).planimetric;
    let named = [
        (Quantity::RmseX, x),
        (Quantity::RmseY, y),
        (Quantity::RmseZ, z),
        (Quantity::RmseXy, planimetric),
        (Quantity::RmseXyz, spatial),
        (Quantity::RmseXySurvey, to_survey),
    ];
    let points = Figure::plain(Quantity::CheckPoints, checked.len() as f64, "");
    named.into_iter().map(|(quantity, value)| Figure::plain(quantity, value, unit)).chain([points]).collect()
}

/// The coordinates of every check point with their errors.
pub fn every_point(campaign: &Campaign<'_>, checked: &[Checked], unit: &'static str) -> Vec<Figure> {
    let of = |point: &Checked| {
        let name = &campaign.subject.field.targets[point.target].id;
        let axis = |(i, axis): (usize, Quantity)| {
            let error = Some(point.error[i]);
            Figure { name: axis.of(&[name]), value: point.at[i], sigma: None, error, unit }
        };
        [Quantity::ObjectX, Quantity::ObjectY, Quantity::ObjectZ].into_iter().enumerate().map(axis).collect::<Vec<_>>()
    };
    checked.iter().flat_map(of).collect()
}
