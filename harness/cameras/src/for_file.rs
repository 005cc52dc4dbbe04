//! A camera for a file whose name is given: in the convention asked for, or in the first format that holds it as it is and has the file's ending.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use calibench_model::camera::{Camera, TangentialOrder};
use calibench_model::convert::{Conversion, ConvertOptions, Method};
use thiserror::Error;

use super::conversion::{ConversionError, Converted, converted, holds};
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
    /// Of a fit the model, by its name in `calibrate --model`, of which every camera is held exactly, if there is one.
    pub held_exactly: Option<&'static str>,
    /// Why it is not in the convention that the file's ending asks for, but as it is, in the words of what refused it.
    pub instead: Option<String>,
}

impl FileCamera {
    /// `source` in the first format that holds it exactly: with the ending of `path`, or with any.
    fn as_it_is(path: &Path, source: &NamedCamera, instead: Option<String>) -> Option<Self> {
        Some(Self { format: holds_as_it_is(path, source)?, camera: source.clone(), fitted: None, held_exactly: None, instead })
    }
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

/// `source` for the file `path`: in the convention `to`, or in the one that the file's ending asks for, or else, and where that one does not hold it, as it is.
///
/// # Errors
/// An unknown convention, a camera that `to` does not hold, no format at all.
pub fn for_file(path: &Path, source: &NamedCamera, to: Option<&str>) -> Result<FileCamera, FileCameraError> {
    if let Some(to) = to {
        return in_convention(path, source, to);
    }
    let refused = match by_ending(path, source).map(|usual| in_convention(path, source, usual)) {
        Some(Ok(file)) => return Ok(file),
        Some(Err(error)) => Some(error),
        None => None,
    };
    let why = refused.as_ref().map(ToString::to_string);
    FileCamera::as_it_is(path, source, why).ok_or_else(|| refused.unwrap_or(FileCameraError::NoFormat))
}

/// `source` as it is, and a name beside `path` for it: `camera-as-adjusted.toml` for `camera.yaml`. `None` where no format holds it.
pub fn beside(path: &Path, source: &NamedCamera) -> Option<(PathBuf, FileCamera)> {
    let file = FileCamera::as_it_is(path, source, None)?;
    let own = if source.name.is_empty() { "as-adjusted".to_owned() } else { format!("{}-as-adjusted", source.name) };
    Some((own_file(&path.with_extension(file.format.extension), &own), file))
}

/// The format for a camera that is to stay in its convention: that of the file that it was read from, or of the ending of `path` where that asks for another one.
/// `None` where neither gives the camera back as it is.
pub fn kept_format(path: Option<&Path>, read: &'static CameraFormat, source: &NamedCamera) -> Option<&'static CameraFormat> {
    let asked = path.and_then(ending);
    let other = asked.as_ref().is_some_and(|asked| spelt(asked) != spelt(read.extension));
    let by_ending = || holds_as_it_is(path?, source).filter(|format| Some(spelt(format.extension)) == asked.as_deref().map(spelt));
    // Splines are read with another model that is fitted to them.
    let has_splines = |format: &CameraFormat| source.splines.is_some() && format.keeps.splines;
    let gives_back = |&format: &&'static CameraFormat| format.is_written() && (has_splines(format) || holds(format, source));
    let asked_for = if other { by_ending().filter(gives_back) } else { None };
    asked_for.or_else(|| Some(read).filter(gives_back))
}

fn in_convention(path: &Path, source: &NamedCamera, to: &str) -> Result<FileCamera, FileCameraError> {
    let given = Given { source, pitch_um: source.pitch_um, base_mm: None, order: TangentialOrder::OpenCv, output: Some(path) };
    let goal = goal(to, &given)?;
    let Converted { camera, conversion, held_exactly, .. } = converted(source, &goal, None, None, &ConvertOptions::default())
        .map_err(|error| FileCameraError::Conversion { to: to.to_owned(), error: Box::new(error) })?;
    let fitted = (conversion.method != Method::Exact).then(|| (to.to_owned(), conversion));
    Ok(FileCamera { format: goal.format, camera, fitted, held_exactly, instead: None })
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
    let of_opencv = matches!(ending.as_str(), "yaml" | "yml" | "xml" | "npz");
    match source.camera {
        Camera::OpenCv(_) => (ending == "toml" && source.pitch_um.is_some()).then_some("photogrammetric"),
        Camera::Agisoft(_) if ending == "xml" => None,
        // Lenses that picture angles have files of their own; a pinhole camera holds little of them.
        Camera::OpenCvFisheye(_) | Camera::Omni(_) | Camera::Eucm(_) | Camera::DoubleSphere(_) | Camera::Fov(_) => None,
        _ => of_opencv.then_some("opencv5"),
    }
}

/// An ending in one spelling.
fn spelt(ending: &str) -> String {
    if ending == "yml" { "yaml".to_owned() } else { ending.to_owned() }
}

/// The first format that holds the camera exactly: with the file's ending, or with any.
fn holds_as_it_is(path: &Path, source: &NamedCamera) -> Option<&'static CameraFormat> {
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
    use crate::{ReadOptions, parse_camera};
    use calibench_model::camera::{DoubleSphere, Eucm, Fov, ImageSize, Omni, OpenCv, OpenCvFisheye, PrismFisheye};

    #[test]
    fn each_of_several_cameras_has_a_name_of_its_own() {
        assert_eq!(own_file(Path::new("out/rig.yaml"), "left"), Path::new("out/rig-left.yaml"));
        assert_eq!(own_file(Path::new("rig"), "left"), Path::new("rig-left"));
    }

    /// Every model that is calibrated, strongly distorted, goes into a file of any ending, and comes back as it was.
    #[test]
    fn no_camera_is_without_a_file() {
        let size = ImageSize { width: 1280, height: 960 };
        let (fx, fy, cx, cy) = (300.0, 301.0, 640.0, 480.0);
        let cameras: [Camera; 6] = [
            Omni { size, fx: 900.0, fy, cx, cy, xi: 1.4, k: [-0.3, 0.1], p: [1e-3, -1e-3] }.into(),
            Eucm { size, fx, fy, cx, cy, alpha: 0.65, beta: 1.1 }.into(),
            DoubleSphere { size, fx, fy, cx, cy, xi: -0.2, alpha: 0.6 }.into(),
            Fov { size, fx, fy, cx, cy, w: 0.95 }.into(),
            OpenCvFisheye { size, fx, fy, cx, cy, skew: 0.0, k: [-0.02, 0.003, 0.0, 0.0] }.into(),
            PrismFisheye { size, fx, fy, cx, cy, k: [-0.02, 0.003, 0.0, 0.0], p: [1e-4, 2e-4], s: [1e-5, 2e-5] }.into(),
        ];
        for (camera, name) in cameras.iter().flat_map(|camera| ["c.yaml", "c.yml", "c.xml", "c.json", "c.toml"].map(|name| (camera, name)))
        {
            let source = NamedCamera::new(String::new(), *camera);
            let file = for_file(Path::new(name), &source, None).unwrap_or_else(|error| panic!("{name}: {camera:?}: {error}"));
            assert!(file.camera.camera == *camera && file.fitted.is_none(), "{name}: {file:?}");
            let options = ReadOptions::of_written(file.format, size);
            let read = parse_camera(name, &camera_bytes(file.format, &[file.camera]).unwrap(), &options).unwrap();
            assert_eq!(read.cameras[0].camera, *camera, "{name}, {}", file.format.name);
            assert!(file.instead.is_some() == matches!((camera, name), (Camera::PrismFisheye(_), "c.yaml" | "c.yml" | "c.xml")), "{name}");
        }
    }

    #[test]
    fn what_a_convention_refuses_has_a_place_beside() {
        let size = ImageSize { width: 1280, height: 960 };
        let fov = Fov { size, fx: 300.0, fy: 301.0, cx: 640.0, cy: 480.0, w: 0.95 };
        let source = NamedCamera::new("left", fov.into());
        assert!(for_file(Path::new("out/c.yml"), &source, Some("opencv5")).is_err());
        let (path, file) = beside(Path::new("out/c.yml"), &source).unwrap();
        assert_eq!((path.as_path(), file.format.name), (Path::new("out/c-left-as-adjusted.yaml"), "kalibr"));
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
