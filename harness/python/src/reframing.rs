//! The same camera in other images.

use calibench_model::NamedCamera;
use calibench_model::camera::{ImageSize, Turn};
use calibench_model::reframing::{Crop, FrameChange, Reframing, Scaling, same_camera};
use pyo3::prelude::*;

use crate::error::input;
use crate::image_size::size_of;

/// What is asked for, of images of the size `own`.
///
/// # Errors
/// Numbers that are none of a part, a size, a factor or a turn; two sizes; a part beyond the images.
pub fn reframing(
    own: ImageSize,
    crop: Option<[i64; 4]>,
    size: Option<&Bound<'_, PyAny>>,
    (scale, binned): (Option<f64>, Option<u32>),
    turn: Option<u16>,
) -> PyResult<Reframing> {
    let crop = crop.map(|numbers| {
        let wrong = || input(format!("crop: {numbers:?}; expected column and row from 0 on, columns and rows, as in (0, 150, 1600, 900)"));
        let [x, y, width, height] = numbers.map(|number| u32::try_from(number).ok());
        let part = x.zip(y).zip(width.zip(height)).ok_or_else(wrong)?;
        let ((x, y), (width, height)) = part;
        Ok::<_, PyErr>(Crop { x, y, size: ImageSize { width, height } })
    });
    let size = size.map(size_of).transpose()?.map(Scaling::Size);
    let scale = scale
        .map(|times| if times > 0.0 { Ok(Scaling::Times(times)) } else { Err(input(format!("scale: {times}; expected more than 0"))) });
    let binned = binned.map(|count| if count > 0 { Ok(Scaling::Binned(count)) } else { Err(input("binned: 0; expected 1 or more")) });
    let scalings: Vec<Scaling> = size.into_iter().chain(scale.transpose()?).chain(binned.transpose()?).collect();
    if scalings.len() > 1 {
        return Err(input("size, scale, binned: other images have one size; expected one of the three"));
    }
    let turn = turn.map(|degrees| {
        let known = Turn::ALL.into_iter().find(|turn| turn.degrees() == degrees);
        known.ok_or_else(|| input(format!("turn: {degrees}; expected 90, 180 or 270 degrees, clockwise")))
    });
    let change = FrameChange { crop: crop.transpose()?, scaling: scalings.first().copied(), turn: turn.transpose()? };
    change.of(own).map_err(input)
}

/// The camera that an error calls `what`, which is to be of images of `size`.
///
/// # Errors
/// A camera of images of another size.
pub fn of_images<'c>(camera: &'c NamedCamera, size: ImageSize, what: &str) -> PyResult<&'c NamedCamera> {
    let Some(other) = same_camera(camera, size, false).err() else { return Ok(camera) };
    Err(input(format!("{what} {other}; its method `reframe` gives the same camera in other images")))
}
