//! The twin of photographs, as JSON.

use schemars::JsonSchema;
use serde::Serialize;

use super::Answer;

/// What operators do to photographs and to their twin, and what the twin is made of.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TwinAnswer {
    /// How many photographs made the twin.
    pub photographs: usize,
    /// The camera model.
    pub model: String,
    /// The operator whose points made camera, board and poses.
    pub maker: String,
    /// The operators, in the order asked for.
    pub operators: Vec<TwinOperator>,
    /// The operators with the least true errors that chance does not tell apart, at 95 %.
    pub best: Vec<String>,
    /// What photographs and twin look like.
    pub looks: Vec<TwinLook>,
    /// What the twin is made of, by the keys of its scenario.
    pub made_of: Vec<TwinPart>,
    /// The mean profile of edges.
    pub profile: TwinCurves,
    /// The standard deviation of noise against the level of squares, grey levels of 255.
    pub noise: TwinCurves,
    /// What would change: the twin with one thing changed.
    pub what_if: Vec<TwinCase>,
    /// Why the twin is in doubt, and the exit code 3.
    pub doubts: Vec<String>,
    /// What photographs of a board cannot tell, and the twin leaves out.
    pub untold: Vec<&'static str>,
}

/// An operator on photographs and their twin. Root mean squares are of distances (2D).
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TwinOperator {
    /// Its name with its parameters.
    pub method: String,
    /// Whether it made the twin: its hold-out proves nothing.
    pub is_maker: bool,
    /// Why it did not run; null where it did.
    pub unavailable: Option<String>,
    /// How well photographs are predicted that a camera from the others has not seen, RMS, px.
    pub held_out_px: Option<f64>,
    /// The same in the twin.
    pub twin_held_out_px: Option<f64>,
    /// Its errors in the twin, where the truth is known, RMS, px.
    pub true_px: Option<f64>,
    /// Where that is at 95 %, from here; null where too few views tell.
    pub true_from_px: Option<f64>,
    /// To here.
    pub true_to_px: Option<f64>,
}

/// A figure of what images look like.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TwinLook {
    /// What it is.
    pub what: &'static str,
    /// Its unit; empty of a number.
    pub unit: &'static str,
    /// In the photographs.
    pub photographs: f64,
    /// The standard deviation that the scatter of photographs shows; null where that is not told.
    pub sigma: Option<f64>,
    /// In the twin.
    pub twin: f64,
}

/// A part of what a twin is made of.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TwinPart {
    /// The scenario's key, as in `sensor.noise_blur`.
    pub key: &'static str,
    /// What it is.
    pub what: &'static str,
    /// Its unit; empty of a number.
    pub unit: &'static str,
    /// Its value; of views their median.
    pub value: f64,
    /// Where it is at 95 %, from here; null where that is not told.
    pub from: Option<f64>,
    /// To here.
    pub to: Option<f64>,
}

/// Curves of photographs and twin.
#[derive(Clone, Debug, Default, Serialize, JsonSchema)]
pub struct TwinCurves {
    /// Places [x, y] of the photographs.
    pub photographs: Vec<[f64; 2]>,
    /// Places [x, y] of the twin.
    pub twin: Vec<[f64; 2]>,
}

/// The twin with something changed.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TwinCase {
    /// What was changed, as it was asked for.
    pub asked: String,
    /// What that means, in words.
    pub what: String,
    /// Errors of the operators, in the order of `operators`.
    pub operators: Vec<TwinCaseOperator>,
}

/// Errors of an operator in a twin that was changed, 2D.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct TwinCaseOperator {
    /// RMS, px; null where it measured nothing.
    pub true_px: Option<f64>,
    /// At 95 %, from here; null where too few views tell.
    pub true_from_px: Option<f64>,
    /// To here.
    pub true_to_px: Option<f64>,
}

impl Answer for TwinAnswer {
    const COMMAND: &'static str = "twin";
    const SCHEMA: u32 = 1;
}
