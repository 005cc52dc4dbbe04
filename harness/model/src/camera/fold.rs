//! Where a camera stops being one to one.

use super::{CameraModel, NoCounterpart, Ray};
use crate::PixelPoint;

/// Directions in which the edge of the fold is looked for.
const DIRECTIONS: usize = 1440;
/// Columns and rows of the grid whose points are counted.
const GRID: (usize, usize) = (120, 80);

/// A fold inside the frame: beyond it, no pixel has one ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// Smallest distance of the fold from the image of the axis, px.
    pub radius_px: f64,
    /// Share of the frame that lies beyond it, 0 to 1, from a grid of 120 x 80 points.
    pub share: f64,
}

/// The fold of `camera` inside its frame (the outer corners of the pixels), if it has one. A camera with a fold cannot give truth for the full frame.
///
/// The radius is that of the nearest of 1440 directions, each located to the last bits.
pub fn fold(camera: &dyn CameraModel) -> Option<Fold> {
    let centre = camera.project(Ray::from_tangent(0.0, 0.0)).ok()?;
    let (width, height) = (f64::from(camera.size().width), f64::from(camera.size().height));
    let inside = |point: &PixelPoint| {
        let corner = point.to_corner();
        (0.0..=width).contains(&corner.x) && (0.0..=height).contains(&corner.y)
    };
    let angles = (0..DIRECTIONS).map(|i| std::f64::consts::TAU * i as f64 / DIRECTIONS as f64);
    let corners = [(0.0, 0.0), (width, 0.0), (0.0, height), (width, height)];
    let to_corners = corners.map(|(x, y)| (y - centre.to_corner().y).atan2(x - centre.to_corner().x));
    let edge = angles.chain(to_corners).filter_map(|angle| camera.fold_towards(angle)).filter(inside);
    let radius_px = edge.map(|point| point.distance(centre)).min_by(f64::total_cmp)?;
    Some(Fold { radius_px, share: share(camera) })
}

fn share(camera: &dyn CameraModel) -> f64 {
    let size = camera.size();
    let (columns, rows) = GRID;
    let place = |index: usize, count: usize, length: u32| f64::from(length - 1) * index as f64 / (count - 1) as f64;
    let points =
        (0..columns * rows).map(|i| PixelPoint::new(place(i % columns, columns, size.width), place(i / columns, rows, size.height)));
    let folded = points.filter(|&point| matches!(camera.unproject(point), Err(NoCounterpart::Fold))).count();
    folded as f64 / (columns * rows) as f64
}
