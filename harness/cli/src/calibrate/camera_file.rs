//! The calibrated camera as a file of any format.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use calibench_calibrate::Calibration;
use calibench_exchange::OutputFile;
use calibench_exchange::camera::conversion::{ConversionError, Converted, converted};
use calibench_exchange::camera::ending::{as_it_is, by_ending};
use calibench_exchange::camera::fit::losses;
use calibench_exchange::camera::target::{Given, goal};
use calibench_exchange::camera::{CameraFormat, NamedCamera, camera_text};
use calibench_model::camera::TangentialOrder;
use calibench_model::convert::{ConvertError, ConvertOptions, Method};

use super::super::convert::{advise, no_target, size_of};
use crate::failure::Failure;

/// Writes the cameras with their covariances: in the convention asked for, or in the first format that holds them as they are and has the file's ending.
/// Several go into one file if its format holds several, or else into a file each.
pub fn write(output: &OutputFile, calibration: &Calibration<'_>, to: Option<&str>) -> Result<(), Failure> {
    let path = output.path();
    let made = (0..calibration.cameras())
        .map(|camera| made(path, &calibration.named_camera(camera).map_err(Failure::Input)?, to))
        .collect::<Result<Vec<_>, Failure>>()?;
    for (format, result) in &made {
        let whose = if made.len() > 1 { format!("{}: ", result.name) } else { String::new() };
        losses(format, result).iter().for_each(|what| say!("warning: {whose}lost: {what}"));
    }
    if let Some(format) = common(&made) {
        let all: Vec<NamedCamera> = made.into_iter().map(|(_, result)| result).collect();
        let text = camera_text(format, &all).map_err(|error| Failure::input(format!("-o {}: {error}", path.display())))?;
        return Ok(output.write(|file| file.write_all(text.as_bytes()))?);
    }
    if !output.is_file() {
        return Err(Failure::input(format!("-o {}: the format holds one camera a file; expected the name of a file", path.display())));
    }
    let file = |(format, result): (_, NamedCamera)| {
        let own = OutputFile::open(&own(path, &result.name)).map_err(|error| Failure::input(format!("-o {error}")))?;
        let text = camera_text(format, &[NamedCamera { name: String::new(), ..result }]);
        Ok((text.map_err(|error| Failure::input(format!("-o {}: {error}", own.path().display())))?, own))
    };
    // All are possible before the first is written.
    let files = made.into_iter().map(file).collect::<Result<Vec<_>, Failure>>()?;
    for (text, own) in files {
        own.write(|file| file.write_all(text.as_bytes()))?;
        say!("{}: written", own.path().display());
    }
    Ok(())
}

fn made(path: &Path, source: &NamedCamera, to: Option<&str>) -> Result<(&'static CameraFormat, NamedCamera), Failure> {
    match to.or_else(|| by_ending(path, source)) {
        Some(to) => in_convention(source, to, path),
        None => {
            let format = as_it_is(path, source).ok_or_else(|| {
                Failure::input(format!("-o {}: no format holds the camera as it is; name one with --to CONVENTION", path.display()))
            })?;
            Ok((format, source.clone()))
        }
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

/// What to do when the camera does not go into the convention asked for.
fn refused(path: &Path, to: &str, error: &ConversionError) -> Failure {
    match error {
        ConversionError::Convert(error @ ConvertError::Residual { .. }) => Failure::input(format!(
            "-o {}: {to} does not hold the calibrated camera: {error}. Write it as it is (-o with the ending toml or json), name a richer convention with \
             --to, or calibrate in that one with --model",
            path.display()
        )),
        ConversionError::Convert(other) => advise(other),
        other => Failure::input(other.to_string()),
    }
}

fn in_convention(source: &NamedCamera, to: &str, path: &Path) -> Result<(&'static CameraFormat, NamedCamera), Failure> {
    let order = TangentialOrder::OpenCv;
    let given = Given { source, pitch_um: source.pitch_um, base_mm: None, order, output: Some(path) };
    let goal = goal(to, &given).map_err(no_target)?;
    let Converted { camera, conversion, .. } =
        converted(source, &goal, None, None, &ConvertOptions::default()).map_err(|error| refused(path, to, &error))?;
    if conversion.method != Method::Exact {
        say!("{}: converted to {to} by a fit: residuals {}", path.display(), size_of(&conversion.residual));
    }
    Ok((goal.format, camera))
}
