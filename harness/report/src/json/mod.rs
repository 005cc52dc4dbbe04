//! What commands answer to programs: one JSON document each, with a schema that says what every key is.

mod acceptance;
mod board;
mod calibration;
mod camera;
mod compared;
mod conversion;
mod difference;
mod doubted;
mod judgement;
mod lengths;
mod listing;
mod measured_board;
mod measurement;
mod next;
mod own_numbers;
mod rig;
mod rig_stands;
mod schema;
mod splined;
mod task;
mod text;
mod twin;

use std::io::{self, Write};

use calibench_model::PixelPoint;
use calibench_model::convert::Spread;
use schemars::JsonSchema;
use serde::Serialize;

pub use acceptance::AcceptanceAnswer;
pub use calibration::CalibrationAnswer;
pub use camera::{CameraAnswer, CameraFileAnswer, Format as CameraFileFormat};
pub use conversion::{ConversionAnswer, ConvertedCamera};
pub use difference::{DifferenceAnswer, Part};
pub use judgement::JudgementAnswer;
pub use listing::{ListAnswer, Listed, ListedParameter};
pub use measurement::{MeasurementAnswer, MeasurementCounts};
pub use rig::RigAnswer;
pub use rig_stands::RigStandsAnswer;
pub use schema::{COMMANDS, schema_of};
pub use splined::SplinedAnswer;
pub use task::TaskAnswer;
pub use twin::{TwinAnswer, TwinCase, TwinCaseOperator, TwinCurves, TwinLook, TwinOperator, TwinPart};

/// What a command answers.
pub trait Answer: Serialize + JsonSchema {
    /// The command's name.
    const COMMAND: &'static str;
    /// Version of its schema: it grows when a key goes or comes to mean something else, and not when one is added.
    const SCHEMA: u32;
}

#[derive(Serialize)]
struct Document<'a, A> {
    command: &'static str,
    schema: u32,
    calibench: &'static str,
    #[serde(flatten)]
    answer: &'a A,
}

/// Writes an answer as a JSON document of one object, with the command, the version of its schema and that of the program before it. What a terminal would take for
/// a command is escaped as JSON has it; a number that is not finite is `null`.
///
/// # Errors
/// What the output refuses.
pub fn write_answer<A: Answer>(mut output: impl Write, answer: &A) -> io::Result<()> {
    let document = Document { command: A::COMMAND, schema: A::SCHEMA, calibench: env!("CARGO_PKG_VERSION"), answer };
    document.serialize(&mut serde_json::Serializer::with_formatter(&mut output, text::Plain::default()))?;
    output.write_all(b"\n")
}

/// The same document as a value, for what holds it within another.
///
/// # Errors
/// What cannot be written as JSON.
pub fn answer_value<A: Answer>(answer: &A) -> io::Result<serde_json::Value> {
    let document = Document { command: A::COMMAND, schema: A::SCHEMA, calibench: env!("CARGO_PKG_VERSION"), answer };
    Ok(serde_json::to_value(&document)?)
}

/// Columns and rows of an image.
#[derive(Serialize, JsonSchema)]
pub struct Size {
    /// Columns, px.
    width: u32,
    /// Rows, px.
    height: u32,
}

impl From<calibench_model::camera::ImageSize> for Size {
    fn from(size: calibench_model::camera::ImageSize) -> Self {
        Self { width: size.width, height: size.height }
    }
}

/// A place in an image, px from the centre of the first pixel: x to the right, y down.
#[derive(Serialize, JsonSchema)]
pub struct Place {
    /// Column, px.
    x: f64,
    /// Row, px.
    y: f64,
}

impl From<PixelPoint> for Place {
    fn from(place: PixelPoint) -> Self {
        Self { x: place.x, y: place.y }
    }
}

/// How large vectors over a frame are.
#[derive(Serialize, JsonSchema)]
pub struct Sizes {
    /// Root mean square of their lengths (2D), the mean over the area, px.
    rms_px: f64,
    /// The largest length, px.
    max_px: f64,
    /// Where that is.
    max_at: Place,
}

impl From<&Spread> for Sizes {
    fn from(spread: &Spread) -> Self {
        Self { rms_px: spread.rms_px, max_px: spread.max_px, max_at: spread.at.into() }
    }
}
