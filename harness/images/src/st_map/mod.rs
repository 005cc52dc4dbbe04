//! ST-maps: for each pixel of a picture the place in another where it comes from, as compositing programs warp images.

mod check;
mod file;
mod picture;

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, ImageSize, NoCounterpart};
use rayon::prelude::*;
use thiserror::Error;

pub use check::{Check, Pinhole, check};
pub use file::{MapFile, encode, read};
pub use picture::{Overscan, Undistorted};

/// Which way a map leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// A map of the undistorted picture's pixels, with places in the camera's frame.
    Undistort,
    /// A map of the frame's pixels, with places in the undistorted picture.
    Redistort,
}

/// A map that cannot be made, written or read.
#[derive(Debug, Error)]
pub enum StMapError {
    /// Rays that no plane holds.
    #[error(
        "the camera sees {angle:.1}\u{b0} off its axis; an undistorted picture of all that is {sides} times as large as the frame or has no end: \
         expected --overscan PERCENT, which cuts it off"
    )]
    TooWide {
        /// Largest angle from the axis, degrees.
        angle: f64,
        /// The most that is allowed.
        sides: u32,
    },
    /// No ray, no picture.
    #[error("the camera has no ray along its axis: {0}")]
    NoAxis(#[from] NoCounterpart),
    /// A size that no file holds.
    #[error("the undistorted picture would be {width} x {height} px; expected at most {most} a side")]
    TooLarge {
        /// Columns.
        width: u64,
        /// Rows.
        height: u64,
        /// The most.
        most: u32,
    },
    /// A file of another size.
    #[error("{file}: is {found} px, the map of the camera {expected} px; {help}")]
    Size {
        /// The file.
        file: String,
        /// Columns x rows of the file.
        found: String,
        /// Columns x rows of the camera's.
        expected: String,
        /// What to do.
        help: &'static str,
    },
    /// A file whose places are none of the camera's.
    #[error("{file}: holds too few places that the camera pictures ({found}); expected an ST-map of it, with s in red and t in green")]
    NoPlaces {
        /// The file.
        file: String,
        /// How many pixels.
        found: usize,
    },
    /// An image file.
    #[error("{0}")]
    File(String),
}

/// A map: rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct StMap {
    /// Its own size.
    pub size: ImageSize,
    /// Size of the picture in which its places are.
    pub source: ImageSize,
    /// `size.width` x `size.height`, row by row.
    pub pixels: Vec<Pixel>,
}

/// What a map says of a pixel: s, t, and 1 where that lies in the source, else 0. Both from 0 to 1 from outer edge to outer edge: s from the left, t from the bottom or
/// the top. (-1, -1) where there is no counterpart at all.
pub type Pixel = [f32; 3];

/// A place in a picture as s and t from the top.
fn fraction(at: PixelPoint, size: ImageSize) -> [f64; 2] {
    let corner = at.to_corner();
    [corner.x / f64::from(size.width), corner.y / f64::from(size.height)]
}

/// The pixel of a place from the top.
fn pixel(at: Option<PixelPoint>, source: ImageSize, from_top: bool) -> Pixel {
    let Some(at) = at.filter(|at| at.is_finite()) else { return [-1.0, -1.0, 0.0] };
    let [s, t] = fraction(at, source);
    let inside = (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t);
    let t = if from_top { t } else { 1.0 - t };
    [s as f32, t as f32, f32::from(u8::from(inside))]
}

/// The place in the source for a pixel of the map.
fn counterpart(camera: &Camera, picture: &Undistorted, direction: Direction, at: PixelPoint) -> Option<PixelPoint> {
    match direction {
        Direction::Undistort => camera.project(picture.ray(at)).ok(),
        Direction::Redistort => picture.image(camera.unproject(at).ok()?),
    }
}

impl StMap {
    /// The map of a camera for one of its undistorted pictures; `from_top`: t is 0 at the top, as OpenCV counts, not at the bottom.
    pub fn new(camera: &Camera, picture: &Undistorted, direction: Direction, from_top: bool) -> Self {
        let (size, source) = match direction {
            Direction::Undistort => (picture.size, camera.size()),
            Direction::Redistort => (camera.size(), picture.size),
        };
        let mut pixels = vec![[0.0; 3]; size.width as usize * size.height as usize];
        pixels.par_chunks_mut(size.width as usize).enumerate().for_each(|(row, line)| {
            for (column, value) in line.iter_mut().enumerate() {
                let at = PixelPoint::new(column as f64, row as f64);
                *value = pixel(counterpart(camera, picture, direction, at), source, from_top);
            }
        });
        Self { size, source, pixels }
    }

    /// The share of its pixels that lie in the source.
    pub fn covered(&self) -> f64 {
        let inside = self.pixels.iter().filter(|pixel| pixel[2] > 0.0).count();
        inside as f64 / self.pixels.len() as f64
    }
}

#[cfg(test)]
mod tests;
