//! Which format a file of a camera is, from its name.

use std::path::Path;

use calibench_model::camera::Camera;

use super::{CameraFormat, FORMATS, NamedCamera, camera_text};

fn ending(path: &Path) -> Option<String> {
    path.extension().and_then(|ending| ending.to_str()).map(str::to_lowercase)
}

/// The convention that an ending asks for, where no format of that ending holds the camera as it is.
pub fn by_ending(path: &Path, source: &NamedCamera) -> Option<&'static str> {
    let ending = ending(path)?;
    let of_opencv = matches!(ending.as_str(), "yaml" | "yml" | "xml");
    match source.camera {
        Camera::OpenCv(_) => (ending == "toml" && source.pitch_um.is_some()).then_some("photogrammetric"),
        Camera::OpenCvFisheye(_) => None,
        Camera::Agisoft(_) if ending == "xml" => None,
        _ => of_opencv.then_some("opencv5"),
    }
}

/// The first format that holds the camera exactly: with the file's ending, or with any.
pub fn as_it_is(path: &Path, source: &NamedCamera) -> Option<&'static CameraFormat> {
    let spelt = |ending: &str| if ending == "yml" { "yaml".to_owned() } else { ending.to_owned() };
    let ending = ending(path).map(|ending| spelt(&ending));
    let fits = |format: &&&'static CameraFormat| format.is_written() && camera_text(format, std::slice::from_ref(source)).is_ok();
    let same = |format: &&&'static CameraFormat| Some(spelt(format.extension)) == ending;
    // OpenCV's YAML is what most tools read; other YAMLs are asked for by name.
    let first = FORMATS.iter().filter(|format| format.name.starts_with("opencv")).chain(FORMATS.iter()).filter(same).find(fits);
    first.or_else(|| FORMATS.iter().find(fits)).copied()
}
