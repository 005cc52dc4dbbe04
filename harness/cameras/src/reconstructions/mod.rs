//! Reconstructions in files of other tools: cameras, oriented images, object points and where the images show them. Found by content; one tool a file.

mod bal;
mod bundler;
mod colmap;
mod colmap_rigs;
mod colmap_written;
mod lens;
mod openmvg;

use std::path::{Path, PathBuf};

use calibench_model::Reconstruction;
use calibench_model::camera::ImageSize;
use calibench_model::named_camera;
use calibench_model::pose::Pose;
use nalgebra::{Matrix3, Point3, Rotation3};

use crate::CameraFileError;
use crate::source;

pub use colmap_written::write_colmap;

/// The largest file that is read, bytes: ten million image points as text.
const LARGEST: u64 = 1 << 30;

/// A reconstruction and whose it is.
#[derive(Clone, Debug, PartialEq)]
pub struct ReconstructionFile {
    /// The tool.
    pub tool: &'static str,
    /// What it says.
    pub reconstruction: Reconstruction,
    /// Cameras that the tool took as mounted rigidly to each other: of each such rig, the indices of its cameras, two or more.
    pub rigs: Vec<Vec<usize>>,
}

/// Reads a problem of Bundle Adjustment in the Large, Bundler's bundle.out, OpenMVG's sfm_data.json, or a folder with COLMAP's cameras, images and
/// points3D (.bin or .txt; one of these files names its folder).
///
/// `size` is that of the images for files that do not state it (the first two). Without it the frame is taken so large that it holds all image points, around the
/// principal point: nothing of the adjustment depends on it.
///
/// # Errors
/// A file that cannot be read, that is of no such tool or that is compressed; the first mistake, with file, line and element; indices that name nothing.
pub fn read_reconstruction(path: &Path, size: Option<ImageSize>) -> Result<ReconstructionFile, CameraFileError> {
    let name = path.display().to_string();
    if let Some(folder) = colmap::folder(path) {
        return colmap::read(&folder, size);
    }
    let in_file = |error: CameraFileError| error.in_file(&name);
    let bytes = source::read_up_to(path, LARGEST).map_err(in_file)?;
    of_bytes(&bytes, size).map_err(in_file)
}

fn of_bytes(bytes: &[u8], size: Option<ImageSize>) -> Result<ReconstructionFile, CameraFileError> {
    for (magic, program) in [(&b"BZh"[..], "bunzip2"), (b"\x1f\x8b", "gunzip"), (b"\xfd7zXZ", "unxz"), (b"PK\x03\x04", "unzip")] {
        if bytes.starts_with(magic) {
            return Err(CameraFileError::new(format!("is compressed; expected a plain file: {program} makes it one")));
        }
    }
    let text = std::str::from_utf8(bytes).map_err(|_| unknown())?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let (tool, reconstruction) = if bal::recognise(text) {
        ("Bundle Adjustment in the Large", bal::read(text, size)?)
    } else if bundler::recognise(text) {
        ("Bundler", bundler::read(text, size)?)
    } else if openmvg::recognise(text) {
        ("OpenMVG", openmvg::read(text)?)
    } else {
        return Err(unknown());
    };
    Ok(ReconstructionFile { tool, reconstruction, rigs: Vec::new() })
}

fn unknown() -> CameraFileError {
    CameraFileError::new(
        "is no reconstruction that is known; expected a problem of Bundle Adjustment in the Large, Bundler's bundle.out, OpenMVG's sfm_data.json, \
         or a folder with COLMAP's cameras, images and points3D",
    )
}

/// The pose with axes x right, y up, z backwards; six printed digits of a rotation are made one again.
fn oriented(pose: &named_camera::Pose) -> Pose {
    let up = pose.with_y_and_z_reversed();
    let mut rotation = Rotation3::from_matrix_unchecked(Matrix3::from_fn(|i, j| up.camera_from_world[i][j]));
    // Newton's steps to the nearest rotation: each squares what is missing.
    (0..3).for_each(|_| {
        let m = *rotation.matrix();
        rotation = Rotation3::from_matrix_unchecked(m * (Matrix3::identity() * 3.0 - m.transpose() * m) * 0.5);
    });
    Pose { rotation: *rotation.matrix(), centre: Point3::from(up.position) }
}

/// The index of what a file calls by this number, or an error that says how many there are.
fn within(what: &str, index: usize, count: usize) -> Result<usize, CameraFileError> {
    let wrong = || CameraFileError::new(format!("{what} {index} is not there; expected 0 to {}", count.saturating_sub(1)));
    if index < count { Ok(index) } else { Err(wrong()) }
}

/// Where a part of a model of COLMAP is, and whether as bytes.
fn place(folder: &Path, name: &str) -> Option<(PathBuf, bool)> {
    let paths = [(format!("{name}.bin"), true), (format!("{name}.txt"), false)];
    paths.iter().map(|(file, is_binary)| (folder.join(file), *is_binary)).find(|(path, _)| path.is_file())
}

fn text_of(bytes: &[u8]) -> Result<&str, CameraFileError> {
    std::str::from_utf8(bytes).map_err(|_| CameraFileError::new("expected text in UTF-8, found other bytes"))
}
