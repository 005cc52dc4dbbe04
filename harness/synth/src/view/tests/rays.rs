//! Images by following rays: nothing is shared with the renderer but the camera model.

use calibench_model::camera::CameraModel;
use calibench_model::{Curve, Outline, PixelPoint, Plate};

use super::View;
use crate::raster::Piece;

/// The mean of `n` x `n` rays for each pixel. Plates are flat, discs whole.
pub fn image(view: &View<'_>, n: usize) -> Vec<f64> {
    let size = view.camera.size();
    let offset = |i: usize| (i as f64 + 0.5) / n as f64 - 0.5;
    let pixels = (0..size.height).flat_map(|y| (0..size.width).map(move |x| (f64::from(x), f64::from(y))));
    let rays = |(x, y): (f64, f64)| {
        let points = (0..n).flat_map(|j| (0..n).map(move |i| (i, j)));
        points.map(|(i, j)| radiance(view, PixelPoint::new(x + offset(i), y + offset(j)))).sum::<f64>() / (n * n) as f64
    };
    pixels.map(rays).collect()
}

fn radiance(view: &View<'_>, at: PixelPoint) -> f64 {
    let direction = view.pose.world_from_ray(view.camera.unproject(view.local.map_or(at, |local| local.undisplaced(at))).unwrap());
    let mut nearest = (f64::INFINITY, view.field.background);
    for plate in &view.field.plates {
        let normal = plate.normal();
        let along = normal.dot(&(plate.origin - view.pose.centre)) / normal.dot(&direction);
        let hit = view.pose.centre + direction * along - plate.origin;
        let (u, v) = (hit.dot(&plate.u), hit.dot(&plate.v));
        let [[u0, v0], [u1, v1]] = plate.corners;
        if along > 0.0 && along < nearest.0 && u > u0 && u < u1 && v > v0 && v < v1 {
            nearest = (along, level(plate, [u, v], normal.dot(&direction) < 0.0));
        }
    }
    nearest.1
}

fn level(plate: &Plate, at: [f64; 2], front: bool) -> f64 {
    let printed = plate.areas.iter().filter(|area| front && holds(&area.outline, at));
    plate.level + printed.map(|area| area.level - area.ground).sum::<f64>()
}

fn holds(outline: &Outline, [u, v]: [f64; 2]) -> bool {
    if let Curve::Arc { centre, radius, .. } = outline.0[0] {
        return (u - centre[0]).hypot(v - centre[1]) < radius;
    }
    let crossed = outline.0.iter().filter(|curve| {
        let (a, b) = (curve.at(0.0), curve.at(1.0));
        (a[1] > v) != (b[1] > v) && u < a[0] + (v - a[1]) * (b[0] - a[0]) / (b[1] - a[1])
    });
    crossed.count() % 2 == 1
}

/// How far `at` is from a piece, px: the least distance to many points, refined.
pub fn distance(piece: &Piece, at: [f64; 2]) -> f64 {
    let [x, y] = piece.polynomial();
    let value = |c: [f64; 5], t: f64| c.iter().rev().fold(0.0, |sum, c| sum * t + c);
    let off = |t: f64| (value(x, t) - at[0]).hypot(value(y, t) - at[1]);
    let mut best = (0..=32).map(|i| f64::from(i) / 32.0).min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap();
    let mut step = 1.0 / 64.0;
    while step > 1e-9 {
        let around = [(best - step).max(0.0), best, (best + step).min(1.0)];
        best = around.into_iter().min_by(|a, b| off(*a).total_cmp(&off(*b))).unwrap();
        step *= 0.7;
    }
    off(best)
}

#[test]
fn the_mean_ray_of_an_empty_view_is_the_background() {
    let field = super::field(Vec::new());
    let (camera, pose) = (super::camera([0.0; 3]), super::pose(0.0, 0.1, 1.0, 0.0));
    assert!(image(&View { field: &field, camera: &camera, local: None, pose: &pose }, 1).iter().all(|grey| *grey == 0.5));
}
