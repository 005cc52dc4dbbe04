//! What the uncertainty of the interior orientation means in the image, over the frame.

use calibench_adjust::Distance;
use calibench_model::camera::ImageSize;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::super::uncertainty::UncertaintyMap;
use crate::field::{Area, BOTTOM, LEFT, TOP, dashed, shade, shades_beside, write};
use crate::frame::Map;
use crate::levels::{Scale, contour};
use crate::{Canvas, plain};

/// Room that a line's value needs on all sides, px of the picture.
const LABEL: f64 = 24.0;

/// Maps over a frame of a size: file, caption, picture.
pub(super) fn pictures(size: ImageSize, maps: &[UncertaintyMap]) -> Vec<(&'static str, String, Canvas)> {
    let picture = |map: &UncertaintyMap| {
        let file = if map.distance == Distance::Far { "uncertainty-far.png" } else { "uncertainty-near.png" };
        let caption = format!(
            "Standard deviation (2D) of the image of a point {}, from the covariance of camera and poses together, the poses held by what was measured. \
             The dashed line surrounds the image points: outside nothing was measured, and the model's word is all there is.",
            map.whose()
        );
        Some((file, caption, draw(map, size)?))
    };
    maps.iter().filter_map(picture).collect()
}

fn draw(found: &UncertaintyMap, size: ImageSize) -> Option<Canvas> {
    let (map, mut canvas) = Map::alone(size, &format!("Standard deviation of a projected point, {}", found.whose()));
    let (grid, values) = (found.grid, found.sigmas());
    let scale = Scale::of(&values)?;
    canvas.paint(|area| {
        for (k, value) in values.iter().enumerate().filter(|(_, value)| value.is_finite()) {
            let corners = map.cell((k % grid.0, k / grid.0), grid);
            area.draw(&Rectangle::new(corners, shade(scale.part(*value)).filled())).ok();
        }
        contours(area, &map, &values, grid, &scale);
        found.measured.sides().for_each(|side| dashed(area, side.map(|end| map.place(end))));
        map.axes(area);
        bar(area, map.extent, &scale);
    });
    let inside = found.places.iter().map(|place| place.as_ref().is_some_and(|place| found.measured.holds(place.at)));
    let of =
        |wanted: bool| said(values.iter().zip(inside.clone()).filter(|(_, inside)| *inside == wanted).map(|(value, _)| *value).collect());
    let text = format!("px, inside the dashed line: {}; outside: {}", of(true), of(false));
    canvas.text(&text, 16, (LEFT, TOP + map.extent.1 + BOTTOM - 20));
    Some(canvas)
}

/// The middle and the most of some values, and their root mean square.
fn said(mut sigmas: Vec<f64>) -> String {
    sigmas.retain(|sigma| sigma.is_finite());
    sigmas.sort_by(f64::total_cmp);
    let Some(most) = sigmas.last() else { return "nothing".into() };
    let mean = (sigmas.iter().map(|sigma| sigma * sigma).sum::<f64>() / sigmas.len() as f64).sqrt();
    format!("median {}, RMS {}, at most {}", plain(sigmas[sigmas.len() / 2]), plain(mean), plain(*most))
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
pub(in super::super) fn plain_level(level: f64) -> String {
    if (1e-4..1e5).contains(&level) { level.to_string() } else { format!("{level:e}") }
}

/// The scale of colours, logarithmic, with its levels.
fn bar(area: &Area<'_>, extent: (u32, u32), scale: &Scale) {
    let (x, up, down) = shades_beside(area, extent);
    for level in scale.levels() {
        let y = down - (scale.part(level) * f64::from(down - up)).round() as i32;
        area.draw(&PathElement::new([(x + 20, y), (x + 25, y)], BLACK)).ok();
        write(area, &plain_level(level), (x + 30, y), HPos::Left);
    }
    write(area, "px (log scale)", (x - 6, up - 14), HPos::Left);
}
