//! Why a calibration is in doubt.

use std::fmt;

use crate::Finding;

/// What of a calibration is in doubt.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Subject {
    /// The stated precision of image points.
    Precision,
    /// Image points in gross error.
    GrossErrors,
    /// The coordinates of control points.
    Control,
    /// Measured distances.
    Distances,
    /// A board whose corners were measured.
    Board,
    /// The lens: more than the model pictures.
    Lens,
    /// One pose for all rows of an image.
    Shutter,
    /// The size of the images, or the order of coordinates: points lie outside.
    Frame,
    /// Names, counts, sizes or the model: residuals that no operator leaves.
    Residuals,
    /// A camera that folds over inside its frame.
    Fold,
    /// A camera that no lens makes.
    Implausible,
    /// Images that are a part of what was exposed.
    Crop,
    /// How well the camera is known over its frame.
    OverFrame,
    /// Errors that belong together in an image.
    Together,
    /// Another camera that fits as well.
    Rival,
}

impl Subject {
    /// All of them, with their names for programs and what each is in words.
    pub const ALL: [(Self, &'static str, &'static str); 15] = [
        (Self::Precision, "precision", "the precision of image points"),
        (Self::GrossErrors, "gross-errors", "gross errors of image points"),
        (Self::Control, "control", "the coordinates of control points"),
        (Self::Distances, "distances", "measured distances"),
        (Self::Board, "board", "the board as measured"),
        (Self::Lens, "lens", "the lens"),
        (Self::Shutter, "shutter", "one pose for all rows of an image"),
        (Self::Frame, "frame", "the size of the images"),
        (Self::Residuals, "residuals", "the size of residuals"),
        (Self::Fold, "fold", "a camera without folds"),
        (Self::Implausible, "implausible", "a camera as lenses are"),
        (Self::Crop, "crop", "images that are not cropped"),
        (Self::OverFrame, "over-frame", "the camera over its frame"),
        (Self::Together, "together", "errors that differ from point to point"),
        (Self::Rival, "rival", "one camera that fits"),
    ];

    /// The name for programs.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(subject, ..)| *subject == self).map_or("", |(_, name, _)| name)
    }

    /// What was looked at, in words.
    pub fn what(self) -> &'static str {
        Self::ALL.iter().find(|(subject, ..)| *subject == self).map_or("", |(.., what)| what)
    }
}

/// Why a calibration is in doubt. With any the exit code is 3.
#[derive(Clone, Debug, PartialEq)]
pub struct Doubt {
    /// What is in doubt.
    pub subject: Subject,
    /// The place of the camera that it is about; `None` where it is about all.
    pub camera: Option<usize>,
    /// How strong it is, where that was tested.
    pub finding: Option<Finding>,
    /// The most likely cause, and what to do.
    pub words: String,
}

impl Doubt {
    pub(crate) fn of_all(subject: Subject, words: String) -> Self {
        Self { subject, camera: None, finding: None, words }
    }

    pub(crate) fn of_camera(subject: Subject, camera: usize, words: String) -> Self {
        Self { camera: Some(camera), ..Self::of_all(subject, words) }
    }
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_subject_has_a_name_and_words_of_its_own() {
        for (place, (subject, name, what)) in Subject::ALL.iter().enumerate() {
            assert_eq!((subject.name(), subject.what()), (*name, *what));
            let others = || Subject::ALL[..place].iter();
            assert!(others().all(|(_, other, words)| other != name && words != what), "{name}");
            assert!(name.chars().all(|c| c.is_ascii_lowercase() || c == '-'), "{name}");
        }
    }
}
