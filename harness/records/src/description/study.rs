//! The study of a scenario: what is made of what it shows, as pages need it.

use serde::{Deserialize, Serialize};

use super::printed::Printed;
use super::views::{Room, Station, Target, Views};

/// What is made of what a scenario shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Subject", into = "Subject")]
pub enum Study {
    /// The points of a rendered scene are scored, each against the truth.
    Scene,
    /// So are those of views of a testfield.
    Views(Box<Views>),
    /// They are adjusted with control.
    Network(Box<Views>, Adjustment),
    /// Free networks are made of them.
    Blocks(Box<Views>, Blocks),
    /// Whole calibration systems are told them.
    Calibrators(Box<Views>, Systems),
    /// Free networks and rigs are made of them.
    Networks(Box<Views>, Networks),
    /// Cameras are calibrated from them, and measure.
    Tasks(Box<Views>, Tasks),
    /// Nothing is measured: calibrations that are made elsewhere are applied here.
    Transfer(Box<Views>),
    /// Photographs, of which no truth is known.
    Photographs {
        /// Calibrations from them are judged.
        judged: bool,
    },
    /// Figures that were printed: nothing is measured.
    Printed(Box<Printed>),
}

impl Study {
    /// The views of a testfield, if it is of such.
    pub fn views(&self) -> Option<&Views> {
        match self {
            Self::Views(views)
            | Self::Transfer(views)
            | Self::Network(views, _)
            | Self::Blocks(views, _)
            | Self::Calibrators(views, _)
            | Self::Networks(views, _)
            | Self::Tasks(views, _) => Some(views),
            Self::Scene | Self::Photographs { .. } | Self::Printed(_) => None,
        }
    }
}

/// What the adjustment of the measured points is told.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Adjustment {
    /// The pixel pitch, um.
    pub pitch_um: f64,
    /// Image coordinates are drawn at random, no image is rendered.
    pub drawn: bool,
    /// What check points must keep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceptance: Option<Classes>,
}

/// What free networks of the measured points are told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blocks {
    /// The pixel pitch, um.
    pub pitch_um: f64,
    /// Pairs of images whose residuals are compared, by their names.
    pub pairs: Vec<[String; 2]>,
    /// The blocks whose residuals these are.
    pub compared: Vec<String>,
}

/// What whole calibration systems are told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Systems {
    /// The camera model asked for.
    pub model: String,
    /// The standard deviation of an image coordinate that they are told, px; `None` where they are not.
    pub sigma_px: Option<f64>,
}

/// What the networks that are adjusted are told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Networks {
    /// The camera model that is calibrated.
    pub model: String,
    /// The standard deviation of an image coordinate that they are told, px.
    pub sigma_px: f64,
    /// Cameras that are mounted rigidly to each other, by name; none of a free network.
    pub mounts: Vec<String>,
    /// Targets between which distances are measured, by name.
    pub distances: Vec<[String; 2]>,
    /// What lengths must keep.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceptance: Option<TestLengths>,
}

/// What cameras that are calibrated and then measure are told.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tasks {
    /// The camera model that is calibrated.
    pub model: String,
    /// The standard deviation of an image coordinate, px.
    pub noise_px: f64,
    /// Lengths that each camera measures.
    pub count: usize,
    /// Standard deviation of each coordinate of each corner of the board, object units.
    pub print: f64,
    /// Of the scale of its print, a number.
    pub scale: f64,
    /// Of each of its three bends, object units.
    pub flatness: f64,
}

/// Lengths that are measured, and what they must keep.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TestLengths {
    /// How many there are.
    pub count: usize,
    /// On how many lines.
    pub lines: usize,
    /// A, object units, and K, a number, of the limit A + K L.
    pub limit: [f64; 2],
    /// What the limit is at most, object units.
    pub most: Option<f64>,
    /// The standard uncertainty of a calibrated length, object units.
    pub sigma: f64,
}

/// Accuracies that check points must keep, object units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Classes {
    /// Of X and Y together.
    pub horizontal: Option<f64>,
    /// Of Z.
    pub vertical: Option<f64>,
    /// Of all three together.
    pub spatial: Option<f64>,
}

/// A [`Study`] as files have it: by what is measured.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Subject {
    Scene,
    Views(Box<WrittenViews>),
    Photographs { judged: bool },
    Printed(Box<Printed>),
}

/// [`Views`] with what is made of them.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenViews {
    size: [u32; 2],
    unit: String,
    extent: Option<[[f64; 3]; 2]>,
    normal: Option<[f64; 3]>,
    stations: Vec<Station>,
    targets: Vec<Target>,
    adjustment: Option<Adjustment>,
    blocks: Option<Blocks>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    calibrators: Option<Systems>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    networks: Option<Networks>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    tasks: Option<Tasks>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    room: Option<Room>,
}

impl TryFrom<Subject> for Study {
    type Error = &'static str;

    fn try_from(subject: Subject) -> Result<Self, Self::Error> {
        let written = match subject {
            Subject::Scene => return Ok(Self::Scene),
            Subject::Photographs { judged } => return Ok(Self::Photographs { judged }),
            Subject::Printed(printed) => return Ok(Self::Printed(printed)),
            Subject::Views(written) => *written,
        };
        let WrittenViews { size, unit, extent, normal, stations, targets, adjustment, blocks, calibrators, networks, tasks, room } =
            written;
        let views = Box::new(Views { size, unit, extent, normal, stations, targets, room });
        match (adjustment, blocks, calibrators, networks, tasks) {
            (Some(told), None, None, None, None) => Ok(Self::Network(views, told)),
            (None, Some(told), None, None, None) => Ok(Self::Blocks(views, told)),
            (None, None, Some(told), None, None) => Ok(Self::Calibrators(views, told)),
            (None, None, None, Some(told), None) => Ok(Self::Networks(views, told)),
            (None, None, None, None, Some(told)) => Ok(Self::Tasks(views, told)),
            // Where nothing is adjusted only calibrations that come from elsewhere have control and check points.
            (None, None, None, None, None) if views.targets.iter().any(|target| target.role.is_some()) => Ok(Self::Transfer(views)),
            (None, None, None, None, None) => Ok(Self::Views(views)),
            _ => Err("`adjustment`, `blocks`, `calibrators`, `networks` and `tasks`: expected one of them"),
        }
    }
}

impl From<Study> for Subject {
    fn from(study: Study) -> Self {
        let (mut adjustment, mut blocks, mut calibrators, mut networks, mut tasks) = (None, None, None, None, None);
        let views = match study {
            Study::Scene => return Self::Scene,
            Study::Photographs { judged } => return Self::Photographs { judged },
            Study::Printed(printed) => return Self::Printed(printed),
            Study::Views(views) | Study::Transfer(views) => views,
            Study::Network(views, told) => {
                adjustment = Some(told);
                views
            }
            Study::Blocks(views, told) => {
                blocks = Some(told);
                views
            }
            Study::Calibrators(views, told) => {
                calibrators = Some(told);
                views
            }
            Study::Networks(views, told) => {
                networks = Some(told);
                views
            }
            Study::Tasks(views, told) => {
                tasks = Some(told);
                views
            }
        };
        let Views { size, unit, extent, normal, stations, targets, room } = *views;
        Self::Views(Box::new(WrittenViews {
            size,
            unit,
            extent,
            normal,
            stations,
            targets,
            adjustment,
            blocks,
            calibrators,
            networks,
            tasks,
            room,
        }))
    }
}
