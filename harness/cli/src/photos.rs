//! Photographs of one camera.

use std::path::PathBuf;

use calibench_model::camera::ImageSize;
use calibench_photographs::PhotographsError;
use calibench_photographs::names::same_size;

use crate::failure::Failure;

/// The size that all photographs have; several cameras have an option.
pub fn one_size<'p>(photos: impl IntoIterator<Item = (&'p PathBuf, ImageSize)>) -> Result<ImageSize, Failure> {
    same_size(photos).map_err(|error| match error {
        PhotographsError::Sizes { .. } => Failure::input(format!("{error} (several cameras: `calibrate --camera`)")),
        other => other.into(),
    })
}
