//! Photographs, and how they are read.

use std::path::PathBuf;

use calibench_model::camera::ImageSize;
use calibench_photographs::names::same_size;
use calibench_photographs::{Asked, PhotographsError, Reader, in_folders};
use clap::Args;

use crate::failure::Failure;

/// Photographs, with those in a folder in its place; says on standard error which pictures of a folder are not read.
pub fn with_folders(given: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let (photos, notes) = in_folders(given)?;
    notes.iter().for_each(|line| say!("{line}"));
    Ok(photos)
}

/// How photographs are read.
#[derive(Args)]
pub struct AsRead {
    /// Take pixels as the files have them, whatever orientation their EXIF or TIFF tag asks for [default: turned as OpenCV's imread does; of one camera only where all ask for the same]
    #[arg(long)]
    ignore_orientation: bool,
    /// Bits of a level in files of 16 bits, as of a camera of 12: the largest number of them is white [default: by the levels of all photographs]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(8..=16))]
    bits: Option<u8>,
}

impl AsRead {
    /// That there are no photographs to read so.
    ///
    /// # Errors
    /// Options of photographs that are given all the same.
    pub fn without_photographs(&self) -> Result<(), Failure> {
        let given = [("--ignore-orientation", self.ignore_orientation), ("--bits", self.bits.is_some())];
        let given: Vec<&str> = given.into_iter().filter(|(_, given)| *given).map(|(name, _)| name).collect();
        if given.is_empty() {
            return Ok(());
        }
        Err(Failure::input(format!("{}: for photographs, and --points has none; leave it out", given.join(", "))))
    }

    /// What reads photographs of any cameras; says on standard error how.
    pub fn reader(&self, photos: &[PathBuf]) -> Result<Reader, Failure> {
        self.asked(photos, Asked::default())
    }

    /// What reads photographs of one camera; says on standard error how. Sizes are compared before anything is measured.
    pub fn of_one_camera(&self, photos: &[PathBuf], only_size: Option<ImageSize>) -> Result<Reader, Failure> {
        self.asked(photos, Asked { only_size, one_camera: true, ..Asked::default() })
    }

    /// What reads photographs of a sequence, of which some are then read as those of one camera: says nothing of how.
    pub fn of_sequence(&self, photos: &[PathBuf], only_size: Option<ImageSize>) -> Result<Reader, Failure> {
        let asked = Asked { ignore_orientation: self.ignore_orientation, bits: self.bits, only_size, one_camera: true };
        Reader::of(photos, asked).map_err(of_one_camera)
    }

    /// Whether pixels stay where the sensor had them.
    pub const fn is_as_stored(&self) -> bool {
        self.ignore_orientation
    }

    fn asked(&self, photos: &[PathBuf], asked: Asked) -> Result<Reader, Failure> {
        let asked = Asked { ignore_orientation: self.ignore_orientation, bits: self.bits, ..asked };
        let reader = Reader::of(photos, asked).map_err(of_one_camera)?;
        reader.notes().iter().for_each(|line| say!("{line}"));
        Ok(reader)
    }
}

/// Says how photographs are turned and what their levels are, on standard error.
pub fn say_turns(photos: &[PathBuf]) -> Result<(), Failure> {
    Reader::of(photos, Asked { bits: Some(16), ..Asked::default() })?.notes().iter().for_each(|line| say!("{line}"));
    Ok(())
}

/// The size that all photographs have; several cameras have an option.
pub fn one_size<'p>(photos: impl IntoIterator<Item = (&'p PathBuf, ImageSize)>) -> Result<ImageSize, Failure> {
    same_size(photos).map_err(of_one_camera)
}

/// What is wrong with photographs of one camera.
pub fn of_one_camera(error: PhotographsError) -> Failure {
    match error {
        PhotographsError::Sizes(_) => Failure::input(format!("{error} (several cameras: `calibrate --camera`)")),
        other => other.into(),
    }
}
