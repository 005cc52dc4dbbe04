//! Why there is no calibration.

use calibench_adjust::approximate::ApproximateError;
use calibench_adjust::{AdjustError, NetworkError};
use calibench_model::convert::ConvertError;
use thiserror::Error;

/// Why there is no calibration.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CalibrationError {
    /// No measured target is a control point.
    #[error("no measured target is a control point: `{measured}` was measured, `{control}` is known{}", near.as_ref().map_or(String::new(), |near| format!("; is it `{near}`?")))]
    NothingInCommon {
        /// The first measured target.
        measured: String,
        /// The first control point.
        control: String,
        /// The control point whose name is nearest.
        near: Option<String>,
    },
    /// No image with points has a station.
    #[error("no image has a station: points are of `{image}`, stations are of `{station}`")]
    NoStation {
        /// The first image.
        image: String,
        /// The first station.
        station: String,
    },
    /// Images without a pose.
    #[error("no exterior orientation: {}", without_pose(images))]
    NoPose {
        /// Each with the reason.
        images: Vec<(String, String)>,
    },
    /// A model that is not known.
    #[error("no camera model is called {name}; known are {known}{}", near.as_ref().map_or(String::new(), |near| format!("; did you mean `{near}`?")))]
    UnknownModel {
        /// What was asked for.
        name: String,
        /// The names that there are.
        known: String,
        /// The nearest.
        near: Option<String>,
    },
    /// A model in mm without a pixel pitch.
    #[error("{what} in mm: give the pixel pitch with --pitch UM (width of the sensor over columns)")]
    NoPitch {
        /// Whose units they are.
        what: String,
    },
    /// A number of each image's own that cannot be.
    #[error("--per-image {name}: {why}")]
    PerImage {
        /// The number.
        name: String,
        /// The reason, and what was expected.
        why: String,
    },
    /// An image that no camera claims.
    #[error("`{image}` belongs to no camera: there are {cameras}; give one of them a pattern that names it")]
    WhoseImage {
        /// The image.
        image: String,
        /// The cameras with their patterns.
        cameras: String,
    },
    /// A camera without images.
    #[error("camera `{camera}` has no image: expected a pattern that names some of them (`*` is any text); the first is `{first}`")]
    NoImage {
        /// Its name.
        camera: String,
        /// The first image.
        first: String,
    },
    /// Images of a rig that cannot be paired, in words.
    #[error("{0}")]
    Pairing(String),
    /// What a rig is not adjusted with, in words.
    #[error("{0}")]
    Rig(String),
    /// What splines are not adjusted with, in words.
    #[error("{0}")]
    Splines(String),
    /// A datum's target that is no measured control point.
    #[error("the datum names {target}, which is no measured control point")]
    DatumTarget {
        /// Its name.
        target: String,
    },
    /// A target of a distance or length that takes no part.
    #[error("a {of} names {target}, which takes no part: {why}{}", near.as_ref().map_or(String::new(), |near| format!("; is it `{near}`?")))]
    LengthTarget {
        /// Whether of a measured distance or of a length that was asked for.
        of: &'static str,
        /// Its name.
        target: String,
        /// Why not.
        why: String,
        /// The measured target whose name is nearest.
        near: Option<String>,
    },
    /// A reconstruction that is none.
    #[error("the reconstruction: {why}")]
    Reconstruction {
        /// What is wrong with it.
        why: String,
    },
    /// No object coordinates from image points alone.
    #[error("no object coordinates from image points alone: {why}")]
    NoModel {
        /// The reason, and what to do.
        why: String,
    },
    /// A bent board was asked for, and there is no board.
    #[error("the board cannot be bent: {why}; expected --board-shape flat")]
    NoBoard {
        /// Why there is none.
        why: &'static str,
    },
    /// A board that cannot be measured.
    #[error("the board cannot be measured: {why}")]
    NotMeasured {
        /// Why not, and what is expected.
        why: &'static str,
    },
    /// A scale of the board beside others.
    #[error("the scale of the board is stated and {why}: expected one of them")]
    BoardScale {
        /// What else says it.
        why: &'static str,
    },
    /// A parameter that is observed twice.
    #[error("parameter {parameter} is observed twice; expected one value with its standard deviation")]
    PriorTwice {
        /// Its name.
        parameter: String,
    },
    /// An observed pose of an image without points.
    #[error("the pose of `{image}` was observed, but no point is of this image{}", near.as_ref().map_or(String::new(), |near| format!("; is it `{near}`?")))]
    StationOfNone {
        /// The image's name.
        image: String,
        /// The image whose name is nearest.
        near: Option<String>,
    },
    /// Discs whose planes nothing tells.
    #[error("no plane for {}: their nearest neighbours lie in none; give the control file nX,nY,nZ of these discs", few(targets))]
    NoPlane {
        /// Their names.
        targets: Vec<String>,
    },
    /// The eccentricity of discs was asked for, and there is none.
    #[error("no image point is of a disc: {}", if *with_radius { "the point file says that all are of other kinds; expected `disc` in its column `kind`, or no kind" } else { "no measured target has a `radius` in the control file; expected that column, or the radius itself" })]
    NoDisc {
        /// Whether a radius was given for all.
        with_radius: bool,
    },
    /// The eccentricity of discs and the adjustment do not settle.
    #[error("the eccentricity of the discs does not settle: is their radius in the units of the control file?")]
    NotCentred,
    /// The start cannot be put into the model.
    #[error("the start values do not fit the model: {0}")]
    Convert(#[from] ConvertError),
    /// No start values.
    #[error("no start values: {0}")]
    Start(#[from] ApproximateError),
    /// No adjustment.
    #[error("{}{}", .0, hint(.0))]
    Adjust(#[from] AdjustError),
}

/// Some names, and how many more there are.
pub fn few(names: &[String]) -> String {
    let shown = names.iter().take(5).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > 5 { format!("{shown} and {} more", names.len() - 5) } else { shown }
}

/// Some images with their reasons, and how many more there are.
fn without_pose(images: &[(String, String)]) -> String {
    let shown = images.iter().take(5).map(|(name, why)| format!("image {name}: {why}")).collect::<Vec<_>>().join("; ");
    if images.len() > 5 { format!("{shown}; and {} images more", images.len() - 5) } else { shown }
}

fn hint(error: &AdjustError) -> &'static str {
    match error {
        AdjustError::NotConverged { .. } => "; where many image points are in gross error this happens",
        _ => "",
    }
}

impl From<NetworkError> for CalibrationError {
    fn from(error: NetworkError) -> Self {
        Self::Adjust(error.into())
    }
}

impl CalibrationError {
    /// Whether the observations leave unknowns open, or nearly so: what is known of a parameter would help.
    pub fn is_undetermined(&self) -> bool {
        matches!(self, Self::Adjust(AdjustError::Undetermined(_) | AdjustError::NotConverged { .. }))
    }
}
