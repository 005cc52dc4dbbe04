//! The size of images as Python says it.

use calibench_model::camera::ImageSize;
use pyo3::prelude::*;

use crate::error::input;

/// The size of images.
///
/// # Errors
/// No columns or no rows.
pub fn size_of(size: &Bound<'_, PyAny>) -> PyResult<ImageSize> {
    let wrong = || input(format!("size: {size}; expected (columns, rows) of the images, px, as in (640, 480)"));
    let Ok([width, height]) = size.extract::<[i64; 2]>() else { return Err(wrong()) };
    let side = |side: i64| u32::try_from(side).ok().filter(|side| *side > 0).ok_or_else(wrong);
    Ok(ImageSize { width: side(width)?, height: side(height)? })
}
