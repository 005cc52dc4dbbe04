//! `[tasks]` as it is written.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use crate::studies::network::wire::Sigma;
use crate::testfield::wire::{Count, Distance, Length};
use crate::wire::bounded;

bounded! {
    /// A standard deviation of a scale, a number.
    ScaleSigma(f64), f64 "f64", 0.0, 0.05;
    /// A standard deviation of a small angle, degrees.
    SmallAngle(f64), f64 "f64", 0.0, 5.0;
}

/// Cameras that measure, in every trial: each is calibrated, as `calibrate` does it, from drawn image coordinates of a flat testfield that errs, and measures lengths
/// from other stations as `task` has them: with stated poses, with poses from the board, in one image before a plane. Whether the 95 % intervals hold the truth.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TasksWire {
    /// The camera model that is calibrated, as in "opencv5".
    #[schemars(with = "String")]
    pub model: Spanned<String>,
    /// The standard deviation per axis of image coordinates, px.
    pub noise_px: Sigma,
    /// Standard deviation of each coordinate of each corner of the board, object units.
    pub print_noise: Distance,
    /// Standard deviation of the scale of its print, a number, as 2e-4.
    pub board_scale: ScaleSigma,
    /// Standard deviation of each of its three bends (along it, across, twisted), object units.
    pub flatness: Distance,
    /// Lengths that each camera measures, of the three kinds in turn. Default 20.
    pub count: Option<Count>,
    /// The least length, object units.
    #[schemars(with = "Length")]
    pub length: Spanned<Length>,
    /// Standard deviation of each coordinate of a stated projection centre, object units.
    pub centre_sigma: Distance,
    /// Standard deviation of a stated rotation about each axis of the camera, degrees.
    pub angle_sigma: SmallAngle,
    /// Standard deviation of where the plane lies along its normal, object units.
    pub plane_sigma: Distance,
    /// Standard deviation of its tilt about either axis in it, degrees.
    pub tilt_sigma: SmallAngle,
}
