//! The calibrated camera as a file of any format.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use calibench_calibrate::Calibration;
use calibench_exchange::camera::fit::{fit_to_format, losses};
use calibench_exchange::camera::{CameraFormat, FORMATS, NamedCamera, ParameterCovariance, camera_text, write_camera};
use calibench_model::camera::{Camera, TangentialOrder};
use calibench_model::convert::{Conversion, ConvertError, ConvertOptions, Method, convert};

use super::super::Failure;
use super::super::convert::{advise, named, size_of, whole};
use super::super::target::{Given, Way, goal};

/// Writes the cameras with their covariances: in the convention asked for, or in the first format that holds them as they are and has the file's ending.
/// Several go into one file if its format holds several, or else into a file each.
pub fn write(path: &Path, calibration: &Calibration<'_>, to: Option<&str>) -> Result<(), Failure> {
    let made =
        (0..calibration.cameras()).map(|camera| made(path, &source(calibration, camera)?, to)).collect::<Result<Vec<_>, Failure>>()?;
    for (format, result) in &made {
        let whose = if made.len() > 1 { format!("{}: ", result.name) } else { String::new() };
        losses(format, result).iter().for_each(|what| eprintln!("warning: {whose}lost: {what}"));
    }
    if let Some(format) = common(&made) {
        let all: Vec<NamedCamera> = made.into_iter().map(|(_, result)| result).collect();
        return Ok(write_camera(path, format, &all)?);
    }
    for (format, result) in made {
        let own = own(path, &result.name);
        write_camera(&own, format, &[NamedCamera { name: String::new(), ..result }])?;
        eprintln!("{}: written", own.display());
    }
    Ok(())
}

/// A camera of the calibration; the only one needs no name.
fn source(calibration: &Calibration<'_>, camera: usize) -> Result<NamedCamera, Failure> {
    let (names, covariance) = calibration.covariances.of_camera(camera);
    let n = names.len();
    let values = (0..n * n).map(|k| f64::midpoint(covariance[(k / n, k % n)], covariance[(k % n, k / n)])).collect();
    let covariance = ParameterCovariance::new(names.iter().map(|name| (*name).to_owned()).collect(), values).map_err(Failure::Input)?;
    let optics = &calibration.prepared.settings.cameras[camera];
    let name = if calibration.cameras() > 1 { optics.name.as_str() } else { "" };
    Ok(NamedCamera { pitch_um: optics.pitch_um, covariance: Some(covariance), ..NamedCamera::new(name, *calibration.camera(camera)) })
}

fn made(path: &Path, source: &NamedCamera, to: Option<&str>) -> Result<(&'static CameraFormat, NamedCamera), Failure> {
    match to.or_else(|| by_ending(path, source)) {
        Some(to) => converted(source, to, path),
        None => Ok((as_it_is(path, source)?, source.clone())),
    }
}

/// The format that holds all in one file.
fn common(made: &[(&'static CameraFormat, NamedCamera)]) -> Option<&'static CameraFormat> {
    let format = made.first()?.0;
    let same = made.iter().all(|(other, _)| other.name == format.name);
    let all: Vec<NamedCamera> = made.iter().map(|(_, result)| result.clone()).collect();
    (same && (all.len() == 1 || camera_text(format, &all).is_ok())).then_some(format)
}

/// The file of one of several cameras.
fn own(path: &Path, camera: &str) -> PathBuf {
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
fn as_it_is(path: &Path, source: &NamedCamera) -> Result<&'static CameraFormat, Failure> {
    let spelt = |ending: &str| if ending == "yml" { "yaml".to_owned() } else { ending.to_owned() };
    let ending = ending(path).map(|ending| spelt(&ending));
    let fits = |format: &&&'static CameraFormat| format.is_written() && camera_text(format, std::slice::from_ref(source)).is_ok();
    let same = |format: &&&'static CameraFormat| Some(spelt(format.extension)) == ending;
    // OpenCV's YAML is what most tools read; other YAMLs are asked for by name.
    let first = FORMATS.iter().filter(|format| format.name.starts_with("opencv")).chain(FORMATS.iter()).filter(same).find(fits);
    first
        .or_else(|| FORMATS.iter().find(fits))
        .copied()
        .ok_or_else(|| Failure::input(format!("-o {}: no format holds the camera as it is; name one with --to CONVENTION", path.display())))
}

/// What to do when the camera does not go into the convention asked for.
fn refused(path: &Path, to: &str, error: &ConvertError) -> Failure {
    match error {
        ConvertError::Residual { .. } => Failure::input(format!(
            "-o {}: {to} does not hold the calibrated camera: {error}. Write it as it is (-o with the ending toml or json), name a richer convention with \
             --to, or calibrate in that one with --model",
            path.display()
        )),
        other => advise(other),
    }
}

fn converted(source: &NamedCamera, to: &str, path: &Path) -> Result<(&'static CameraFormat, NamedCamera), Failure> {
    let order = TangentialOrder::OpenCv;
    let goal = goal(to, &Given { source, pitch_um: source.pitch_um, base_mm: None, order, output: Some(path) })?;
    let covariance = source.covariance.as_ref().map(|covariance| whole(&source.camera, covariance)).transpose()?;
    let options = ConvertOptions { covariance, ..ConvertOptions::default() };
    let conversion: Conversion = match goal.way {
        Way::One(target) => convert(&source.camera, target, &options).map_err(|error| refused(path, to, &error))?,
        Way::Best => {
            fit_to_format(goal.format, &source.camera, None, source.pitch_um, &options).map_err(|e| Failure::input(e.to_string()))?.0
        }
    };
    if conversion.method != Method::Exact {
        eprintln!("{}: converted to {to} by a fit: residuals {}", path.display(), size_of(&conversion.residual));
    }
    let covariance = conversion.covariance.as_ref().map(|q| named(&conversion.camera, q)).transpose()?;
    Ok((goal.format, NamedCamera { pitch_um: source.pitch_um, covariance, ..NamedCamera::new(source.name.clone(), conversion.camera) }))
}
