//! Scenarios: what is run, and why. TOML files, checked once into these types.

pub mod calibration;
pub mod camera;
pub mod catalogue;
mod check;
pub mod data;
mod figure;
mod imaging;
mod judgement;
mod methods;
mod optics;
mod photographs;
pub mod pointing;
pub mod schema;
mod section;
pub mod sensor;
pub mod stations;
pub mod sweep;
pub mod testfield;
mod views;
mod wire;

use std::borrow::Cow;
use std::path::PathBuf;

use calibench_measure::{Board, Configured};
use calibench_model::camera::Camera;
use calibench_model::{PixelPoint, Scene, Testfield};
use calibench_random::Key;
use calibench_synth::optics::OpticsError;
use calibench_synth::pointing::Hand;
use calibench_synth::raster::Renderer;
use calibench_synth::stations::{Station, StationError};

pub use crate::imaging::Imaging;
pub use calibration::Calibration;
pub use check::{parse, parse_cell};
pub use judgement::JudgementPlan;
pub use pointing::{Detector, Pointing};
pub use stations::StationPlan;
pub use sweep::Sweep;
pub use testfield::Unit;
pub use wire::{Phase, Pixels};

/// A checked scenario.
pub struct Scenario {
    /// Its name: its path below the scenario folder without `.toml`.
    pub name: String,
    /// What it is to show.
    pub why: String,
    /// Where it comes from.
    pub source: String,
    /// What is to be known when its figures are read.
    pub notes: Vec<String>,
    /// The seed of all its random numbers.
    pub seed: u64,
    /// How many trials.
    pub trials: u64,
    /// The methods, with distinct labels.
    pub methods: Vec<Configured>,
    /// Side of the window to which the Cramér-Rao bound belongs, px.
    pub bound_window: usize,
    /// What is measured.
    pub subject: Subject,
    /// Its sweep, if it has one; all else is then that of the first cell.
    pub sweep: Option<Sweep>,
    /// The text of its file.
    pub text: String,
}

/// What a scenario measures.
pub enum Subject {
    /// A rendered scene, whose truth is known.
    Scene(Box<SceneSubject>),
    /// Views of a testfield, whose truth is known.
    Views(Box<ViewsSubject>),
    /// Photographs, of which no truth is known.
    Photographs(PhotographsSubject),
}

/// A rendered scene and how its images come about.
pub struct SceneSubject {
    /// The scene of phase zero.
    pub scene: Scene,
    /// Where measuring starts.
    pub starts: Starts,
    /// How the scene becomes pixels.
    pub pixels: Pixels,
    /// Quantisation.
    pub bits: Option<u32>,
    /// Standard deviation of the grey-value noise, fraction of full scale.
    pub grey_noise: f64,
    /// Where the scene lies on the pixel grid.
    pub phase: Phase,
    /// Lens and sensor.
    pub imaging: Imaging,
}

impl SceneSubject {
    /// What renders its images.
    ///
    /// # Errors
    /// Optics that are out of range.
    pub fn renderer(&self) -> Result<Renderer, OpticsError> {
        self.imaging.renderer(self.scene.width, self.scene.height)
    }

    /// Is the image to be kept with 16 bits?
    pub fn is_deep(&self) -> bool {
        if self.imaging.sensor.is_some() { self.imaging.is_deep() } else { self.bits.is_none_or(|bits| bits > 8) }
    }
}

/// Views of a testfield by a camera.
pub struct ViewsSubject {
    /// What is seen.
    pub field: Testfield,
    /// Standard deviation of its surveyed coordinates, object units, if it was surveyed with any error.
    pub survey_sigma: Option<f64>,
    /// The object unit.
    pub unit: Unit,
    /// With which interior orientation.
    pub camera: Camera,
    /// The file that it was read from.
    pub camera_file: Option<PathBuf>,
    /// From where, in the order of reports; those of the first trial if they change.
    pub stations: Vec<Station>,
    /// What draws other stations in each trial.
    pub redraw: Option<StationPlan>,
    /// Lens and sensor.
    pub imaging: Imaging,
    /// Who points at the targets, unless a detector does.
    pub hand: Hand,
    /// What finds them in place of a hand.
    pub detector: Option<Detector>,
    /// What is done with the measured points of every trial, if more than scoring them.
    pub calibration: Option<Calibration>,
}

impl ViewsSubject {
    /// The stations of the trial of `key`.
    ///
    /// # Errors
    /// No poses within the bounds of stations that are drawn anew in each trial.
    pub fn stations_of(&self, key: Key<'_>) -> Result<Cow<'_, [Station]>, StationError> {
        match &self.redraw {
            None => Ok(Cow::Borrowed(&self.stations)),
            Some(drawing) => drawing.generate(&self.field, &self.camera, key).map(Cow::Owned),
        }
    }
}

/// Approximate positions.
pub enum Starts {
    /// One for each target, as the scenario gives them.
    Given(Vec<PixelPoint>),
    /// Pointed at anew in each trial.
    Pointed(Hand),
    /// Found in each image.
    Detected(Detector),
}

impl Starts {
    /// Are they the same for the same image?
    fn are_fixed(&self) -> bool {
        match self {
            Self::Given(_) | Self::Detected(_) => true,
            // A hand that does not shake, whether it stops at whole pixels or not.
            Self::Pointed(hand) => hand.sigma == 0.0,
        }
    }
}

impl From<Pointing> for Starts {
    fn from(pointing: Pointing) -> Self {
        match pointing {
            Pointing::Hand(hand) => Self::Pointed(hand),
            Pointing::Detector(detector) => Self::Detected(detector),
        }
    }
}

/// Photographs of a chessboard.
pub struct PhotographsSubject {
    /// Their folder, as written.
    pub folder: String,
    /// Their names.
    pub files: Vec<String>,
    /// The board.
    pub board: Board,
    /// How calibrations from them are judged, if they are.
    pub judgement: Option<JudgementPlan>,
}

impl Scenario {
    /// Is there nothing random in it? Its figures are then the same in every trial and for every seed.
    pub fn is_deterministic(&self) -> bool {
        match &self.subject {
            Subject::Scene(scene) => {
                let still = scene.phase == Phase::Fixed && scene.starts.are_fixed();
                still && scene.grey_noise == 0.0 && !scene.imaging.is_random()
            }
            Subject::Views(views) => {
                let still = views.calibration.as_ref().is_none_or(|calibration| !calibration.is_random());
                still && views.hand.sigma == 0.0 && views.redraw.is_none() && !views.imaging.is_random()
            }
            Subject::Photographs(_) => true,
        }
    }

    /// Is the truth of its points known?
    pub fn has_truth(&self) -> bool {
        !matches!(self.subject, Subject::Photographs(_))
    }

    /// Do its points go through an adjustment?
    pub fn is_adjusted(&self) -> bool {
        matches!(&self.subject, Subject::Views(views) if views.calibration.is_some())
    }

    /// The pixel pitch of the adjusted camera, um.
    pub fn pitch_um(&self) -> Option<f64> {
        let Subject::Views(views) = &self.subject else { return None };
        views.calibration.as_ref().map(|calibration| calibration.start.pitch_um)
    }

    /// The part of the name before the first `/`: the folder, and the report.
    pub fn family(&self) -> &str {
        self.name.split('/').next().unwrap_or(&self.name)
    }
}
