//! What the uncertainty of the interior orientation means in the image, over the frame.

use calibench_adjust::{Distance, Uncertainty, frame_uncertainty};
use calibench_calibrate::Calibration;
use calibench_model::camera::CameraModel;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::frame::Map;
use super::levels::{Scale, contour};
use crate::field::{Area, BOTTOM, LEFT, TOP, shade, write};
use crate::{Canvas, plain};

/// Places along the longer side of the frame.
const PLACES: usize = 48;
/// Room that a line's value needs on all sides, px of the picture.
const LABEL: f64 = 24.0;

/// Maps for points far away and near: file, caption, picture. None if the interior orientation is fixed.
pub(super) fn pictures(calibration: &Calibration<'_>, camera: usize) -> Vec<(&'static str, String, Canvas)> {
    let near = working_distance(calibration, camera);
    let title = |what: &str| format!("Standard deviation of a projected point, {what}");
    let caption = |what: &str| {
        format!(
            "Standard deviation (2D) of the image of a point {what} that stems from the interior orientation, after what the exterior makes up for."
        )
    };
    let far = map((calibration, camera), Distance::Far, &title("far away"));
    let far = far.map(|canvas| ("uncertainty-far.png", caption("far away"), canvas));
    let distance = plain(near);
    let near = map((calibration, camera), Distance::Near(near), &title(&format!("at {distance} object units")));
    let near =
        near.map(|canvas| ("uncertainty-near.png", caption(&format!("at the distance of the object ({distance} object units)")), canvas));
    far.into_iter().chain(near).collect()
}

/// The median distance of what a camera sees, along its axis.
fn working_distance(calibration: &Calibration<'_>, camera: usize) -> f64 {
    let (poses, points) = (calibration.solution.poses(), calibration.solution.points());
    let depth = |o: &calibench_adjust::ImageObservation| -poses[o.image].ray(&points[o.point]).z;
    let observations = calibration.prepared.network.observations.iter().filter(|o| calibration.owner(o.image) == camera);
    let mut depths: Vec<f64> = observations.map(depth).collect();
    depths.sort_by(f64::total_cmp);
    depths.get(depths.len() / 2).copied().unwrap_or(1.0)
}

fn map((calibration, index): (&Calibration<'_>, usize), distance: Distance, title: &str) -> Option<Canvas> {
    let camera = calibration.camera(index);
    let (names, covariance) = calibration.covariances.of_camera(index);
    if names.is_empty() {
        return None;
    }
    let size = camera.size();
    let step = f64::from(size.width.max(size.height)) / PLACES as f64;
    let grid = [size.width, size.height].map(|length| ((f64::from(length) / step).round() as usize).max(3));
    let found = frame_uncertainty(camera, (&names, &covariance), (grid[0], grid[1]), distance).ok()?;
    let sigma = |u: &Uncertainty| (u.covariance.sxx + u.covariance.syy).max(0.0).sqrt();
    let (map, mut canvas) = Map::alone(size, title);
    let index = |value: f64, length: u32, n: usize| (value / f64::from(length - 1) * (n - 1) as f64).round() as usize;
    let mut values = vec![f64::NAN; grid[0] * grid[1]];
    for place in &found {
        values[index(place.at.y, size.height, grid[1]) * grid[0] + index(place.at.x, size.width, grid[0])] = sigma(place);
    }
    let scale = Scale::of(&values)?;
    canvas.paint(|area| {
        for (k, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            let corners = map.cell((k % grid[0], k / grid[0]), (grid[0], grid[1]));
            area.draw(&Rectangle::new(corners, shade(scale.part(*value)).filled())).ok();
        }
        contours(area, &map, &values, (grid[0], grid[1]), &scale);
        map.axes(area);
        bar(area, map.extent, &scale);
    });
    let mut sigmas: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
    sigmas.sort_by(f64::total_cmp);
    let mean = (sigmas.iter().map(|sigma| sigma * sigma).sum::<f64>() / sigmas.len().max(1) as f64).sqrt();
    let [most, median] = [sigmas.len().saturating_sub(1), sigmas.len() / 2].map(|i| sigmas.get(i).copied().unwrap_or(0.0));
    let said = format!("{} px at most, {} px RMS, median {} px over the frame", plain(most), plain(mean), plain(median));
    canvas.text(&said, 16, (LEFT, TOP + map.extent.1 + BOTTOM - 20));
    Some(canvas)
}

/// Lines of equal standard deviation, each with its value where there is most room.
fn contours(area: &Area<'_>, map: &Map, values: &[f64], grid: (usize, usize), scale: &Scale) {
    let mut labels: Vec<((i32, i32), f64)> = Vec::new();
    for level in scale.levels() {
        let pieces: Vec<[(i32, i32); 2]> =
            contour(values, grid, level).into_iter().map(|ends| ends.map(|(column, row)| map.node((column, row), grid))).collect();
        for (colour, width) in [(WHITE, 3), (BLACK, 1)] {
            for ends in &pieces {
                area.draw(&PathElement::new(ends.to_vec(), colour.stroke_width(width))).ok();
            }
        }
        let room = |at: (i32, i32)| {
            let others = labels.iter().map(|(other, _)| f64::from(at.0 - other.0).hypot(f64::from(at.1 - other.1)));
            others.chain([map.inside_by(at)]).fold(f64::INFINITY, f64::min)
        };
        let free = pieces.iter().map(|ends| (room(ends[0]), ends[0])).max_by(|a, b| a.0.total_cmp(&b.0));
        labels.extend(free.filter(|(room, _)| *room > LABEL).map(|(_, at)| (at, level)));
    }
    for (at, level) in labels {
        let text = plain_level(level);
        let half = 4 * text.len() as i32 + 3;
        area.draw(&Rectangle::new([(at.0 - half, at.1 - 9), (at.0 + half, at.1 + 9)], WHITE.filled())).ok();
        write(area, &text, at, HPos::Center);
    }
}

/// A round level without useless digits.
fn plain_level(level: f64) -> String {
    if (1e-4..1e5).contains(&level) { level.to_string() } else { format!("{level:e}") }
}

/// The scale of colours, logarithmic, with its levels.
fn bar(area: &Area<'_>, (width, height): (u32, u32), scale: &Scale) {
    let x = (LEFT + width) as i32 + 20;
    let (up, down) = (TOP as i32, (TOP + height) as i32);
    for y in up..down {
        let part = f64::from(down - y) / f64::from(down - up);
        area.draw(&PathElement::new([(x, y), (x + 20, y)], shade(part))).ok();
    }
    area.draw(&Rectangle::new([(x, up), (x + 20, down)], BLACK)).ok();
    for level in scale.levels() {
        let y = down - (scale.part(level) * f64::from(down - up)).round() as i32;
        area.draw(&PathElement::new([(x + 20, y), (x + 25, y)], BLACK)).ok();
        write(area, &plain_level(level), (x + 30, y), HPos::Left);
    }
    write(area, "px (log scale)", (x - 6, up - 14), HPos::Left);
}
