//! Residuals over the frame and by photograph.

use calibench_adjust::Use;
use calibench_calibrate::Calibration;
use calibench_model::camera::CameraModel;

use super::super::images_of;
use super::OfCamera;
use crate::Canvas;
use crate::corners::{Corner, Vectors, choose, over_frame, vectors};
use crate::plain;
use crate::plot::{Axis, Figure, PANEL, Plot, Said, Shape, panels as draw};

/// Panels in a picture.
const PANELS: usize = 24;
/// Residuals in panels at most: more of them cover each other.
const MOST: usize = 50_000;

/// All points of all images, the longest residuals with their keys.
pub(in super::super) fn corners<'c>(calibration: &'c Calibration<'_>) -> Vec<Corner<'c>> {
    let prepared = calibration.prepared;
    let normalised = |observation: usize| {
        let found = calibration.reliability.as_ref()?;
        let at = found.points.binary_search_by_key(&observation, |point| point.observation).ok()?;
        let [x, y] = found.points[at].w;
        Some(x.abs().max(y.abs()))
    };
    let corner = |residual: calibench_adjust::Residual| {
        let sight = prepared.survey.sight(prepared.sights[residual.observation] as usize);
        Corner {
            image: residual.image,
            name: &prepared.survey.images[sight.image],
            target: prepared.survey.target(sight.target).into(),
            at: prepared.network.observations[residual.observation].position,
            v: residual.v,
            used: residual.used,
            normalised: normalised(residual.observation),
            key: None,
        }
    };
    let mut all: Vec<Corner<'c>> = calibration.solution.each_residual().map(corner).collect();
    choose(&mut all);
    all
}

fn own<'c, 'a: 'c>(of: &OfCamera<'_, '_>, corners: &'c [Corner<'a>]) -> impl Iterator<Item = &'c Corner<'a>> {
    corners.iter().filter(|corner| of.calibration.owner(corner.image) == of.camera)
}

/// All residuals of a camera's images in one frame.
pub(super) fn together(of: &OfCamera<'_, '_>, corners: &[Corner<'_>]) -> Figure {
    let size = of.calibration.camera(of.camera).size();
    over_frame(&of.prefix, &of.whose, size, own(of, corners))
}

/// A panel for each image, some in a picture: file, caption and picture.
pub(super) fn panels(of: &OfCamera<'_, '_>, corners: &[Corner<'_>]) -> Vec<(String, String, Canvas)> {
    let OfCamera { calibration, camera, .. } = *of;
    let Vectors { plot, remark } = vectors("panels", calibration.camera(camera).size(), own(of, corners), (PANEL, MOST));
    let (names, rms) = (&calibration.prepared.survey.images, calibration.solution.rms_by_image());
    let images: Vec<usize> = images_of(calibration, camera).collect();
    let picture = |(number, images): (usize, &[usize])| {
        let heading =
            |image: usize| format!("{}{}", names[image], rms[image].map_or(String::new(), |rms| format!(": {} px RMS", plain(rms))));
        let groups: Vec<(usize, String)> = images.iter().map(|&image| (image, heading(image))).collect();
        let ends = [images[0], images[images.len() - 1]].map(|image| names[image].as_str());
        let which = if images.len() > 1 { format!("{} to {}", ends[0], ends[1]) } else { ends[0].to_owned() };
        let file = format!("{}.png", of.name(&format!("residuals-by-image-{}", number + 1)));
        (file, format!("{}Residuals by image: {which}.", of.whose), draw(&plot, &groups, &remark))
    };
    images.chunks(PANELS).enumerate().map(picture).collect()
}

/// RMS and longest residual of each image.
pub(super) fn by_image(of: &OfCamera<'_, '_>) -> Figure {
    let OfCamera { calibration, camera, .. } = *of;
    let names = &calibration.prepared.survey.images;
    let rms = calibration.solution.rms_by_image();
    let images: Vec<usize> = images_of(calibration, camera).collect();
    let mut longest = vec![0.0_f64; names.len()];
    for residual in calibration.solution.each_residual().filter(|r| r.used != Use::LeftOut) {
        longest[residual.image] = longest[residual.image].max(residual.v.map_or(0.0, |[x, y]| x.hypot(y)));
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
        Plot::new(&of.name("rms-by-image"), "RMS and longest residual of each image", x, Axis::linear("px", [0.0, 1.08 * high]), 300.0);
    plot.series(1, None, &["image", "RMS, px", "longest, px"]);
    for (place, &image) in images.iter().enumerate() {
        let Some(rms) = rms[image] else { continue };
        let x = place as f64;
        plot.whisker(x, [0.0, longest[image]], &Said { group: Some(image), ..Said::default() });
        let said = Said { group: Some(image), ..Said::of([names[image].clone(), plain(rms), plain(longest[image])]) };
        plot.symbol(Shape::Circle, (x, rms), &said);
        plot.symbol(Shape::Plus, (x, longest[image]), &said);
    }
    let caption = "Residuals by image: RMS (circle) and the longest (cross). In a page that answers a click chooses an image, in all figures and in the table.";
    of.figure("rms-by-image", (caption, String::new()), plot)
}
