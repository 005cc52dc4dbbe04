//! Cameras of files for images of another size.

use std::path::Path;

use calibench_model::NamedCamera;
use calibench_model::camera::ImageSize;
use calibench_model::reframing::same_camera;

use crate::failure::Failure;
use crate::reading::shown;

/// `named`, of the file `path`, for images of `size`: of another size where `is_same` says that it is the same camera, with a word on standard error about what was made
/// of it.
pub fn for_images(path: &Path, named: &NamedCamera, size: ImageSize, is_same: bool) -> Result<NamedCamera, Failure> {
    let file = shown(path);
    let (taken, words) = same_camera(named, size, is_same)
        .map_err(|other| Failure::input(format!("{file}: the camera {}", other.advice("--same-camera", &file))))?;
    words.iter().for_each(|words| say!("{file}: {words}"));
    Ok(taken)
}
