//! Files of measured points and cameras, with a word on standard error about what is left out of them.

use std::path::Path;

use calibench_cameras::{CameraList, ReadOptions, read_camera_with};
use calibench_exchange::PointFile;
use calibench_exchange::points::{Check, read_points_checked};
use calibench_model::camera::{Camera, ImageSize};
use calibench_model::{NamedCamera, Points};

use crate::failure::Failure;
use crate::same_camera::for_images;

/// The rows of a point file that have a position, with a word about the others.
pub fn read_measured(path: &Path) -> Result<Points, Failure> {
    Ok(measured(path)?.points)
}

/// The same, with the rows of points that a method could not measure.
pub fn measured(path: &Path) -> Result<PointFile, Failure> {
    checked(path, &|_| Ok(()))
}

/// The same, of rows that pass `check`.
pub fn checked(path: &Path, check: Check<'_>) -> Result<PointFile, Failure> {
    let file = read_points_checked(path, check)?;
    if !file.lost.is_empty() {
        say!("{}: {} rows without a position (rejected or unavailable) are no points", path.display(), file.lost.len());
    }
    if file.points.is_empty() {
        return Err(Failure::input(format!("{}: no row has a position", path.display())));
    }
    Ok(file)
}

/// The first camera of a file for images of `size`, of another size where `is_same` says that it is the same camera; where their size is not known, of images of the size
/// that the file states.
pub fn camera_for(path: &Path, size: Option<ImageSize>, is_same: bool) -> Result<Camera, Failure> {
    let named = first(path, &ReadOptions { size, other_size: true, ..ReadOptions::default() })?;
    Ok(size.map_or_else(|| Ok(named.clone()), |size| for_images(path, &named, size, is_same))?.camera)
}

/// The first camera of a file; of splines, for those who do not take these as they are, another camera is to be near them.
pub fn first(path: &Path, options: &ReadOptions) -> Result<NamedCamera, Failure> {
    let (cameras, count) = match CameraList::open(path, options)? {
        Some(list) => (list.pieces(1)?.next().transpose()?.unwrap_or_default(), list.len()),
        None => {
            let file = read_camera_with(path, options)?;
            let count = file.cameras.len();
            (file.cameras, count)
        }
    };
    if count > 1 {
        say!("{}: the first of {count} cameras", path.display());
    }
    let first = cameras.into_iter().next().ok_or_else(|| Failure::input(format!("{}: holds no camera", path.display())))?;
    match first.doubt().filter(|_| !options.splines_alone) {
        Some(doubt) => Err(Failure::input(format!("{}: {doubt}", path.display()))),
        None => Ok(first),
    }
}
