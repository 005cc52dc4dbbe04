//! What a scenario measures.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use calibench_diagnostics::Problem;
use calibench_measure::Board;
use calibench_model::camera::{Camera, CameraModel};
use calibench_model::{PixelPoint, Scene, TargetKind, Testfield};
use calibench_random::Key;
use calibench_synth::local::{LocalDistortion, LocalError};
use calibench_synth::optics::OpticsError;
use calibench_synth::pointing::Hand;
use calibench_synth::raster::Renderer;
use calibench_synth::stations::{Station, StationError};

use crate::camera::LocalPlan;
use crate::studies::blocks::Blocks;
use crate::studies::calibrators::Calibrators;
use crate::studies::network::Calibration;
use crate::studies::networks::Networks;
use crate::studies::printed::Printed;
use crate::studies::recognition::{RECOGNITION, Recognition};
use crate::studies::tasks::Tasks;
use crate::studies::transfer::Transfer;
use crate::studies::{Points, StudyPlan};
use crate::{Detector, HarrisPointing, Imaging, JudgementPlan, Phase, Pixels, Pointing, StationPlan, Unit};

/// What a scenario measures.
pub enum Subject {
    /// A rendered scene, whose truth is known.
    Scene(Box<SceneSubject>),
    /// Views of a testfield, whose truth is known.
    Views(Box<ViewsSubject>),
    /// Photographs, of which no truth is known.
    Photographs(PhotographsSubject),
    /// Figures that were printed: nothing is measured.
    Printed(Box<Printed>),
}

impl Subject {
    /// What is made of it.
    pub fn study(&self) -> &dyn StudyPlan {
        match self {
            Self::Scene(_) | Self::Photographs(_) => &Points,
            Self::Views(subject) => subject.study.plan(),
            Self::Printed(printed) => &**printed,
        }
    }

    /// Whether it is run by its name or by `league`, and not with others, where it is left to the night.
    pub fn runs_apart(&self) -> bool {
        match self {
            Self::Photographs(photographs) => photographs.judgement.as_ref().is_some_and(|judgement| judgement.league.is_some()),
            other => other.study().runs_apart(),
        }
    }

    /// Whether image points are measured, and not figures made by methods of its own.
    pub fn is_measured(&self) -> bool {
        self.study().own_methods().is_none()
    }

    /// The kind of every target that may be measured: none where no image points are.
    pub fn kinds(&self) -> Vec<TargetKind> {
        match self {
            _ if !self.is_measured() => Vec::new(),
            Self::Scene(subject) => subject.scene.targets.iter().map(|target| target.kind).collect(),
            Self::Views(subject) => subject.field.targets.iter().map(|target| target.kind).collect(),
            Self::Photographs(_) => vec![TargetKind::ChessCorner],
            Self::Printed(_) => Vec::new(),
        }
    }

    /// The sets of figures that its records have, if they have any: of its study, then the counts of recognition.
    pub fn sets(&self) -> Vec<String> {
        match self {
            Self::Views(subject) => subject.sets(),
            Self::Scene(_) | Self::Photographs(_) | Self::Printed(_) => self.study().sets(),
        }
    }
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

    /// Whether the image is kept with 16 bits.
    pub fn is_deep(&self) -> bool {
        if self.imaging.sensor.is_some() { self.imaging.is_deep() } else { self.bits.is_none_or(|bits| bits > 8) }
    }
}

/// Views of a testfield by a camera.
#[derive(Clone, Debug)]
pub struct ViewsSubject {
    /// What is seen.
    pub field: Testfield,
    /// The board that it is meant to be, if it is one: without bend and errors of printing.
    pub sheet: Option<calibench_model::boards::Board>,
    /// Standard deviation of its surveyed coordinates, object units, if it was surveyed with any error.
    pub survey_sigma: Option<f64>,
    /// The object unit.
    pub unit: Unit,
    /// With which interior orientation.
    pub camera: Camera,
    /// The file that it was read from.
    pub camera_file: Option<PathBuf>,
    /// The file of the board's own corners, if there is one.
    pub corner_file: Option<PathBuf>,
    /// What the camera distorts beyond its interior orientation.
    pub local: Option<LocalPlan>,
    /// From where, in the order of reports; those of the first trial if they change.
    pub stations: Vec<Station>,
    /// What draws other stations in each trial.
    pub redraw: Option<StationPlan>,
    /// What is drawn by chance and is the same in all trials, in words.
    pub drawn_once: Vec<&'static str>,
    /// Lens and sensor.
    pub imaging: Imaging,
    /// Who points at the targets, unless a detector does.
    pub hand: Hand,
    /// Whether it points at targets too of which only a part is in view.
    pub clipped: bool,
    /// What finds them in place of a hand.
    pub detector: Option<Detector>,
    /// What recognises the field in its images, where measuring starts from that in place of a hand.
    pub recognition: Option<Recognition>,
    /// What is made of the measured points of every trial.
    pub study: Study,
}

/// What is made of the points that are measured in views: one of the studies.
#[derive(Clone, Debug)]
pub enum Study {
    /// Each is scored against the truth.
    Points,
    /// They are adjusted with control, and the camera is scored.
    Network(Box<Calibration>),
    /// Free networks are made of them.
    Blocks(Box<Blocks>),
    /// Whole calibration systems are told them, and their cameras are scored.
    Calibrators(Box<Calibrators>),
    /// Free networks and rigs are made of them, as `calibrate` adjusts them.
    Networks(Box<Networks>),
    /// Cameras are calibrated from them, and measure.
    Tasks(Box<Tasks>),
    /// Nothing is measured: calibrations that are made elsewhere are applied here.
    Transfer {
        /// Which, and how.
        plan: Box<Transfer>,
        /// The board from which they are made, with its lens, sensor and hand, and the camera of these views.
        board: Option<Box<ViewsSubject>>,
    },
}

impl Study {
    /// What it says of itself.
    pub fn plan(&self) -> &dyn StudyPlan {
        match self {
            Self::Points => &Points,
            Self::Network(plan) => &**plan,
            Self::Blocks(plan) => &**plan,
            Self::Calibrators(plan) => &**plan,
            Self::Networks(plan) => &**plan,
            Self::Tasks(plan) => &**plan,
            Self::Transfer { plan, .. } => &**plan,
        }
    }

    /// Whether something is made of the image points beside their scores.
    pub fn is_adjusted(&self) -> bool {
        !matches!(self, Self::Points | Self::Transfer { .. })
    }

    /// The adjustment with control, if it is one.
    pub fn network(&self) -> Option<&Calibration> {
        if let Self::Network(plan) = self { Some(plan) } else { None }
    }

    /// Where cameras are when what carries them stands at `stations`: there, unless it is a rig.
    pub(crate) fn cameras_at<'s>(&self, stations: Cow<'s, [Station]>) -> Cow<'s, [Station]> {
        if let Self::Networks(plan) = self { plan.cameras_at(stations) } else { stations }
    }

    /// The calibrations that are applied, if it is of those.
    pub fn transfer(&self) -> Option<&Transfer> {
        if let Self::Transfer { plan, .. } = self { Some(plan) } else { None }
    }
}

impl ViewsSubject {
    /// The files beside the scenario that it was read from: of its camera, of its board.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.camera_file.iter().chain(&self.corner_file).map(PathBuf::as_path)
    }

    /// The sets of figures that its records have, if they have any: of its study, then the counts of recognition.
    pub fn sets(&self) -> Vec<String> {
        let recognition = self.recognition.iter().map(|_| RECOGNITION.to_owned());
        self.study.plan().sets().into_iter().chain(recognition).collect()
    }

    /// Whether the points of all trials are kept, and not those of the first alone.
    pub fn keeps_points(&self) -> bool {
        match self.study {
            // What is counted of all trials is in their figures.
            Study::Points => self.recognition.is_none(),
            Study::Network(_)
            | Study::Blocks(_)
            | Study::Calibrators(_)
            | Study::Networks(_)
            | Study::Tasks(_)
            | Study::Transfer { .. } => self.study.plan().keeps_points(),
        }
    }

    /// Whether the truth is another in each trial: stations that move, or a camera that distorts otherwise.
    pub fn changes(&self) -> bool {
        self.redraw.is_some() || self.local.is_some_and(|local| local.each_trial)
    }

    /// The local distortion of the camera in the trial of `key`.
    ///
    /// # Errors
    /// None for a scenario that was checked.
    pub fn local_of(&self, key: Key<'_>) -> Result<Option<LocalDistortion>, LocalError> {
        let Some(LocalPlan { design, each_trial }) = self.local else { return Ok(None) };
        let trial = if each_trial { key.trial } else { 0 };
        LocalDistortion::draw(design, self.camera.size(), Key { trial, ..key }).map(Some)
    }

    /// The stations of the trial of `key`.
    ///
    /// # Errors
    /// No poses within the bounds of stations that are drawn anew in each trial.
    pub fn stations_of(&self, key: Key<'_>) -> Result<Cow<'_, [Station]>, StationError> {
        match &self.redraw {
            None => Ok(Cow::Borrowed(&self.stations)),
            Some(drawing) => drawing.generate(&self.field, &self.camera, key).map(|stations| self.study.cameras_at(Cow::Owned(stations))),
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
    Detected(HarrisPointing),
}

impl Starts {
    /// Whether they are the same for the same image.
    pub(crate) fn are_fixed(&self) -> bool {
        match self {
            Self::Given(_) | Self::Detected(_) => true,
            // A hand that does not shake, whether it stops at whole pixels or not.
            Self::Pointed(hand) => hand.is_steady(),
        }
    }
}

impl Starts {
    /// Those of a drawing, in which no board is looked for.
    pub(crate) fn of_drawing(pointing: Pointing, problems: &mut Vec<Problem>) -> Option<Self> {
        match pointing {
            Pointing::Hand { hand, .. } => Some(Self::Pointed(hand)),
            Pointing::Harris(detector) => Some(Self::Detected(detector)),
            Pointing::Board { span, .. } => {
                problems.push(Problem::new(span, "`detector = \"board\"` in a drawing: expected it with a [testfield] that is a board"));
                None
            }
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
