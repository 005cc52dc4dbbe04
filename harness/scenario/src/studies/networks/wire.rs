//! `[free_network]`, `[[distance]]`, `[rig]` and `[[mount]]` as they are written.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use crate::studies::network::wire::Sigma;
use crate::testfield::wire::{CountOrNone, Length, Tuple};

/// A free network in every trial: image coordinates are drawn, the targets' coordinates are not told, and the camera is calibrated from nothing.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FreeNetworkWire {
    /// The camera model that is calibrated, as in "opencv5".
    #[schemars(with = "String")]
    pub model: Spanned<String>,
    /// The standard deviation per axis of image coordinates, px.
    pub noise_px: Sigma,
    /// The standard deviation of an image coordinate that the adjustment is told, px. Default: `noise_px`.
    pub sigma_px: Option<Sigma>,
    /// Between how many pairs of targets the error of the length is looked at. Default 10; 0 without a `[[distance]]`, since nothing tells the scale.
    pub lengths: Option<CountOrNone>,
}

/// A distance between two targets that is measured, as that of a scale bar: anew in each trial.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DistanceWire {
    /// The names of two targets.
    #[schemars(with = "[String; 2]")]
    pub between: Spanned<Vec<Spanned<String>>>,
    /// Its standard deviation, object units.
    pub sigma: Length,
}

/// Cameras that are mounted rigidly to each other, in every trial before the targets as they were surveyed: image coordinates are drawn, interiors and mounts calibrated
/// from nothing. Stations are where the rig stands.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RigWire {
    /// The camera model that is calibrated, of each camera for itself, as in "opencv5".
    #[schemars(with = "String")]
    pub model: Spanned<String>,
    /// The standard deviation per axis of image coordinates, px.
    pub noise_px: Sigma,
    /// The standard deviation of an image coordinate that the adjustment is told, px. Default: `noise_px`.
    pub sigma_px: Option<Sigma>,
}

/// A camera on the rig. All have the interior orientation of `[camera]`; that is not told.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MountWire {
    /// Its name: letters, digits and _.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// Its projection centre in the axes of the rig [x, y, z], object units. Default [0, 0, 0].
    pub at: Option<Tuple<3>>,
    /// How it is turned against the rig: omega, phi, kappa, degrees, as of stations. Default [0, 0, 0].
    pub angles: Option<Tuple<3>>,
}
