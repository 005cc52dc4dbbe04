//! A camera that somebody published of images.

use std::path::Path;

use calibench_model::NamedCamera;
use calibench_model::camera::{CameraModel, ImageSize};

use super::{ReadOptions, read_camera_with};

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
