//! A camera that somebody published of images.

use std::path::Path;

use calibench_model::NamedCamera;
use calibench_model::camera::ImageSize;
use calibench_model::reframing::same_camera;

use super::{ReadOptions, read_camera_with};

/// The first camera of a file called `name`, whatever the size of its images; of a file that does not state it `size`.
///
/// # Errors
/// In words, without the path.
pub fn first_camera(path: &Path, name: &str, size: ImageSize) -> Result<NamedCamera, String> {
    if !path.is_file() {
        return Err(format!("{name} is not beside the photographs"));
    }
    let read = read_camera_with(path, &ReadOptions { size: Some(size), other_size: true, ..ReadOptions::default() })
        .map_err(|_| format!("{name} cannot be read as a camera"))?;
    read.cameras.into_iter().next().ok_or_else(|| format!("{name} holds no camera"))
}

/// The same, of images of `size`.
///
/// # Errors
/// As [`first_camera`]; a camera of images of another size.
pub fn published_camera(path: &Path, name: &str, size: ImageSize) -> Result<NamedCamera, String> {
    let camera = first_camera(path, name, size)?;
    same_camera(&camera, size, false).map(|(camera, _)| camera).map_err(|other| format!("{name} {other}"))
}
