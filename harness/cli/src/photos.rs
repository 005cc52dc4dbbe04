//! Photographs of one camera.

use std::path::PathBuf;

use calibench_model::camera::ImageSize;
use calibench_photographs::names::same_size;
use calibench_photographs::{PhotographsError, turns};

use crate::failure::Failure;

/// Says how photographs are turned, on standard error.
pub fn say_turns(photos: &[PathBuf]) -> Result<(), Failure> {
    turns(photos)?.iter().for_each(|line| say!("{line}"));
    Ok(())
}

/// The size that all photographs have; several cameras have an option.
pub fn one_size<'p>(photos: impl IntoIterator<Item = (&'p PathBuf, ImageSize)>) -> Result<ImageSize, Failure> {
    same_size(photos).map_err(of_one_camera)
}

/// What is wrong with photographs of one camera.
pub fn of_one_camera(error: PhotographsError) -> Failure {
    match error {
        PhotographsError::Sizes { .. } => Failure::input(format!("{error} (several cameras: `calibrate --camera`)")),
        other => other.into(),
    }
}
