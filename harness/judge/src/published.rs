//! A calibration that somebody published of the same photographs.

use std::path::Path;

use calibench_exchange::{ReadOptions, read_camera_with};
use calibench_model::NamedCamera;
use calibench_model::camera::{CameraModel, ImageSize};
use nalgebra::DMatrix;

use crate::frame::Frame;
use crate::halves::places;

/// The first camera of a file called `name`.
///
/// # Errors
/// In words, without the path.
pub fn published_camera(path: &Path, name: &str, size: ImageSize) -> Result<NamedCamera, String> {
    if !path.is_file() {
        return Err(format!("{name} is not beside the photographs"));
    }
    let read = read_camera_with(path, &ReadOptions { size: Some(size), ..ReadOptions::default() })
        .map_err(|_| format!("{name} cannot be read as a camera"))?;
    let camera = read.cameras.into_iter().next().ok_or_else(|| format!("{name} holds no camera"))?;
    let own = camera.camera.size();
    if own == size { Ok(camera) } else { Err(format!("{name} is of images of {} x {} px", own.width, own.height)) }
}

/// The standard deviation (2D) that a camera's file states of it, RMS over the frame, px; `None` if it states none, or the frame is not pictured.
pub fn stated_sigma(named: &NamedCamera) -> Option<f64> {
    let stated = named.covariance.as_ref()?;
    let at = places(&named.camera).ok()?;
    let names: Vec<&str> = stated.parameters.iter().map(String::as_str).collect();
    let frame = Frame::new(&named.camera, &names, &at)?;
    let covariance = DMatrix::from_row_slice(names.len(), names.len(), &stated.values);
    Some(frame.spread(&covariance).0.sqrt())
}
