//! `[acceptance]` as it is written, beside `[free_network]` and beside `[calibration]`.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use crate::testfield::wire::{Distance, Length, Tuple};
use crate::wire::bounded;

bounded! {
    /// A probability.
    Probability(f64), f64 "f64", 0.5, 0.999_999;
    /// Standard uncertainties.
    GuardBand(f64), f64 "f64", 0.0, 10.0;
}

/// Lengths that a free network must measure within a limit, in every trial, as `accept --lengths` decides it (after VDI/VDE 2634-1).
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LengthsWire {
    /// Of each measurement line the names of the targets on it: a calibrated length goes from the first to each other one. A test has seven lines of six targets.
    #[schemars(with = "Vec<Vec<String>>")]
    pub lines: Spanned<Vec<Vec<Spanned<String>>>>,
    /// The limit `A + K L`, at most B, of the error of a length L: `[A]`, `[A, K]` or `[A, K, B]`; A and B object units, K a number.
    #[schemars(with = "Vec<f64>")]
    pub limit: Spanned<Vec<f64>>,
    /// Standard uncertainty (k = 1) of a calibrated length, object units. Default 0, which takes it as exact.
    pub sigma: Option<Distance>,
    /// Edges of the measuring volume [X, Y, Z], object units. Default: its diagonal is the largest distance between two targets.
    pub volume: Option<Tuple<3>>,
    /// The probability at which an error is taken as within its limit. Default 0.95.
    pub probability: Option<Probability>,
    /// Standard uncertainties that must lie between an error and its limit, in place of a probability; 0 takes errors as they are.
    #[schemars(with = "Option<GuardBand>")]
    pub guard_band: Option<Spanned<GuardBand>>,
}

/// Root mean squares that the check points of `[calibration.check]` must keep, the survey's error included, in every trial, as `accept --check-points` decides it
/// (after ASPRS 2023): at least one.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ClassesWire {
    /// Of X and Y together, object units.
    pub horizontal: Option<Length>,
    /// Of Z, object units.
    pub vertical: Option<Length>,
    /// Of all three together, object units.
    pub spatial: Option<Length>,
}
