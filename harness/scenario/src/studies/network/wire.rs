//! The `[calibration]` table as it is written.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use crate::testfield::wire::Distance as Length;
use crate::wire::bounded;

bounded! {
    /// A principal distance, mm.
    PrincipalDistance(f64), f64 "f64", 1e-3, 1e5;
    /// A standard deviation of image coordinates above zero, px.
    Sigma(f64), f64 "f64", 1e-6, 100.0;
    /// A standard deviation of image coordinates, px.
    Error(f64), f64 "f64", 0.0, 100.0;
}

/// Self-calibration within every trial: what each method measured goes through a bundle adjustment and is scored against the truth.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CalibrationWire {
    /// Sets of interior parameters that are solved for, as in "c,x0,y0,k1". The first is scored in full, the others are compared with it.
    #[schemars(with = "Vec<String>")]
    pub sets: Spanned<Vec<Spanned<String>>>,
    /// Principal distance of the data sheet, mm: the adjustment starts from it, with no distortion and the principal point in the centre.
    pub start_c: PrincipalDistance,
    /// A-priori standard deviation of an image coordinate, px.
    pub sigma_px: Sigma,
    /// Standard deviation per axis of an error of each image point that all methods share, drawn anew in each trial, px. Default 0.
    pub floor_px: Option<Error>,
    /// Standard deviation per axis of the control points' survey, drawn anew in each trial, object units; not beside that of `[testfield]`, which is drawn once.
    /// Default 0.
    pub survey_sigma: Option<Length>,
    /// Standard deviation per axis of control as the adjustment is told, object units; control of 0 is fixed. Default: `survey_sigma`, here or of
    /// `[testfield]`.
    pub control_sigma: Option<Length>,
    /// Standard deviation per axis of each method's image coordinates, px, by its label, `pixel` apart: coordinates are then drawn and no image is rendered.
    #[schemars(with = "Option<BTreeMap<String, Error>>")]
    pub drawn: Option<Spanned<BTreeMap<String, Error>>>,
    /// Whether what the centres of discs' pictures are off the pictures of their centres is taken out, by their known size and plane. Default false.
    pub eccentricity: Option<bool>,
    /// Whether the records keep the image points of every trial. Default: those of the first.
    pub keep_points: Option<bool>,
}

/// The second step: object points from a few images, interior orientation held.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CheckWire {
    /// The stations.
    #[schemars(with = "Vec<String>")]
    pub views: Spanned<Vec<Spanned<String>>>,
    /// The targets that are control points, at least four.
    #[schemars(with = "Vec<String>")]
    pub control: Spanned<Vec<Spanned<String>>>,
    /// The targets that are check points. Default: all others that are seen in two of the views.
    #[schemars(with = "Option<Vec<String>>")]
    pub points: Option<Vec<Spanned<String>>>,
}
