//! Camera files of other tools, and our own: one file a format, found by content.
//!
//! A new format is one file in [`formats`] with a `static` [`CameraFormat`], and its two lines there.

mod agisoft;
mod behind;
mod brown;
mod colmap_images;
mod colmap_models;
pub mod conversion;
mod encoding;
mod error;
pub mod fit;
pub mod for_file;
mod format;
pub mod formats;
mod ids;
pub mod joined;
mod json;
mod kalibr_target;
mod keys;
mod lists;
mod little_endian;
mod npy;
mod npy_beside;
mod number;
mod numbering;
pub mod open_points;
mod opencv;
mod opencv_model;
mod opencv_names;
mod opencv_storage;
mod photogrammetric_toml;
mod pose;
mod published;
mod reality_scan;
mod recognised;
pub mod reconstructions;
pub mod rig_files;
mod source;
mod splined;
mod splines;
pub mod target;
mod toml_tree;
mod tree;
mod unknown;
mod words;
mod xml;

use std::path::Path;

use calibench_files::atomic::write_atomically;
use calibench_model::camera::{CameraModel, ImageSize};
use calibench_model::named_camera::{NamedCamera, ParameterCovariance, Pose, PoseFrame, Splines};

pub use error::CameraFileError;
pub use format::{CameraFormat, Keeps, KeptCovariance, KeptPose, Model};
pub use formats::{FORMATS, format_named};
pub use kalibr_target::{kalibr_target, read_kalibr_target};
pub use lists::{CameraList, ListWriter, Pieces, inputs_of};
pub use published::{first_camera, published_camera};
pub use source::LARGEST_FILE;
use source::Source;
pub use splines::of_splines;

/// What a camera file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct CameraFile {
    /// Its format.
    pub format: &'static CameraFormat,
    /// Its cameras, in the file's order; at least one.
    pub cameras: Vec<NamedCamera>,
}

/// What a file says of all its cameras goes with each.
fn noted(mut cameras: Vec<NamedCamera>, notes: &[String]) -> Vec<NamedCamera> {
    cameras.iter_mut().for_each(|camera| camera.notes.extend(notes.iter().cloned()));
    cameras
}

/// A family of distortion models that a file may not name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lens {
    /// Brown's polynomials.
    Brown,
    /// The division model.
    Division,
}

/// What a file may leave open.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReadOptions {
    /// Size of the images, for files that do not state it; one that contradicts the file is an error, unless [`Self::other_size`] says otherwise.
    pub size: Option<ImageSize>,
    /// OpenCV's fisheye camera (true) or its pinhole camera (false), for files that do not say `fisheye_model`: without both, the pinhole.
    pub fisheye: Option<bool>,
    /// The lens of RealityScan's CSV, which does not say it; where another lens would be another camera, one is needed.
    pub lens: Option<Lens>,
    /// The format, where more than one recognises the file; one that does not is an error.
    pub from: Option<&'static CameraFormat>,
    /// Keys that are left out although they may make the camera another one.
    pub ignore: Vec<String>,
    /// A file may state another size than [`Self::size`]: its own holds.
    pub other_size: bool,
    /// Splines are taken as they are, as [`NamedCamera::splined`] has them: no camera of another model is fitted, which takes seconds.
    pub splines_alone: bool,
    /// The name of the camera matrix, in files of matrices under names of one's own.
    pub matrix: Option<String>,
    /// The name of its coefficients of distortion, or `none` for a camera without; of a matrix in a .npy that file's beside it.
    pub distortion: Option<String>,
}

impl ReadOptions {
    /// What reads again a file that was written in `format` of a camera of `size`.
    pub fn of_written(format: &CameraFormat, size: ImageSize) -> Self {
        let (size, lens) = ((!format.states_size).then_some(size), format.lens_is_open.then_some(Lens::Brown));
        Self { size, lens, splines_alone: true, ..Self::default() }
    }

    /// The size that the file states, or else the one given.
    fn size_or(&self, stated: Option<ImageSize>) -> Result<ImageSize, CameraFileError> {
        match (stated, self.size) {
            (Some(file), Some(given)) if file != given && !self.other_size => Err(CameraFileError::new(format!(
                "the file says {} x {} px, {} x {} px were given",
                file.width, file.height, given.width, given.height
            ))),
            (Some(size), _) | (None, Some(size)) => Ok(size),
            (None, None) => Err(CameraFileError::new("does not state the size of the images; give it")),
        }
    }
}

/// Reads a camera file; the format is found by content.
///
/// # Errors
/// The first mistake, with file, line and element; for an unknown format what the file looks like, with the two nearest formats and why they said no; several formats that read different cameras
/// (by more than 1e-6 px in the frame).
pub fn read_camera(path: &Path) -> Result<CameraFile, CameraFileError> {
    read_camera_with(path, &ReadOptions::default())
}

/// As [`read_camera`], with what the file leaves open. COLMAP's list of images is read with its list of cameras beside it: a camera an image, with its pose;
/// a camera matrix in a .npy with its coefficients in the .npy beside it that `options` names.
///
/// # Errors
/// As [`read_camera`].
pub fn read_camera_with(path: &Path, options: &ReadOptions) -> Result<CameraFile, CameraFileError> {
    let name = path.display().to_string();
    let bytes = source::read(path).map_err(|error| error.in_file(&name))?;
    if colmap_images::are_images(&bytes) {
        return colmap_images::read(path, &bytes, options);
    }
    if let Some(numpy) = format_named("numpy").filter(|_| npy::is_array(&bytes)) {
        return npy_beside::read(path, &bytes, options, numpy);
    }
    parse_camera(&name, &bytes, options)
}

/// As [`read_camera_with`], from bytes; `file` is their name in errors.
///
/// # Errors
/// As [`read_camera`].
pub fn parse_camera(file: &str, bytes: &[u8], options: &ReadOptions) -> Result<CameraFile, CameraFileError> {
    if colmap_images::are_images(bytes) {
        return Err(colmap_images::without_cameras().in_file(file));
    }
    parse(bytes, options).map_err(|error| error.in_file(file))
}

fn parse(bytes: &[u8], options: &ReadOptions) -> Result<CameraFile, CameraFileError> {
    let no_text = |why| recognised::binary(FORMATS, bytes, options).unwrap_or_else(|| Err(unknown::bytes(bytes).unwrap_or(why)));
    match encoding::in_utf8(bytes) {
        Ok(text) => match Source::new(&text) {
            Ok(source) => recognised::cameras(FORMATS, &source, options),
            Err(why) => no_text(why),
        },
        Err(why) => no_text(why),
    }
}

/// The text of a camera file: [`camera_bytes`] of a format whose files are text.
///
/// # Errors
/// As [`camera_bytes`], and a format whose files are no text.
pub fn camera_text(format: &CameraFormat, cameras: &[NamedCamera]) -> Result<String, CameraFileError> {
    let no_text = || CameraFileError::new(format!("the files of {} are no text", format.name));
    if format.binary.is_some() {
        return Err(no_text());
    }
    String::from_utf8(camera_bytes(format, cameras)?).map_err(|_| no_text())
}

/// Cameras of a long list that are read again at a time, to see that they can be.
const READ_AT_A_TIME: usize = 10_000;

/// The bytes of a camera file. In text, numbers have 17 significant digits or their shortest exact form.
///
/// # Errors
/// A format that is only read, a camera of another model, more cameras than the format holds, a number that is not finite, and whatever else [`parse_camera`] would refuse.
pub fn camera_bytes(format: &CameraFormat, cameras: &[NamedCamera]) -> Result<Vec<u8>, CameraFileError> {
    if !format.is_written() {
        return Err(CameraFileError::new(format!("{} is only read, not written", format.name)));
    }
    if cameras.is_empty() {
        return Err(CameraFileError::new("no camera to write"));
    }
    if cameras.len() > 1 && !format.many {
        return Err(CameraFileError::new(format!("{} holds one camera, found {}", format.name, cameras.len())));
    }
    let options = checked_for(format, cameras)?;
    // Parts of a long list are lists too, and take less memory to be read again.
    if cameras.len() > READ_AT_A_TIME {
        for part in cameras.chunks(READ_AT_A_TIME) {
            is_readable(format, &written(format, part)?, &options)?;
        }
        return written(format, cameras);
    }
    let bytes = written(format, cameras)?;
    is_readable(format, &bytes, &options)?;
    Ok(bytes)
}

/// What reads cameras of finite numbers again from a file of `format`.
fn checked_for(format: &CameraFormat, cameras: &[NamedCamera]) -> Result<ReadOptions, CameraFileError> {
    cameras.iter().try_for_each(check)?;
    let first = cameras.first().ok_or_else(|| CameraFileError::new("no camera to write"))?;
    Ok(ReadOptions::of_written(format, first.camera.size()))
}

/// What was written can be read.
fn is_readable(format: &CameraFormat, bytes: &[u8], options: &ReadOptions) -> Result<(), CameraFileError> {
    parse(bytes, options).map(drop).map_err(|error| {
        let problem = format!("cannot be written as {}: {}", format.name, error.problem);
        CameraFileError { element: error.element, ..CameraFileError::new(problem) }
    })
}

fn written(format: &CameraFormat, cameras: &[NamedCamera]) -> Result<Vec<u8>, CameraFileError> {
    match (&format.binary, format.write) {
        (Some(binary), _) => (binary.write)(cameras),
        (None, Some(write)) => write(cameras).map(String::into_bytes),
        (None, None) => Ok(Vec::new()),
    }
}

/// Numbers that no file holds.
fn check(camera: &NamedCamera) -> Result<(), CameraFileError> {
    if let Some(wrong) = camera.camera.parameters().iter().find(|parameter| !parameter.value.is_finite()) {
        return Err(CameraFileError::new(format!("is {}; expected a finite number", wrong.value)).of(wrong.name));
    }
    Ok(())
}

/// Writes a camera file, whole or not at all: [`camera_bytes`].
///
/// # Errors
/// As [`camera_bytes`], and what the file system refuses.
pub fn write_camera(path: &Path, format: &CameraFormat, cameras: &[NamedCamera]) -> Result<(), CameraFileError> {
    let name = path.display().to_string();
    let bytes = camera_bytes(format, cameras).map_err(|error| error.in_file(&name))?;
    write_atomically(path, |file| file.write_all(&bytes)).map_err(|error: std::io::Error| CameraFileError::new(error.to_string()))
}

/// The example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

#[cfg(test)]
mod tests;
