//! A camera for a file whose name is given: in the convention asked for, or in the first format that holds it as it is and has the file's ending.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use calibench_model::camera::{Camera, TangentialOrder};
use calibench_model::convert::{Conversion, ConvertOptions, Method};
use thiserror::Error;

use super::conversion::{ConversionError, Converted, converted};
use super::target::{Given, TargetError, goal};
use super::{CameraFormat, FORMATS, NamedCamera, camera_bytes};

/// A camera as a file will hold it.
#[derive(Clone, Debug)]
pub struct FileCamera {
    /// The file's format.
    pub format: &'static CameraFormat,
    /// The camera.
    pub camera: NamedCamera,
    /// The convention and what the conversion cost, where it is a fit.
    pub fitted: Option<(String, Conversion)>,
}

/// Why a camera does not go into a file.
#[derive(Debug, Error)]
pub enum FileCameraError {
    /// No format holds it, and no convention is given.
    #[error("no format holds the camera as it is; name one with --to CONVENTION")]
    NoFormat,
    /// A convention that is none, or needs more than is known.
    #[error(transparent)]
    Target(#[from] TargetError),
    /// The convention does not hold it.
    #[error("{to} does not hold the camera: {error}")]
    Conversion {
        /// The convention.
        to: String,
        /// The reason.
        error: Box<ConversionError>,
    },
}

/// `source` for the file `path`: in the convention `to`, or in the one that the file's ending asks for, or else as it is.
///
/// # Errors
/// An unknown convention, a camera that it does not hold, no format at all.
pub fn for_file(path: &Path, source: &NamedCamera, to: Option<&str>) -> Result<FileCamera, FileCameraError> {
    let Some(to) = to.or_else(|| by_ending(path, source)) else {
        let format = as_it_is(path, source).ok_or(FileCameraError::NoFormat)?;
        return Ok(FileCamera { format, camera: source.clone(), fitted: None });
    };
    let given = Given { source, pitch_um: source.pitch_um, base_mm: None, order: TangentialOrder::OpenCv, output: Some(path) };
    let goal = goal(to, &given)?;
    let Converted { camera, conversion, .. } = converted(source, &goal, None, None, &ConvertOptions::default())
        .map_err(|error| FileCameraError::Conversion { to: to.to_owned(), error: Box::new(error) })?;
    let fitted = (conversion.method != Method::Exact).then(|| (to.to_owned(), conversion));
    Ok(FileCamera { format: goal.format, camera, fitted })
}

/// The format that holds all cameras in one file, if there is one.
pub fn one_file_for(cameras: &[FileCamera]) -> Option<&'static CameraFormat> {
    let format = cameras.first()?.format;
    let same = cameras.iter().all(|other| other.format.name == format.name);
    let all: Vec<NamedCamera> = cameras.iter().map(|file| file.camera.clone()).collect();
    (same && (all.len() == 1 || camera_bytes(format, &all).is_ok())).then_some(format)
}

/// The file of one of several cameras beside the file `path`: `camera-left.yaml` for `camera.yaml`.
pub fn own_file(path: &Path, camera: &str) -> PathBuf {
    let text = |part: Option<&OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let ending = text(path.extension());
    let dot = if ending.is_empty() { "" } else { "." };
    path.with_file_name(format!("{}-{camera}{dot}{ending}", text(path.file_stem())))
}

fn ending(path: &Path) -> Option<String> {
    path.extension().and_then(|ending| ending.to_str()).map(str::to_lowercase)
}

/// The convention that an ending asks for, where no format of that ending holds the camera as it is.
fn by_ending(path: &Path, source: &NamedCamera) -> Option<&'static str> {
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
fn as_it_is(path: &Path, source: &NamedCamera) -> Option<&'static CameraFormat> {
    let spelt = |ending: &str| if ending == "yml" { "yaml".to_owned() } else { ending.to_owned() };
    let ending = ending(path).map(|ending| spelt(&ending));
    let fits = |format: &&&'static CameraFormat| format.is_written() && camera_bytes(format, std::slice::from_ref(source)).is_ok();
    let same = |format: &&&'static CameraFormat| Some(spelt(format.extension)) == ending;
    // OpenCV's YAML is what most tools read; other YAMLs are asked for by name.
    let first = FORMATS.iter().filter(|format| format.name.starts_with("opencv")).chain(FORMATS.iter()).filter(same).find(fits);
    first.or_else(|| FORMATS.iter().find(fits)).copied()
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_model::camera::{ImageSize, OpenCv};

    #[test]
    fn each_of_several_cameras_has_a_name_of_its_own() {
        assert_eq!(own_file(Path::new("out/rig.yaml"), "left"), Path::new("out/rig-left.yaml"));
        assert_eq!(own_file(Path::new("rig"), "left"), Path::new("rig-left"));
    }

    #[test]
    fn a_camera_goes_into_a_file_as_it_is_or_as_asked() {
        let size = ImageSize { width: 640, height: 480 };
        let camera = OpenCv { size, fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, distortion: [0.0; 14], coefficients: 5 };
        let source = NamedCamera::new(String::new(), camera.into());
        let yaml = for_file(Path::new("c.yml"), &source, None).unwrap();
        assert!(yaml.format.name == "opencv-yaml" && yaml.camera.camera == source.camera && yaml.fitted.is_none());
        let xml = for_file(Path::new("c.xml"), &source, Some("metashape")).unwrap();
        assert_eq!(xml.format.name, "metashape");
        assert!(one_file_for(&[yaml, xml]).is_none());
        let error = for_file(Path::new("c.cam"), &source, Some("pix4d")).unwrap_err();
        assert!(matches!(error, FileCameraError::Target(TargetError::NoPitch(_))), "{error}");
    }
}
