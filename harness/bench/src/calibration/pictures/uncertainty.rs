//! What the uncertainty of the interior orientation means in the image, over the frame.

use calibench_adjust::{Distance, Uncertainty, frame_uncertainty};
use calibench_model::camera::CameraModel;
use plotters::prelude::*;

use super::super::Calibration;
use super::frame::Map;
use crate::report::field::{BOTTOM, LEFT, TOP, colour_bar, shade};
use crate::report::{Canvas, plain};

/// Places along the longer side of the frame.
const PLACES: usize = 48;

/// Maps for points far away and near: file, caption, picture. None if the interior orientation is fixed.
pub(super) fn pictures(calibration: &Calibration<'_>) -> Vec<(&'static str, String, Canvas)> {
    let near = working_distance(calibration);
    let title = |what: &str| format!("Standard deviation of a projected point, {what}");
    let caption = |what: &str| {
        format!(
            "Standard deviation (2D) of the image of a point {what} that stems from the interior orientation, after what the exterior makes up for."
        )
    };
    let far = map(calibration, Distance::Far, &title("far away"));
    let far = far.map(|canvas| ("uncertainty-far.png", caption("far away"), canvas));
    let distance = plain(near);
    let near = map(calibration, Distance::Near(near), &title(&format!("at {distance} object units")));
    let near =
        near.map(|canvas| ("uncertainty-near.png", caption(&format!("at the distance of the object ({distance} object units)")), canvas));
    far.into_iter().chain(near).collect()
}

/// The median distance of the image points' objects from their cameras, along the axis.
pub(super) fn working_distance(calibration: &Calibration<'_>) -> f64 {
    let (poses, points) = (calibration.solution.poses(), calibration.solution.points());
    let depth = |o: &calibench_adjust::ImageObservation| -poses[o.image].ray(&points[o.point]).z;
    let mut depths: Vec<f64> = calibration.prepared.network.observations.iter().map(depth).collect();
    depths.sort_by(f64::total_cmp);
    depths.get(depths.len() / 2).copied().unwrap_or(1.0)
}

fn map(calibration: &Calibration<'_>, distance: Distance, title: &str) -> Option<Canvas> {
    let camera = calibration.camera();
    let (names, covariance) = calibration.covariances.of_camera(0);
    if names.is_empty() {
        return None;
    }
    let size = camera.size();
    let step = f64::from(size.width.max(size.height)) / PLACES as f64;
    let grid = [size.width, size.height].map(|length| ((f64::from(length) / step).round() as usize).max(3));
    let found = frame_uncertainty(camera, (&names, &covariance), (grid[0], grid[1]), distance).ok()?;
    let sigma = |u: &Uncertainty| (u.covariance.sxx + u.covariance.syy).max(0.0).sqrt();
    let most = found.iter().map(sigma).fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let (map, mut canvas) = Map::alone(size, title);
    let index = |value: f64, length: u32, n: usize| (value / f64::from(length - 1) * (n - 1) as f64).round() as usize;
    canvas.paint(|area| {
        for place in &found {
            let cell = (index(place.at.x, size.width, grid[0]), index(place.at.y, size.height, grid[1]));
            area.draw(&Rectangle::new(map.cell(cell, (grid[0], grid[1])), shade(sigma(place) / most).filled())).ok();
        }
        map.axes(area);
        colour_bar(area, map.extent, most);
    });
    let mean = (found.iter().map(|u| sigma(u).powi(2)).sum::<f64>() / found.len().max(1) as f64).sqrt();
    let mut sigmas: Vec<f64> = found.iter().map(sigma).collect();
    sigmas.sort_by(f64::total_cmp);
    let median = sigmas.get(sigmas.len() / 2).copied().unwrap_or(0.0);
    let said = format!("{} px at most, {} px RMS, median {} px over the frame", plain(most), plain(mean), plain(median));
    canvas.text(&said, 16, (LEFT, TOP + map.extent.1 + BOTTOM - 20));
    Some(canvas)
}
