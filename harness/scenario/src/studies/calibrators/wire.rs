//! `[calibrators]` and `[[calibrator]]` as they are written.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use crate::studies::network::wire::{Error, Sigma};
use crate::testfield::wire::{Distance, Fraction, Height, Length};
use crate::wire::bounded;

bounded! {
    /// A focal length, px.
    Focal(f64), f64 "f64", 1.0, 1e6;
    /// A factor near one.
    Factor(f64), f64 "f64", 0.1, 10.0;
}

/// Whole calibration systems, each told the same image points of every trial; their cameras are compared with the true one.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CalibratorsWire {
    /// The camera model asked for, as in "opencv5".
    #[schemars(with = "String")]
    pub model: Spanned<String>,
    /// The standard deviation of an image coordinate that calibrators are told, px. Default: they are told none.
    pub sigma_px: Option<Sigma>,
    /// The standard deviation per axis of image coordinates, px: they are drawn and no image is rendered. Default: images are rendered and measured.
    pub noise_px: Option<Error>,
    /// The focal length that is told as a start to those that want one, px.
    pub start_f: Focal,
    /// At which distance lengths are compared, object units.
    pub distance: Length,
}

/// What calibrators are told wrongly, or what is not as they take it to be.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FaultsWire {
    /// The share of image points in gross error. Default 0.
    pub gross: Option<Fraction>,
    /// [from, to]: how many pixels those are off, in any direction. Default [3, 30].
    pub gross_px: Option<[Distance; 2]>,
    /// The share of image points that bear the name of another of their image, whose point bears theirs. Default 0.
    pub exchanged: Option<Fraction>,
    /// Object coordinates as told over those that are true. Default 1.
    pub told_scale: Option<Factor>,
    /// How far the camera moves along the frame's rows while an image is read out, object units. Default 0.
    pub shutter: Option<Height>,
    /// Principal distance of the camera of every second image over that of the others: two cameras that are taken for one. Default 1.
    pub other_c: Option<Factor>,
}

/// A calibrator.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CalibratorWire {
    /// Its name: one of calibench's own (`ours`, ...), or one that a file of the project's `methods` declares.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
}
