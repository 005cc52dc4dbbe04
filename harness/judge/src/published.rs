//! A calibration that somebody published of the same photographs.

use std::path::Path;

use calibench_exchange::{ReadOptions, read_camera_with};
use calibench_model::camera::{Camera, ImageSize};

/// The first camera of a file called `name`.
///
/// # Errors
/// In words, without the path.
pub fn published_camera(path: &Path, name: &str, size: ImageSize) -> Result<Camera, String> {
    if !path.is_file() {
        return Err(format!("{name} is not beside the photographs"));
    }
    let read = read_camera_with(path, &ReadOptions { size: Some(size), fisheye: None })
        .map_err(|_| format!("{name} cannot be read as a camera"))?;
    let camera = read.cameras.first().map(|named| named.camera).ok_or_else(|| format!("{name} holds no camera"))?;
    let own = calibench_model::camera::CameraModel::size(&camera);
    if own == size { Ok(camera) } else { Err(format!("{name} is of images of {} x {} px", own.width, own.height)) }
}
