//! Residual vectors over the frame.

use calibench_adjust::{Residual, Use};
use calibench_calibrate::Calibration;
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, ImageSize};
use plotters::prelude::*;

use super::super::images_of;
use crate::corners::{shown, stretched};
use crate::field::{Area, BOTTOM, LEFT, MAP, TOP, arrow};
use crate::frame::Map;
use crate::{Canvas, plain};

/// The colour of what takes part, and of what does not, or not fully.
const KEPT: RGBColor = RGBColor(0, 114, 178);
const DOUBTED: RGBColor = RGBColor(213, 94, 0);
/// Panels in a row and in a picture, and their width and height above the map.
const COLUMNS: usize = 4;
pub(in super::super) const PANELS: usize = 24;
const PANEL: u32 = 300;
const GAP: u32 = 12;
const NAME: u32 = 24;
/// Residuals that are drawn at most: more of them cover each other.
const MOST: usize = 50_000;

/// The residuals in the images of a camera.
struct Residuals {
    /// Those that are drawn.
    drawn: Vec<Residual>,
    /// Of so many, one is drawn.
    every: usize,
    /// The longest of all that take part, px.
    longest: f64,
    /// How many of all do not take part, or not fully.
    doubted: usize,
}

impl Residuals {
    fn of_camera(calibration: &Calibration<'_>, camera: usize) -> Self {
        let all = || calibration.solution.each_residual().filter(move |residual| calibration.owner(residual.image) == camera);
        let every = all().count().div_ceil(MOST).max(1);
        Self {
            drawn: all().step_by(every).collect(),
            every,
            longest: all().filter(|r| r.used != Use::LeftOut).filter_map(|r| length(&r)).fold(0.0, f64::max),
            doubted: all().filter(|r| r.used != Use::Full).count(),
        }
    }
}

/// All images of a camera in one frame.
pub(super) fn together(calibration: &Calibration<'_>, camera: usize) -> Canvas {
    let residuals = Residuals::of_camera(calibration, camera);
    let size = calibration.camera(camera).size();
    let (map, mut canvas) = Map::alone(size, "Residuals of all images");
    let times = times(&residuals.drawn, size, MAP);
    canvas.paint(|area| {
        residuals.drawn.iter().for_each(|residual| vector(area, &map, calibration, residual, times));
        map.axes(area);
    });
    canvas.text(&legend(&residuals, times), 16, (LEFT, TOP + map.extent.1 + BOTTOM - 20));
    canvas
}

/// A panel for each image of a camera, some panels in each picture, with the names of its first and last image.
pub(super) fn by_image(calibration: &Calibration<'_>, camera: usize) -> Vec<(String, Canvas)> {
    let residuals = Residuals::of_camera(calibration, camera);
    let images: Vec<usize> = images_of(calibration, camera).collect();
    let times = times(&residuals.drawn, calibration.camera(camera).size(), PANEL);
    images.chunks(PANELS).map(|images| panels(calibration, &residuals, images, times)).collect()
}

fn panels(calibration: &Calibration<'_>, residuals: &Residuals, images: &[usize], times: f64) -> (String, Canvas) {
    let size = calibration.camera(calibration.owner(images[0])).size();
    let names = &calibration.prepared.survey.images;
    let height = Map::new(size, (0, 0), PANEL).extent.1 + NAME + GAP;
    let columns = images.len().min(COLUMNS) as u32;
    let width = (columns * (PANEL + GAP) + GAP).max(2 * PANEL + 3 * GAP);
    let mut canvas = Canvas::new(width, images.len().div_ceil(COLUMNS) as u32 * height + GAP + BOTTOM / 2);
    let rms = calibration.solution.rms_by_image();
    for (index, &image) in images.iter().enumerate() {
        let (x, y) = (GAP + (index % COLUMNS) as u32 * (PANEL + GAP), GAP + (index / COLUMNS) as u32 * height);
        let said = rms[image].map_or(String::new(), |rms| format!(": {} px RMS", plain(rms)));
        canvas.text(&format!("{}{said}", names[image]), 15, (x, y + NAME / 2));
        let map = Map::new(size, (x, y + NAME), PANEL);
        canvas.paint(|area| {
            residuals.drawn.iter().filter(|r| r.image == image).for_each(|residual| vector(area, &map, calibration, residual, times));
            map.outline(area);
        });
    }
    canvas.text(&legend(residuals, times), 15, (GAP, images.len().div_ceil(COLUMNS) as u32 * height + GAP + BOTTOM / 4));
    let ends = [images[0], images[images.len() - 1]].map(|image| names[image].as_str());
    (if images.len() > 1 { format!("{} to {}", ends[0], ends[1]) } else { ends[0].to_owned() }, canvas)
}

/// The length of a residual, px.
pub(in super::super) fn length(residual: &Residual) -> Option<f64> {
    residual.v.map(|[x, y]| x.hypot(y))
}

/// How many times too long the vectors are drawn in a map `width` px wide, of an image of some size.
fn times(residuals: &[Residual], size: ImageSize, width: u32) -> f64 {
    stretched(residuals.iter().filter(|r| r.used != Use::LeftOut).filter_map(length), size, width)
}

fn vector(area: &Area<'_>, map: &Map, calibration: &Calibration<'_>, residual: &Residual, times: f64) {
    let at = calibration.prepared.network.observations[residual.observation].position;
    let from = map.place(at);
    let colour = if residual.used == Use::Full { KEPT } else { DOUBTED };
    area.draw(&Circle::new(from, 2, colour.filled())).ok();
    let Some(v) = residual.v else { return };
    let [x, y] = shown(v, calibration.camera(calibration.owner(residual.image)).size(), times);
    arrow(area, from, map.place(PixelPoint::new(at.x + x, at.y + y)));
}

fn legend(residuals: &Residuals, times: f64) -> String {
    let Residuals { every, longest, doubted, .. } = *residuals;
    let doubted = if doubted > 0 { format!("; orange: {doubted} left out or of less weight") } else { String::new() };
    let drawn = if every > 1 { format!("; one of {every} is drawn") } else { String::new() };
    format!("arrows {times} times too long; longest {} px{doubted}{drawn}", plain(longest))
}
