//! Cameras that calibrators answer.

use calibench_cameras::{ReadOptions, parse_camera};
use calibench_model::NamedCamera;
use calibench_model::camera::ImageSize;

/// What the text is called in errors.
const CAMERA: &str = "camera";

/// The camera of a text of any format that is read, of images of this size.
///
/// # Errors
/// In words: the first mistake, another number of cameras than one.
pub fn answered_camera(text: &str, size: ImageSize) -> Result<NamedCamera, String> {
    let options = ReadOptions { size: Some(size), ..ReadOptions::default() };
    let mut cameras = parse_camera(CAMERA, text.as_bytes(), &options).map_err(|error| error.to_string())?.cameras;
    match (cameras.len(), cameras.pop()) {
        (1, Some(camera)) => Ok(camera),
        (count, _) => Err(format!("`camera` holds {count} cameras: expected one")),
    }
}
