//! Residuals over the frame and by photograph.

use calibench_adjust::{Residual, Use};
use calibench_calibrate::Calibration;
use calibench_model::camera::CameraModel;

use crate::html::{Axis, Plot, Said, Shape};
use crate::plain;

/// Points that are enlarged.
const ENLARGED: usize = 200;
/// Arrows of a figure: of more than these the longest are drawn, and of the others some.
const MOST: usize = 4000;

const SAYS: [&str; 6] = ["image", "target", "residual, px", "vx, px", "vy, px", "normalised"];

fn length(residual: &Residual) -> f64 {
    residual.v.map_or(f64::INFINITY, |[x, y]| x.hypot(y))
}

/// The observations with the longest residuals, the longest first: their place is their key.
pub(super) fn worst(calibration: &Calibration<'_>) -> Vec<usize> {
    let mut all: Vec<(f64, usize)> =
        calibration.solution.each_residual().map(|residual| (length(&residual), residual.observation)).collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    all.truncate(ENLARGED);
    all.into_iter().map(|(_, observation)| observation).collect()
}

/// All residuals of a camera's images in one frame.
pub(super) fn together(calibration: &Calibration<'_>, camera: usize, worst: &[usize]) -> String {
    let size = calibration.camera(camera).size();
    let mut all: Vec<Residual> =
        calibration.solution.each_residual().filter(|r| calibration.owner(r.image) == camera && r.v.is_some()).collect();
    let count = all.len();
    all.sort_by(|a, b| length(b).total_cmp(&length(a)).then(a.observation.cmp(&b.observation)));
    let every = count.saturating_sub(MOST / 2).div_ceil(MOST / 2).max(1);
    let drawn: Vec<&Residual> =
        all.iter().enumerate().filter(|(place, _)| *place < MOST / 2 || place % every == 0).map(|(_, r)| r).collect();
    let mut used: Vec<f64> = all.iter().filter(|r| r.used != Use::LeftOut).map(length).collect();
    used.sort_by(f64::total_cmp);
    let times = crate::field::stretch(0.06 * f64::from(size.width), used.get(used.len() * 95 / 100).copied().unwrap_or(0.0).max(1e-12));
    let mut plot = Plot::frame("residuals", "Residuals of all images over the frame", size);
    for (colour, is_full) in [(1, true), (0, false)] {
        plot.series(colour, None, &SAYS);
        for residual in drawn.iter().filter(|residual| (residual.used == Use::Full) == is_full) {
            arrow(&mut plot, calibration, residual, times, worst);
        }
    }
    let doubted = all.iter().filter(|r| r.used != Use::Full).count();
    let doubted = if doubted > 0 { format!("; orange: {doubted} left out or of less weight") } else { String::new() };
    let some =
        if every > 1 { format!("; of {count} the longest {} are drawn and one in {every} of the others", MOST / 2) } else { String::new() };
    plot.figure(&format!(
        "Residuals (adjusted less observed) of all images together. Arrows {times} times their length; the longest {} px{doubted}{some}. A click chooses an image.",
        plain(used.last().copied().unwrap_or(0.0))
    ))
}

fn arrow(plot: &mut Plot, calibration: &Calibration<'_>, residual: &Residual, times: f64, worst: &[usize]) {
    let Some([vx, vy]) = residual.v else { return };
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
            plain(vx.hypot(vy)),
            plain(vx),
            plain(vy),
            normalised.unwrap_or_default(),
        ],
        group: Some(residual.image),
        key: worst.iter().position(|observation| *observation == residual.observation),
    };
    // A blunder that is left out may be as long as the frame: its direction is enough.
    let width = f64::from(calibration.camera(calibration.owner(residual.image)).size().width);
    let times = times * (0.15 * width / (times * vx.hypot(vy)).max(f64::MIN_POSITIVE)).min(1.0);
    plot.arrow(prepared.network.observations[residual.observation].position, (vx * times, vy * times), &said);
}

/// RMS and longest residual of each image.
pub(super) fn by_image(calibration: &Calibration<'_>, camera: usize) -> String {
    let names = &calibration.prepared.survey.images;
    let rms = calibration.solution.rms_by_image();
    let images: Vec<usize> = (0..names.len()).filter(|&image| calibration.owner(image) == camera).collect();
    let mut longest = vec![0.0_f64; names.len()];
    for residual in calibration.solution.each_residual().filter(|r| r.used != Use::LeftOut && r.v.is_some()) {
        longest[residual.image] = longest[residual.image].max(length(&residual));
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
        Plot::new("residuals-by-image", "RMS and longest residual of each image", x, Axis::linear("px", [0.0, 1.08 * high]), 300.0);
    plot.series(1, None, &["image", "RMS, px", "longest, px"]);
    for (place, &image) in images.iter().enumerate() {
        let Some(rms) = rms[image] else { continue };
        let x = place as f64;
        plot.whisker(x, [0.0, longest[image]], &Said { group: Some(image), ..Said::default() });
        let said = Said { group: Some(image), ..Said::of([names[image].clone(), plain(rms), plain(longest[image])]) };
        plot.symbol(Shape::Circle, (x, rms), &said);
        plot.symbol(Shape::Plus, (x, longest[image]), &said);
    }
    plot.figure("Residuals by image: RMS (circle) and the longest (cross). A click chooses an image, in all figures and in the table.")
}
