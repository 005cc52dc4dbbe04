//! What is to be known of a format of camera files.

use calibench_model::camera::Convention;
use calibench_model::convert::Target;

use super::numbering::Numbering;
use super::source::Source;
use super::{CameraFileError, NamedCamera, ReadOptions};

/// A model that a format holds.
#[derive(Clone, Copy, Debug)]
pub struct Model {
    /// Its name in the tool.
    pub name: &'static str,
    /// Its model here.
    pub target: Target,
}

/// What a format has a place for besides the camera.
#[derive(Clone, Copy, Debug)]
pub struct Keeps {
    /// mrcal's splines as they are.
    pub splines: bool,
    /// A name.
    pub name: bool,
    /// The pixel pitch.
    pub pitch: bool,
    /// A pose.
    pub pose: KeptPose,
    /// The covariance of the parameters.
    pub covariance: KeptCovariance,
}

/// What of a pose a format keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeptPose {
    /// Nothing.
    None,
    /// That in a rig.
    InRig,
    /// That in a world.
    InWorld,
}

/// How much of a covariance a format keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeptCovariance {
    /// Nothing.
    None,
    /// Standard deviations without correlations.
    Variances,
    /// All of it.
    Whole,
}

/// Cameras to text.
type Writer = fn(&[NamedCamera]) -> Result<String, CameraFileError>;

/// A format whose files are no text.
pub(super) struct Binary {
    /// Accepts a file of this format; the error says why it is none.
    pub recognise: fn(&[u8]) -> Result<(), String>,
    pub read: fn(&[u8], &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError>,
    pub write: fn(&[NamedCamera]) -> Result<Vec<u8>, CameraFileError>,
}

/// How a file that is written in pieces is put together.
pub(super) struct Parts {
    /// What stands before the cameras, for their number.
    pub head: fn(usize) -> Vec<u8>,
    /// Some of the cameras.
    pub body: fn(&[NamedCamera], Numbering) -> Result<Vec<u8>, CameraFileError>,
}

/// A format of camera files.
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct CameraFormat {
    /// Its name here.
    pub name: &'static str,
    /// The tool, or tools, that it belongs to.
    pub tool: &'static str,
    /// The tool's versions that it is known from.
    pub versions: &'static str,
    /// The usual ending of its file names, without a dot.
    pub extension: &'static str,
    /// Names that stand in its files, by which a file that no format recognises is said to be near it.
    pub(super) words: &'static str,
    /// Which of the tool's own numbers were reproduced; `None`: unverified.
    pub verified: Option<&'static str>,
    /// It may hold more than one camera.
    pub many: bool,
    /// It states the size of the images; where it does not, [`ReadOptions::size`] is needed. OpenCV's may leave it out.
    pub states_size: bool,
    /// Accepts a file of this format; the error says why it is none.
    pub(super) recognise: fn(&Source<'_>) -> Result<(), String>,
    pub(super) read: fn(&Source<'_>, &ReadOptions) -> Result<Vec<NamedCamera>, CameraFileError>,
    pub(super) write: Option<Writer>,
    /// In place of the three before, where its files are no text.
    pub(super) binary: Option<Binary>,
    /// Its lists may be written in pieces, and are then as long as they need be.
    pub(super) parts: Option<Parts>,
    /// The convention of its numbers, where the cameras read from it are of another.
    pub convention: Option<&'static Convention>,
    /// The models that it holds, the leanest first, for a pixel pitch in um if one is known; empty for a format that is written through its convention.
    pub(super) models: fn(Option<f64>) -> Vec<Model>,
    /// What it has a place for besides the camera.
    pub keeps: Keeps,
    /// Public sources leave open whether (0, 0) is the centre of the first pixel, as is assumed, or its corner.
    pub origin_is_open: bool,
    /// Its tool divides by z: a fisheye's rays beyond 90 degrees from the axis are pictured elsewhere, or not at all.
    pub(super) half_space: bool,
    /// It does not say whether its coefficients are Brown's or those of the division model: [`ReadOptions::lens`].
    pub lens_is_open: bool,
    /// Its matrices may have names of one's own: [`ReadOptions::matrix`], [`ReadOptions::distortion`].
    pub(super) named_matrices: bool,
}

/// What most formats have in common, for struct updates.
pub(super) const PLAIN: CameraFormat = CameraFormat {
    name: "",
    tool: "",
    versions: "",
    extension: "",
    words: "",
    verified: None,
    many: false,
    states_size: true,
    recognise: |_| Err(String::new()),
    read: |_, _| Ok(Vec::new()),
    write: None,
    binary: None,
    parts: None,
    convention: None,
    models: |_| Vec::new(),
    keeps: Keeps { splines: false, name: false, pitch: false, pose: KeptPose::None, covariance: KeptCovariance::None },
    origin_is_open: false,
    half_space: false,
    lens_is_open: false,
    named_matrices: false,
};

impl CameraFormat {
    /// The models that it holds, the leanest first, for a pixel pitch in um if one is known.
    pub fn models(&self, pitch_um: Option<f64>) -> Vec<Model> {
        (self.models)(pitch_um)
    }

    /// Whether it can be written.
    pub fn is_written(&self) -> bool {
        self.write.is_some() || self.binary.is_some()
    }

    /// Whether its lists can be written in pieces: [`super::ListWriter`].
    pub fn is_written_in_pieces(&self) -> bool {
        self.parts.is_some()
    }

    /// The error for a camera whose model the format does not hold.
    pub(super) fn other_model(&self, model: &str) -> CameraFileError {
        CameraFileError::new(format!("{} holds {model}; convert the camera first", self.name))
    }
}

impl PartialEq for CameraFormat {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for CameraFormat {}

impl std::fmt::Debug for CameraFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}
