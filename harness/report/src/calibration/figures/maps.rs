//! Maps over the frame: where image points are, and how far distortion moves them.

use calibench_calibrate::Calibration;
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, ImageSize};
use calibench_model::convert::without_distortion;

use super::OfCamera;
use crate::field::rgb;
use crate::plain;
use crate::plot::{Figure, Plot, Said};

/// Cells along the longer side of the map of image points.
const CELLS: usize = 12;
/// A part of the scale of shades that leaves the numbers readable.
const PALE: f64 = 0.4;
/// Columns of the map of distortion.
const COLUMNS: usize = 36;

/// Corners of a cell of a grid over the frame, px.
pub(super) fn cell(size: ImageSize, (column, row): (usize, usize), (columns, rows): (usize, usize)) -> [(f64, f64); 2] {
    let at = |i: usize, n: usize, length: u32| i as f64 / n as f64 * f64::from(length) - 0.5;
    [(0, 0), (1, 1)].map(|(c, r)| (at(column + c, columns, size.width), at(row + r, rows, size.height)))
}

/// Columns and rows of a grid over the frame, and the number of image points in each of its cells, row by row.
fn counts(calibration: &Calibration<'_>, camera: usize) -> ((usize, usize), Vec<u32>) {
    let size = calibration.camera(camera).size();
    let side = f64::from(size.width.max(size.height)) / CELLS as f64;
    let [columns, rows] = [size.width, size.height].map(|length| ((f64::from(length) / side).round() as usize).max(1));
    let mut counts = vec![0_u32; columns * rows];
    for at in points(calibration, camera).map(PixelPoint::to_corner) {
        let cell = |value: f64, length: u32, n: usize| ((value / f64::from(length) * n as f64).max(0.0) as usize).min(n - 1);
        counts[cell(at.y, size.height, rows) * columns + cell(at.x, size.width, columns)] += 1;
    }
    ((columns, rows), counts)
}

fn points<'c>(calibration: &'c Calibration<'_>, camera: usize) -> impl Iterator<Item = PixelPoint> + 'c {
    let all = calibration.prepared.network.observations.iter();
    all.filter(move |observation| calibration.owner(observation.image) == camera).map(|observation| observation.position)
}

/// Where image points are, and how many in each cell of the frame.
pub(super) fn distribution(of: &OfCamera<'_, '_>) -> Figure {
    let OfCamera { calibration, camera, .. } = *of;
    let (size, (grid, counts)) = (calibration.camera(camera).size(), counts(calibration, camera));
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let mut plot = Plot::frame(&of.name("distribution"), "Image points over the frame", size);
    plot.series(1, None, &["image points"]);
    let cells = || counts.iter().enumerate().map(|(index, count)| (cell(size, (index % grid.0, index / grid.0), grid), *count));
    for (corners, count) in cells() {
        let fill = (count > 0).then(|| rgb(PALE * f64::from(count) / f64::from(most)));
        plot.cell(corners, fill, &Said::of([count.to_string()]));
    }
    plot.dots(points(calibration, camera).map(|at| (at.x, at.y)).collect());
    for (corners, count) in cells() {
        plot.note(((corners[0].0 + corners[1].0) / 2.0, (corners[0].1 + corners[1].1) / 2.0), &count.to_string(), count > 0);
    }
    let empty = counts.iter().filter(|count| **count == 0).count();
    let remark = format!("{} points; {empty} of {} cells are empty", counts.iter().sum::<u32>(), counts.len());
    let caption = "Where the image points lie in the frame: their number in each cell. Empty cells are extrapolation.";
    of.figure("distribution", (caption, remark), plot)
}

/// How far distortion moves points of the frame, from where the same camera without it pictures their rays.
pub(super) fn distortion(of: &OfCamera<'_, '_>) -> Option<Figure> {
    let camera = of.calibration.camera(of.camera);
    let (size, ideal) = (camera.size(), without_distortion(camera)?);
    let rows = (COLUMNS as f64 * f64::from(size.height) / f64::from(size.width)).round().max(3.0) as usize;
    let moved = |k: usize| {
        let [(ax, ay), (bx, by)] = cell(size, (k % COLUMNS, k / COLUMNS), (COLUMNS, rows));
        let at = PixelPoint::new((ax + bx) / 2.0, (ay + by) / 2.0);
        let from = ideal.project(camera.unproject(at).ok()?).ok()?;
        Some((at, from, (at.x - from.x).hypot(at.y - from.y)))
    };
    let all: Vec<Option<(PixelPoint, PixelPoint, f64)>> = (0..COLUMNS * rows).map(moved).collect();
    let most = all.iter().flatten().map(|(.., length)| *length).fold(0.0, f64::max);
    let top = if most > 1e-12 { most } else { 1.0 };
    let mut plot = Plot::frame(&of.name("distortion"), "Distortion over the frame", size);
    plot.series(1, None, &["x, px", "y, px", "distortion, px", "dx, px", "dy, px"]);
    for (k, (at, from, length)) in all.iter().enumerate().filter_map(|(k, found)| Some((k, (*found)?))) {
        let said = [at.x, at.y].map(|value| format!("{value:.0}")).into_iter().chain([length, at.x - from.x, at.y - from.y].map(plain));
        plot.cell(cell(size, (k % COLUMNS, k / COLUMNS), (COLUMNS, rows)), Some(rgb(length / top)), &Said::of(said));
    }
    let times = crate::field::stretch(f64::from(size.width) / 14.0, top);
    plot.series(7, None, &[""]);
    for (at, from, _) in
        all.iter().enumerate().filter(|(k, _)| k % COLUMNS % 3 == 1 && k / COLUMNS % 3 == 1).filter_map(|(_, found)| *found)
    {
        plot.arrow(from, ((at.x - from.x) * times, (at.y - from.y) * times), &Said::default());
    }
    plot.shades_to("px", top);
    let caption = "How far distortion moves points, from where the same camera without it pictures their rays to where they are. White: no such place.";
    let remark = format!("arrows {times} times their length; at most {} px", plain(most));
    Some(of.figure("distortion", (caption, remark), plot))
}
