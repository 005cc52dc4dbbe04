//! What each image has for itself, as JSON.

use calibench_calibrate::Calibration;
use schemars::JsonSchema;
use serde::Serialize;

/// By how much a number of an image's own makes its camera differ from that of all its images.
#[derive(Serialize, JsonSchema)]
pub(super) struct OwnNumber {
    /// Name of the image.
    image: String,
    /// The number, as it was asked for.
    name: String,
    /// Its value, in the parameter's unit.
    value: f64,
    /// Its standard deviation, in the same unit.
    sigma: f64,
    /// How far it was expected to be off zero, in the same unit.
    prior_sigma: f64,
    /// How much of it the image points say, from 0 to 1.
    redundancy: f64,
}

pub(super) fn own_numbers(calibration: &Calibration<'_>) -> Vec<OwnNumber> {
    let of = |number: calibench_calibrate::OwnNumber| OwnNumber {
        image: number.image,
        name: number.name,
        value: number.value,
        sigma: number.sigma,
        prior_sigma: number.prior_sigma,
        redundancy: number.share,
    };
    calibration.own_numbers().into_iter().map(of).collect()
}
