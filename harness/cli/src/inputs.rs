//! Files of measured points and cameras, with a word on standard error about what is left out of them.

use std::path::Path;

use calibench_cameras::{CameraList, ReadOptions, read_camera_with};
use calibench_exchange::PointFile;
use calibench_exchange::points::{Check, read_points_checked};
use calibench_model::Points;
use calibench_model::camera::{Camera, ImageSize};

use crate::failure::Failure;

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

/// The first camera of a file.
pub fn camera(path: &Path, size: Option<ImageSize>) -> Result<Camera, Failure> {
    let options = ReadOptions { size, ..ReadOptions::default() };
    let (cameras, count) = match CameraList::open(path, &options)? {
        Some(list) => (list.pieces(1)?.next().transpose()?.unwrap_or_default(), list.len()),
        None => {
            let file = read_camera_with(path, &options)?;
            let count = file.cameras.len();
            (file.cameras, count)
        }
    };
    if count > 1 {
        say!("{}: the first of {count} cameras", path.display());
    }
    let first = cameras.first().ok_or_else(|| Failure::input(format!("{}: holds no camera", path.display())))?;
    if let Some(doubt) = first.doubt() {
        return Err(Failure::input(format!("{}: {doubt}", path.display())));
    }
    Ok(first.camera)
}
