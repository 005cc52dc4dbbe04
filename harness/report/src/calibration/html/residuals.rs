//! Residuals over the frame and by photograph.

use std::collections::HashMap;

use calibench_adjust::{Residual, Use};
use calibench_calibrate::Calibration;
use calibench_model::camera::CameraModel;

use super::super::images_of;
use super::super::pictures::{length, shown, times};
use super::OfCamera;
use crate::field::MAP;
use crate::html::{Axis, Plot, Said, Shape};
use crate::plain;

/// Points that are enlarged.
const ENLARGED: usize = 200;
/// Arrows of a figure: of more than these the longest are drawn, and of the others some.
const MOST: usize = 4000;

const SAYS: [&str; 6] = ["image", "target", "residual, px", "vx, px", "vy, px", "normalised"];

/// The observations with the longest residuals, with their keys: the longest first.
pub(super) type Worst = HashMap<usize, usize>;

/// Of one that has no residual it is longer than any.
fn longest_first(residual: &Residual) -> f64 {
    length(residual).unwrap_or(f64::INFINITY)
}

pub(super) fn worst(calibration: &Calibration<'_>) -> Worst {
    let mut all: Vec<(f64, usize)> =
        calibration.solution.each_residual().map(|residual| (longest_first(&residual), residual.observation)).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    all.truncate(ENLARGED);
    all.into_iter().enumerate().map(|(key, (_, observation))| (observation, key)).collect()
}

/// All residuals of a camera's images in one frame.
pub(super) fn together(of: &OfCamera<'_, '_>, worst: &Worst) -> String {
    let OfCamera { calibration, camera, .. } = of;
    let size = calibration.camera(*camera).size();
    let own = |residual: &Residual| calibration.owner(residual.image) == *camera && residual.v.is_some();
    let mut all: Vec<Residual> = calibration.solution.each_residual().filter(own).collect();
    let count = all.len();
    all.sort_by(|a, b| longest_first(b).total_cmp(&longest_first(a)).then(a.observation.cmp(&b.observation)));
    let every = count.saturating_sub(MOST / 2).div_ceil(MOST / 2).max(1);
    let drawn: Vec<&Residual> =
        all.iter().enumerate().filter(|(place, _)| *place < MOST / 2 || place % every == 0).map(|(_, r)| r).collect();
    let times = times(&all, size, MAP);
    let mut plot = Plot::frame(&of.id("residuals"), "Residuals of all images over the frame", size);
    for (colour, is_full) in [(1, true), (0, false)] {
        plot.series(colour, None, &SAYS);
        for residual in drawn.iter().filter(|residual| (residual.used == Use::Full) == is_full) {
            arrow(&mut plot, calibration, residual, times, worst);
        }
    }
    let longest = all.iter().filter(|r| r.used != Use::LeftOut).filter_map(length).fold(0.0, f64::max);
    let doubted = all.iter().filter(|r| r.used != Use::Full).count();
    let doubted = if doubted > 0 { format!("; orange: {doubted} left out or of less weight") } else { String::new() };
    let some =
        if every > 1 { format!("; of {count} the longest {} are drawn and one in {every} of the others", MOST / 2) } else { String::new() };
    plot.figure(&of.caption(&format!(
        "Residuals (adjusted less observed) of all images together. Arrows {times} times their length; the longest {} px{doubted}{some}. A click chooses an image.",
        plain(longest)
    )))
}

fn arrow(plot: &mut Plot, calibration: &Calibration<'_>, residual: &Residual, times: f64, worst: &Worst) {
    let Some(v) = residual.v else { return };
    let prepared = calibration.prepared;
    let sight = prepared.survey.sight(prepared.sights[residual.observation] as usize);
    let normalised = calibration.reliability.as_ref().and_then(|found| {
        let at = found.points.binary_search_by_key(&residual.observation, |point| point.observation).ok()?;
        let [x, y] = found.points[at].w;
        Some(plain(x.abs().max(y.abs())))
    });
    let said = Said {
        values: vec![
            prepared.survey.images[sight.image].clone(),
            prepared.survey.target(sight.target).to_owned(),
            plain(v[0].hypot(v[1])),
            plain(v[0]),
            plain(v[1]),
            normalised.unwrap_or_default(),
        ],
        group: Some(residual.image),
        key: worst.get(&residual.observation).copied(),
    };
    let size = calibration.camera(calibration.owner(residual.image)).size();
    let [x, y] = shown(v, size, times);
    plot.arrow(prepared.network.observations[residual.observation].position, (x, y), &said);
}

/// RMS and longest residual of each image.
pub(super) fn by_image(of: &OfCamera<'_, '_>) -> String {
    let OfCamera { calibration, camera, .. } = of;
    let names = &calibration.prepared.survey.images;
    let rms = calibration.solution.rms_by_image();
    let images: Vec<usize> = images_of(calibration, *camera).collect();
    let mut longest = vec![0.0_f64; names.len()];
    for residual in calibration.solution.each_residual().filter(|r| r.used != Use::LeftOut) {
        longest[residual.image] = longest[residual.image].max(length(&residual).unwrap_or(0.0));
    }
    let high = images.iter().map(|&image| longest[image]).fold(0.0, f64::max).max(1e-12);
    // More names than these cannot be read.
    let shown = if images.len() <= 30 { images.iter().enumerate().map(|(place, _)| (place + 1).to_string()).collect() } else { Vec::new() };
    let x = if shown.is_empty() {
        Axis::linear("image, in the order of the table", [-1.0, images.len() as f64])
    } else {
        Axis::named("image, in the order of the table", shown)
    };
    let mut plot =
        Plot::new(&of.id("residuals-by-image"), "RMS and longest residual of each image", x, Axis::linear("px", [0.0, 1.08 * high]), 300.0);
    plot.series(1, None, &["image", "RMS, px", "longest, px"]);
    for (place, &image) in images.iter().enumerate() {
        let Some(rms) = rms[image] else { continue };
        let x = place as f64;
        plot.whisker(x, [0.0, longest[image]], &Said { group: Some(image), ..Said::default() });
        let said = Said { group: Some(image), ..Said::of([names[image].clone(), plain(rms), plain(longest[image])]) };
        plot.symbol(Shape::Circle, (x, rms), &said);
        plot.symbol(Shape::Plus, (x, longest[image]), &said);
    }
    plot.figure(
        &of.caption("Residuals by image: RMS (circle) and the longest (cross). A click chooses an image, in all figures and in the table."),
    )
}
