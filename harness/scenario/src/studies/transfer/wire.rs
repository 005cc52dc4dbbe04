//! The `[transfer]` tables as they are written.

use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

use super::Solver;
use super::model::Model;
use crate::camera::Pitch;
use crate::studies::network::wire::{PrincipalDistance, Sigma};
use crate::testfield::wire::{Count, Degrees, Distance as Length, Fraction, Height, Tuple};
use crate::wire::bounded;

bounded! {
    /// A change of the principal distance, mm.
    Refocus(f64), f64 "f64", -100.0, 100.0;
}

/// A list of patterns or names.
pub(super) type Names = Spanned<Vec<Spanned<String>>>;

/// Calibrate here, apply there: cameras are calibrated from control or from a chessboard and applied to the check points of one field, in every trial, from
/// coordinates that are drawn.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TransferWire {
    /// The scenario in whose images calibrations are applied, relative to this one's folder: its camera, testfield and stations.
    #[schemars(with = "String")]
    pub apply: Spanned<String>,
    /// Of its stations those from which check points are intersected, by patterns of names. Default: all.
    #[schemars(with = "Option<Vec<String>>")]
    pub stations: Option<Names>,
    /// Its control points, by patterns of targets' names.
    #[schemars(with = "Vec<String>")]
    pub control: Names,
    /// Its check points, by patterns of targets' names.
    #[schemars(with = "Vec<String>")]
    pub check: Names,
    /// Standard deviation per axis of the image coordinates of its targets, px.
    pub sigma_px: Sigma,
    /// The operator that measures them in rendered images, as in `parametric_corner:window=15`; methods from a board then have one too. Default: coordinates
    /// are drawn.
    #[schemars(with = "Option<String>")]
    pub measured_by: Option<Spanned<String>>,
    /// Standard deviation per axis of the survey, drawn anew in each trial, object units: in the control that calibrations are told and in the references
    /// of check points.
    pub survey_sigma: Length,
    /// Pixel pitch through which px become mm, um.
    #[schemars(with = "Pitch")]
    pub pitch: Spanned<Pitch>,
    /// Width of the sensor, mm, if one is stated: where it makes another pitch, that is said.
    #[schemars(with = "Option<PrincipalDistance>")]
    pub sensor_width: Option<Spanned<PrincipalDistance>>,
    /// Principal distance of the data sheet, mm: calibrations start from it, and it is all that is known without one.
    pub start_c: PrincipalDistance,
    /// The method whose exterior orientations are held where a case says so.
    #[schemars(with = "String")]
    pub poses_of: Spanned<String>,
}

/// The chessboard and its views, drawn anew in each trial.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoardWire {
    /// The scenario whose chessboard it is, relative to this one's folder.
    #[schemars(with = "String")]
    pub file: Spanned<String>,
    /// How many views.
    #[schemars(with = "Count")]
    pub views: Spanned<Count>,
    /// The least and the greatest distance from what is looked at, the board's units.
    pub distance: Tuple<2>,
    /// The greatest angle of the line of sight from the board's normal, degrees, 0 to 85.
    #[schemars(with = "Degrees")]
    pub tilt: Spanned<Degrees>,
    /// Rolls are uniform from minus to plus this, degrees, 0 to 180. Default 0.
    pub roll: Option<Degrees>,
    /// The camera looks at a point this far from the board's middle at most [to the sides, up or down], the board's units. Default [0, 0].
    pub aside: Option<Tuple<2>>,
    /// The middle part of the frame's width and height that holds all corners. Default 1.
    pub within: Option<Fraction>,
    /// Height of the board's middle over its outermost corners that calibrations do not know of, the board's units. Default 0.
    pub bend: Option<Height>,
    /// Standard deviation per axis of the corners' coordinates in place of the methods' own, px.
    pub sigma_px: Option<Sigma>,
}

/// From what a method calibrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Source {
    /// The control points of the field where it is applied.
    Control,
    /// The chessboard.
    Board,
    /// Nothing: the data sheet's principal distance.
    Nothing,
}

/// A calibration method.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MethodWire {
    /// Its name in records and tables: what it is, and no product's.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// What it calibrates from.
    #[schemars(with = "Source")]
    pub from: Spanned<Source>,
    /// The camera model.
    pub model: Option<Model>,
    /// Parameters of the model that are solved for. Default: principal distance and point, three radial and two decentring coefficients.
    #[schemars(with = "Option<Vec<String>>")]
    pub parameters: Option<Names>,
    /// Standard deviation per axis of the corners' coordinates, px; only from a board.
    #[schemars(with = "Option<Sigma>")]
    pub sigma_px: Option<Spanned<Sigma>>,
    /// The operator that measures the board's corners in rendered images; only from a board, and where `[transfer]` has one.
    #[schemars(with = "Option<String>")]
    pub measured_by: Option<Spanned<String>>,
    /// Whether measuring starts from what the build's detector of chessboards finds, in place of the board's `[pointing]`. Default false.
    pub detected: Option<bool>,
    /// What solves for the camera; only from a board. Default: `own`.
    #[schemars(with = "Option<Solver>")]
    pub solver: Option<Spanned<Solver>>,
}

/// How the camera comes to where it is applied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Conversion {
    /// The camera of the model itself, inverted by iteration.
    Exact,
    /// `k_i = K_i / c^(2i)`, `p_i = P_i / c`: the direction of the polynomial is ignored.
    Naive,
}

/// Exterior orientations from which check points are intersected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Poses {
    /// Those of another calibration, held.
    Held,
    /// Resected with the camera that is applied.
    Resected,
}

/// A way to apply calibrations.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CaseWire {
    /// Its name in records and tables.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// The methods that it is for, by patterns of names. Default: all.
    #[schemars(with = "Option<Vec<String>>")]
    pub methods: Option<Names>,
    /// Exterior orientations.
    pub poses: Poses,
    /// How the camera is converted. Default: exact.
    pub conversion: Option<Conversion>,
    /// Whether image coordinates have errors. Default true.
    pub measurement: Option<bool>,
    /// Whether the survey has errors. Default true.
    pub survey: Option<bool>,
    /// A wrong pixel pitch through which px become mm, um; the images keep theirs.
    pub pitch: Option<Pitch>,
    /// An error of the principal point that is put in, mm [to the right, upwards].
    pub principal_point: Option<Tuple<2>>,
    /// Height of the board's middle over its outermost corners that calibrations do not know of, the board's units. Default: that of the board.
    pub bend: Option<Height>,
    /// Principal distance before the board less that where the camera is applied, mm. Default 0.
    pub refocus: Option<Refocus>,
    /// Standard deviation per axis of the corners' coordinates in place of the methods' own, px; only of corners that are drawn.
    #[schemars(with = "Option<Sigma>")]
    pub board_sigma_px: Option<Spanned<Sigma>>,
    /// All stations that there are in this case, for calibrations and for check points, by patterns of names. Default: all.
    #[schemars(with = "Option<Vec<String>>")]
    pub stations: Option<Names>,
    /// Whether records keep the errors of each check point in every trial. Default: those of the first.
    pub points: Option<bool>,
}

/// The error of check points split by what causes it: each switch on alone, each off alone, and each two together.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DecompositionWire {
    /// Its name in records and tables.
    #[schemars(with = "String")]
    pub name: Spanned<String>,
    /// The methods whose errors are split, by patterns of names.
    #[schemars(with = "Vec<String>")]
    pub methods: Names,
    /// `held`: exterior orientations are held throughout. Default: they are resected, and held where the switch of exchanged poses is on.
    pub poses: Option<Poses>,
    /// The wrong pixel pitch, um. Without it there is no such switch.
    pub pitch: Option<Pitch>,
    /// The error of the principal point, mm [to the right, upwards]. Without it there is no such switch.
    pub principal_point: Option<Tuple<2>>,
    /// The height of the board's bend, the board's units. Without it there is no such switch.
    pub bend: Option<Height>,
    /// The change of the principal distance, mm. Without it there is no such switch.
    pub refocus: Option<Refocus>,
    /// The stations that are left where the switch of the network is on, by patterns of names. Without it there is no such switch.
    #[schemars(with = "Option<Vec<String>>")]
    pub stations: Option<Names>,
}
