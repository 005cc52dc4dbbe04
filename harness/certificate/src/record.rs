//! What a certificate is made of. It is attached to the document, and lies in the folder of a report.

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// Version of the record: it grows when a key goes or comes to mean something else.
pub const RECORD: u32 = 1;
/// Name of the record in the folder of a report, and of the attachment.
pub const RECORD_FILE: &str = "certificate.json";
/// Name of the list of digests, as `sha256sum` reads it.
pub const LIST_FILE: &str = "files.sha256";

/// All that is known of a calibration and of what it was made of, for certificates of its cameras.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Version of the record: [`RECORD`].
    pub certificate: u32,
    /// The program's version.
    pub calibench: String,
    /// The answer of `calibrate`, as `--json` has it.
    pub calibration: Value,
    /// Groups of images that were left out one after the other; `None` where none were.
    pub groups: Option<usize>,
    /// How image points were measured; `None` where they were given.
    pub method: Option<String>,
    /// The board's name in commands, as `chessboard:9x6:25`; `None` without one.
    pub board: Option<String>,
    /// Of each camera what the answer does not say, in its order.
    pub cameras: Vec<CameraRecord>,
    /// What tasks cost with this calibration.
    #[serde(default)]
    pub tasks: Vec<TaskFigure>,
    /// The files, in the order of the list of digests.
    pub files: Vec<FileEntry>,
    /// What was read and has no digest, as pipes: it cannot be read again.
    #[serde(default)]
    pub without_digest: Vec<String>,
}

/// What is known of a camera beside its calibration.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CameraRecord {
    /// Cameras and lenses as the photographs say, those that are the same counted.
    pub equipment: Vec<Equipment>,
    /// Its uncertainty over the frame; `None` where its interior orientation was not adjusted.
    pub frame: Option<FrameRecord>,
}

/// A camera and its lens as photographs say, in EXIF.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Equipment {
    /// Photographs that say so.
    pub photographs: usize,
    /// Who made the camera, and its name.
    pub camera: Option<String>,
    /// The camera's serial number.
    pub serial: Option<String>,
    /// The lens.
    pub lens: Option<String>,
    /// The lens's serial number.
    pub lens_serial: Option<String>,
    /// Focal length, mm.
    pub focal_mm: Option<f64>,
    /// Focal length over aperture.
    pub f_number: Option<f64>,
    /// When the first was taken, `2026-05-01 12:00:00`.
    pub first: Option<String>,
    /// When the last was taken.
    pub last: Option<String>,
}

/// The standard uncertainty (2D) of the image of a point far away, poses held by what was measured.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameRecord {
    /// Columns and rows of a grid from the first pixel's centre to the last's.
    pub grid: [usize; 2],
    /// Row by row, px; `None` where the camera has no ray.
    pub sigma_px: Vec<Option<f64>>,
    /// Whether image points surround the place.
    pub measured: Vec<bool>,
    /// Chosen places: the corners, the middles of the sides, the middle.
    pub places: Vec<PlaceRecord>,
}

/// A place of the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaceRecord {
    /// What it is, as `upper left corner`.
    pub name: String,
    /// Column, px.
    pub x: f64,
    /// Row, px.
    pub y: f64,
    /// As in [`FrameRecord`].
    pub sigma_px: Option<f64>,
    /// Whether image points surround it.
    pub measured: bool,
}

/// What a task costs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TaskFigure {
    /// What is measured, as `a length of 100 mm at 800 mm`.
    pub what: String,
    /// Its standard uncertainty.
    pub sigma: f64,
    /// Half of the interval that holds 95 %.
    pub half_95: f64,
    /// The unit of both.
    pub unit: String,
    /// The largest contribution.
    pub largest: String,
}

/// What a file is to the calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// A photograph.
    Photograph,
    /// Points, control, distances or start values.
    Input,
    /// The camera file.
    Camera,
}

/// A file that the certificate is of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileEntry {
    /// What it is.
    pub role: Role,
    /// Where it was, as it was named, or its last names.
    pub path: String,
    /// Its size.
    pub bytes: u64,
}

/// What a person says, and signs.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Fields {
    /// The camera.
    pub camera: Option<String>,
    /// The lens.
    pub lens: Option<String>,
    /// Who issues the certificate.
    pub by: Option<String>,
    /// Where.
    pub place: Option<String>,
    /// When, in any words.
    pub date: Option<String>,
}

/// A certificate: what is attached as [`RECORD_FILE`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// What a person says.
    pub fields: Fields,
    /// Which of the cameras, from 0.
    pub camera: usize,
    /// The rest.
    pub record: Record,
}
