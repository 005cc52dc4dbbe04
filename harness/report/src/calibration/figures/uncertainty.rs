//! What the uncertainty of the interior orientation means in the image, over the frame.

use calibench_adjust::Distance;
use calibench_model::camera::{CameraModel, ImageSize};

use super::super::uncertainty::UncertaintyMap;
use super::OfCamera;
use super::maps::cell;
use crate::field::rgb;
use crate::levels::{Scale, contour};
use crate::plain;
use crate::plot::{Figure, Plot, Said};

/// Room that a line's value needs on all sides, in widths of the frame.
const ROOM: f64 = 0.027;

/// A map over the frame of a camera; `None` where nothing is known.
pub(super) fn figure(of: &OfCamera<'_, '_>, map: &UncertaintyMap) -> Option<Figure> {
    let size = of.calibration.camera(of.camera).size();
    let name = if map.distance == Distance::Far { "uncertainty-far" } else { "uncertainty-near" };
    let values = map.sigmas();
    let scale = Scale::of(&values)?;
    let mut plot = Plot::frame(&of.name(name), &format!("Standard deviation of a projected point, {}", map.whose()), size);
    plot.series(1, None, &["x, px", "y, px", "standard deviation, px"]);
    for (index, (place, value)) in map.places.iter().zip(&values).enumerate() {
        let Some(place) = place else { continue };
        let corners = cell(size, (index % map.grid.0, index / map.grid.0), map.grid);
        let said = Said::of([format!("{:.0}", place.at.x), format!("{:.0}", place.at.y), plain(*value)]);
        plot.cell(corners, Some(rgb(scale.part(*value))), &said);
    }
    contours(&mut plot, size, (&values, map.grid), &scale);
    plot.dashed(&map.measured.outline());
    let levels: Vec<(f64, String)> = scale.levels().into_iter().map(|level| (scale.part(level), plain_level(level))).collect();
    plot.shades("px (log scale)", &levels);
    let caption = format!(
        "Standard deviation (2D) of the image of a point {}, from the covariance of camera and poses together, the poses held by what was measured. \
         The dashed line surrounds the image points: outside nothing was measured, and the model's word is all there is.",
        map.whose()
    );
    let is_inside: Vec<bool> = map.places.iter().map(|place| place.as_ref().is_some_and(|place| map.measured.holds(place.at))).collect();
    let of_part =
        |part: bool| said(values.iter().zip(&is_inside).filter(|(_, inside)| **inside == part).map(|(value, _)| *value).collect());
    let remark = format!("px, inside the dashed line: {}; outside: {}", of_part(true), of_part(false));
    Some(of.figure(name, (&caption, remark), plot))
}

/// The middle and the most of some values, and their root mean square.
fn said(mut sigmas: Vec<f64>) -> String {
    sigmas.retain(|sigma| sigma.is_finite());
    sigmas.sort_by(f64::total_cmp);
    let Some(most) = sigmas.last() else { return "nothing".into() };
    let mean = (sigmas.iter().map(|sigma| sigma * sigma).sum::<f64>() / sigmas.len() as f64).sqrt();
    format!("median {}, RMS {}, at most {}", plain(sigmas[sigmas.len() / 2]), plain(mean), plain(*most))
}

/// Lines of equal standard deviation, each with its value where there is most room. The nodes of the grid go from the first pixel's centre to the last's.
fn contours(plot: &mut Plot, size: ImageSize, (values, grid): (&[f64], (usize, usize)), scale: &Scale) {
    let [width, height] = [size.width, size.height].map(|length| f64::from(length - 1));
    let place = |(column, row): (f64, f64)| (column / (grid.0 - 1) as f64 * width, row / (grid.1 - 1) as f64 * height);
    let mut tags: Vec<((f64, f64), f64)> = Vec::new();
    for level in scale.levels() {
        let pieces: Vec<[(f64, f64); 2]> = contour(values, grid, level).into_iter().map(|ends| ends.map(place)).collect();
        let room = |at: (f64, f64)| {
            let others = tags.iter().map(|(other, _)| (at.0 - other.0).hypot(at.1 - other.1));
            let sides = at.0.min(at.1).min(width - at.0).min(height - at.1);
            others.fold(sides, f64::min)
        };
        let free = pieces.iter().map(|ends| (room(ends[0]), ends[0])).max_by(|a, b| a.0.total_cmp(&b.0));
        plot.contour(pieces);
        tags.extend(free.filter(|(room, _)| *room > ROOM * width).map(|(_, at)| (at, level)));
    }
    for (at, level) in tags {
        plot.tag(at, &plain_level(level));
    }
}

/// A round level without useless digits.
fn plain_level(level: f64) -> String {
    if (1e-4..1e5).contains(&level) { level.to_string() } else { format!("{level:e}") }
}
