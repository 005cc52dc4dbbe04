//! How the image points are distributed over the frame.

use calibench_calibrate::Calibration;
use calibench_model::camera::CameraModel;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::Canvas;
use crate::field::{BOTTOM, LEFT, TOP, shade, write};
use crate::frame::Map;

/// Cells along the longer side.
const CELLS: usize = 12;
/// A part of the scale of colours that leaves the numbers readable.
const PALE: f64 = 0.4;

/// Columns and rows of a grid over the frame, and the number of image points in each of its cells, row by row.
pub(in super::super) fn counts(calibration: &Calibration<'_>, camera: usize) -> ([usize; 2], Vec<u32>) {
    let size = calibration.camera(camera).size();
    let side = f64::from(size.width.max(size.height)) / CELLS as f64;
    let grid = [size.width, size.height].map(|length| ((f64::from(length) / side).round() as usize).max(1));
    let mut counts = vec![0_u32; grid[0] * grid[1]];
    for observation in observations(calibration, camera) {
        let at = observation.position.to_corner();
        let cell = |value: f64, length: u32, n: usize| ((value / f64::from(length) * n as f64).max(0.0) as usize).min(n - 1);
        counts[cell(at.y, size.height, grid[1]) * grid[0] + cell(at.x, size.width, grid[0])] += 1;
    }
    (grid, counts)
}

fn observations<'c>(calibration: &'c Calibration<'_>, camera: usize) -> impl Iterator<Item = &'c calibench_adjust::ImageObservation> {
    let all = calibration.prepared.network.observations.iter();
    all.filter(move |observation| calibration.owner(observation.image) == camera)
}

/// The points and their number in each cell of the frame.
pub(super) fn picture(calibration: &Calibration<'_>, camera: usize) -> Canvas {
    let (size, (grid, counts)) = (calibration.camera(camera).size(), counts(calibration, camera));
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let (map, mut canvas) = Map::alone(size, "Image points over the frame");
    canvas.paint(|area| {
        for (index, &count) in counts.iter().enumerate() {
            let corners = map.cell((index % grid[0], index / grid[0]), (grid[0], grid[1]));
            let colour = if count == 0 { WHITE } else { shade(PALE * f64::from(count) / f64::from(most)) };
            area.draw(&Rectangle::new(corners, colour.filled())).ok();
        }
        for observation in observations(calibration, camera) {
            area.draw(&Circle::new(map.place(observation.position), 1, RGBColor(0, 114, 178).filled())).ok();
        }
        for (index, &count) in counts.iter().enumerate() {
            let [(left, up), (right, down)] = map.cell((index % grid[0], index / grid[0]), (grid[0], grid[1]));
            write(area, &count.to_string(), ((left + right) / 2, (up + down) / 2), HPos::Center);
        }
        map.axes(area);
    });
    let empty = counts.iter().filter(|count| **count == 0).count();
    let said = format!("{} points; {empty} of {} cells are empty", observations(calibration, camera).count(), counts.len());
    canvas.text(&said, 16, (LEFT, TOP + map.extent.1 + BOTTOM - 20));
    canvas
}
