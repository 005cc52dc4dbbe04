//! The calibrated camera as a file of any format.

use std::path::Path;

use calibench_calibrate::Calibration;
use calibench_cameras::conversion::ConversionError;
use calibench_cameras::fit::losses;
use calibench_cameras::for_file::{FileCamera, FileCameraError, beside, for_file, one_file_for, own_file};
use calibench_cameras::{camera_bytes, write_camera};
use calibench_files::OutputFile;
use calibench_model::NamedCamera;
use calibench_model::convert::ConvertError;

use super::super::convert::{advise, exact_for, no_target, size_of};
use crate::failure::Failure;

/// Writes the cameras with their covariances: in the convention asked for, or in the first format that holds them as they are and has the file's ending.
/// Several go into one file if its format holds several, or else into a file each. Of a convention that does not hold them they are written beside, as they are.
pub fn write(output: &OutputFile, calibration: &Calibration<'_>, to: Option<&str>) -> Result<(), Failure> {
    let sources = (0..calibration.cameras()).map(|camera| calibration.named_camera(camera).map_err(Failure::Input));
    write_named(output, &sources.collect::<Result<Vec<_>, Failure>>()?, to)
}

/// As [`write`], of cameras as files hold them.
pub fn write_named(output: &OutputFile, sources: &[NamedCamera], to: Option<&str>) -> Result<(), Failure> {
    let path = output.path();
    let made = sources.iter().map(|source| for_file(path, source, to)).collect::<Result<Vec<_>, _>>();
    let made = made.map_err(|error| {
        if output.is_file() {
            sources.iter().for_each(|source| keep(path, source));
        }
        refused(path, error)
    })?;
    for file in &made {
        if let Some(why) = &file.instead {
            say!("{}: {why}; it is written as it is, in the format of {}", path.display(), file.format.tool);
        }
    }
    for file in &made {
        if let Some((to, conversion)) = &file.fitted {
            let residuals = size_of(&conversion.residual);
            say!("{}: converted to {to} by a fit: residuals {residuals}{}", path.display(), exact_for(file.held_exactly));
        }
    }
    for FileCamera { format, camera, .. } in &made {
        let whose = if made.len() > 1 { format!("{}: ", camera.name) } else { String::new() };
        losses(format, camera).iter().for_each(|what| say!("warning: {whose}lost: {what}"));
    }
    if let Some(format) = one_file_for(&made) {
        let all: Vec<NamedCamera> = made.into_iter().map(|file| file.camera).collect();
        let bytes = camera_bytes(format, &all).map_err(|error| Failure::input(format!("-o {}: {error}", path.display())))?;
        return Ok(output.write(|file| file.write_all(&bytes))?);
    }
    if !output.is_file() {
        return Err(Failure::input(format!("-o {}: the format holds one camera a file; expected the name of a file", path.display())));
    }
    let file = |FileCamera { format, camera, .. }: FileCamera| {
        let own = OutputFile::open(&own_file(path, &camera.name)).map_err(|error| Failure::input(format!("-o {error}")))?;
        let bytes = camera_bytes(format, &[NamedCamera { name: String::new(), ..camera }]);
        Ok((bytes.map_err(|error| Failure::input(format!("-o {}: {error}", own.path().display())))?, own))
    };
    // All are possible before the first is written.
    let files = made.into_iter().map(file).collect::<Result<Vec<_>, Failure>>()?;
    for (bytes, own) in files {
        own.write(|file| file.write_all(&bytes))?;
        say!("{}: written", own.path().display());
    }
    Ok(())
}

/// Writes the camera as it is beside the file that does not hold it, where nothing is in the way: what was adjusted is not lost.
fn keep(path: &Path, source: &NamedCamera) {
    let Some((own, FileCamera { format, camera, .. })) = beside(path, source) else { return };
    if own.exists() {
        say!("{}: is there already, so the camera as it was adjusted is not written to it", own.display());
        return;
    }
    let camera = NamedCamera { name: String::new(), ..camera };
    match write_camera(&own, format, &[camera]) {
        Ok(()) => say!("{}: the camera as it was adjusted, in the format of {}", own.display(), format.tool),
        Err(error) => say!("{}: the camera as it was adjusted is not written: {error}", own.display()),
    }
}

/// What to do when the camera does not go into the file.
fn refused(path: &Path, error: FileCameraError) -> Failure {
    match error {
        FileCameraError::NoFormat => Failure::input(format!("-o {}: {error}", path.display())),
        FileCameraError::Target(error) => no_target(error),
        FileCameraError::Conversion { to, error } => match *error {
            ConversionError::Convert(error @ ConvertError::Residual { .. }) => Failure::input(format!(
                "-o {}: {to} does not hold the calibrated camera: {error}. Write it as it is (-o with the ending toml or json), name a richer \
                 convention with --to, or calibrate in that one with --model",
                path.display()
            )),
            ConversionError::Convert(other) => advise(&other),
            other => Failure::input(other.to_string()),
        },
    }
}
