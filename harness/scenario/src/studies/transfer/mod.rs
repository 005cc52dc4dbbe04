//! The `[transfer]` tables: calibrate here, apply there.

mod board;
mod conditions;
mod method;
mod model;
mod operator;
mod read;
pub mod wire;

use calibench_model::Testfield;
use calibench_model::camera::Camera;
use calibench_synth::stations::{Aim, RandomViews, Station};
use schemars::JsonSchema;
use serde::Deserialize;
use toml::Spanned;

pub use conditions::{Conditions, Switch};
pub use model::Model;
pub use operator::Measuring;
pub(crate) use read::read;

use super::plan::StudyPlan;

/// Checked `[transfer]` tables. What is said of the field where calibrations are applied stands beside them, in the subject.
#[derive(Clone, Debug)]
pub struct Transfer {
    /// The stations from which check points are intersected, by their places.
    pub stations: Vec<usize>,
    /// Control points, by their places in the field.
    pub control: Vec<usize>,
    /// Check points, by their places in the field.
    pub check: Vec<usize>,
    /// Networks of fewer stations that cases and decompositions name, by the places of stations.
    pub networks: Vec<Vec<usize>>,
    /// Standard deviation per axis of the image coordinates of the field's targets, px.
    pub sigma_px: f64,
    /// What measures them in rendered images. Without it they are drawn.
    pub measured_by: Option<Measuring>,
    /// Standard deviation per axis of the survey, object units.
    pub survey_sigma: f64,
    /// Pixel pitch, um.
    pub pitch_um: f64,
    /// The pitch that a stated width of the sensor makes, um.
    pub other_pitch_um: Option<f64>,
    /// The board, where a method calibrates from one.
    pub board: Option<Board>,
    /// The methods, at least one.
    pub methods: Vec<Method>,
    /// The method whose exterior orientations are held: the place of one that calibrates from control.
    pub poses_of: usize,
    /// How calibrations are applied, at least one way.
    pub cases: Vec<Case>,
    /// How errors are split, if they are.
    pub decompositions: Vec<Decomposition>,
}

/// A field and what pictures it, as another scenario has them.
#[derive(Clone, Debug)]
pub struct Site {
    /// The interior orientation.
    pub camera: Camera,
    /// What is seen.
    pub field: Testfield,
    /// From where.
    pub stations: Vec<Station>,
}

/// Reads the scenario of a file that is named, or says what is wrong with it.
pub(crate) type Sites<'a> = dyn FnMut(&Spanned<String>) -> Result<Site, String> + 'a;

/// A chessboard and its views.
#[derive(Clone, Debug)]
pub struct Board {
    /// The board; its bend is that of [`Conditions::bend`]. What pictures it stands beside these tables, in the subject.
    pub field: Testfield,
    /// What makes its views, the board's units.
    pub views: RandomViews,
    /// What they look at.
    pub aim: Aim,
    /// The middle part of the frame's width and height that holds all corners.
    pub within: f64,
}

/// From what a method calibrates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Calibrates {
    /// The control points.
    FromControl,
    /// The board, whose corners have coordinates of this standard deviation per axis, px.
    FromBoard {
        /// px.
        sigma_px: f64,
        /// What solves for the camera.
        solver: Solver,
    },
    /// Nothing.
    Never,
}

/// Why there is no calibration of OpenCV's.
pub const NO_SOLVER: &str = "this build is without OpenCV";

/// What makes a camera of a board's corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(inline)]
pub enum Solver {
    /// The adjustment of this project.
    Own,
    /// OpenCV's `calibrateCamera`.
    Opencv,
}

/// A calibration method.
#[derive(Clone, Debug)]
pub struct Method {
    /// Its name.
    pub name: String,
    /// From what.
    pub calibrates: Calibrates,
    /// Start values: a data sheet's camera.
    pub start: Camera,
    /// The parameters that are solved for.
    pub parameters: Vec<String>,
    /// What measures its board in rendered images. Without it corners are drawn.
    pub measured_by: Option<Measuring>,
}

/// A way to apply calibrations.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its name.
    pub name: String,
    /// The methods that it is for, by their places.
    pub methods: Vec<usize>,
    /// How.
    pub conditions: Conditions,
    /// Whether the errors of each check point are kept of all trials.
    pub points: bool,
}

/// How errors of check points are split.
#[derive(Clone, Debug, PartialEq)]
pub struct Decomposition {
    /// Its name.
    pub name: String,
    /// The methods, by their places.
    pub methods: Vec<usize>,
    /// With every switch on.
    pub on: Conditions,
    /// With every switch off.
    pub off: Conditions,
    /// The switches.
    pub switches: Vec<Switch>,
}

impl StudyPlan for Transfer {
    /// Those of the cases, then those of the decompositions.
    fn sets(&self) -> Vec<String> {
        let splits = self.decompositions.iter().map(|split| split.name.clone());
        self.cases.iter().map(|case| case.name.clone()).chain(splits).collect()
    }

    fn own_methods(&self) -> Option<Vec<String>> {
        Some(self.methods.iter().map(|method| method.name.clone()).collect())
    }

    fn is_random(&self) -> bool {
        true
    }

    fn pitch_um(&self) -> Option<f64> {
        Some(self.pitch_um)
    }
}

impl Transfer {
    /// Why the method at `place` cannot run in a build, if so; `solver` and `detector` are whether that has OpenCV's calibration from a board and a detector
    /// of chessboards.
    pub fn unavailable(&self, place: usize, solver: bool, detector: bool) -> Option<String> {
        let method = &self.methods[place];
        if matches!(method.calibrates, Calibrates::FromBoard { solver: Solver::Opencv, .. }) && !solver {
            return Some(NO_SOLVER.into());
        }
        if method.measured_by.as_ref().is_some_and(|measuring| measuring.detected) && !detector {
            return Some("this build has no detector of OpenCV's for chessboards".into());
        }
        let mut measuring = self.measured_by.iter().chain(&method.measured_by);
        measuring.find_map(|measuring| Some(format!("{}: {}", measuring.operator.label, measuring.operator.operator.as_ref().err()?)))
    }

    /// What is doubtful of it: a pitch and a width of the sensor that disagree by more than a thousandth.
    pub fn warning(&self) -> Option<String> {
        let other = self.other_pitch_um.filter(|other| (other / self.pitch_um - 1.0).abs() > 1e-3)?;
        let percent = 100.0 * (other / self.pitch_um - 1.0);
        Some(format!("`pitch` is {} um, `sensor_width` makes it {other:.5} um, {percent:+.2} %: the pitch holds", self.pitch_um))
    }
}

#[cfg(test)]
mod tests;
