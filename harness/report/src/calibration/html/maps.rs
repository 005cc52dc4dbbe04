//! Maps over the frame, of the board, and of correlations.

use calibench_adjust::Distance;
use calibench_calibrate::{Board, Calibration};
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, ImageSize};
use calibench_model::convert::without_distortion;

use super::super::board::adjusted;
use super::super::pictures::{counts, own, plain_level, tint};
use super::super::uncertainty::UncertaintyMap;
use super::OfCamera;
use crate::field::shade;
use crate::html::{Axis, Plot, Said};
use crate::hull::Hull;
use crate::levels::Scale;
use crate::plain;

/// Columns of the map of distortion.
const COLUMNS: usize = 36;

fn rgb(part: f64) -> [u8; 3] {
    let colour = shade(part);
    [colour.0, colour.1, colour.2]
}

/// Corners of a cell of a grid over the frame, px.
fn cell(size: ImageSize, (column, row): (usize, usize), (columns, rows): (usize, usize)) -> [(f64, f64); 2] {
    let at = |i: usize, n: usize, length: u32| i as f64 / n as f64 * f64::from(length) - 0.5;
    [(0, 0), (1, 1)].map(|(c, r)| (at(column + c, columns, size.width), at(row + r, rows, size.height)))
}

/// How many image points are in each cell of the frame.
pub(super) fn distribution(of: &OfCamera<'_, '_>) -> String {
    let OfCamera { calibration, camera, .. } = *of;
    let (size, (grid, counts)) = (calibration.camera(camera).size(), counts(calibration, camera));
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let mut plot = Plot::frame(&of.id("distribution"), "Number of image points in each part of the frame", size);
    plot.series(1, None, &["image points"]);
    for (index, &count) in counts.iter().enumerate() {
        let corners = cell(size, (index % grid[0], index / grid[0]), (grid[0], grid[1]));
        let fill = (count > 0).then(|| rgb(0.4 * f64::from(count) / f64::from(most)));
        plot.cell(corners, fill, &Said::of([count.to_string()]));
        plot.note(((corners[0].0 + corners[1].0) / 2.0, (corners[0].1 + corners[1].1) / 2.0), &count.to_string(), count > 0);
    }
    let empty = counts.iter().filter(|count| **count == 0).count();
    plot.figure(&of.caption(&format!(
        "Where the image points lie in the frame: their number in each cell. Empty cells ({empty} of {}) are extrapolation.",
        counts.len()
    )))
}

/// A cell for each pair of a camera's parameters.
pub(super) fn correlations(of: &OfCamera<'_, '_>) -> Option<String> {
    let OfCamera { calibration, camera, .. } = *of;
    let all = calibration.covariances.correlations();
    let (places, names) = own(calibration, camera);
    let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
    if names.len() < 2 {
        return None;
    }
    let down: Vec<String> = names.iter().rev().cloned().collect();
    let mut plot = Plot::new(
        &of.id("correlations"),
        "Correlations of the interior orientation",
        Axis::named("", names.clone()),
        Axis::named("", down),
        520.0,
    );
    plot.series(1, None, &["parameters", "correlation"]);
    for (i, j) in (0..names.len()).flat_map(|i| (0..names.len()).map(move |j| (i, j))) {
        let rho = all[(places[i], places[j])];
        let (x, y) = (j as f64, (names.len() - 1 - i) as f64);
        let colour = tint(rho);
        let said = Said::of([format!("{}, {}", names[i], names[j]), format!("{rho:.4}")]);
        plot.cell([(x - 0.5, y - 0.5), (x + 0.5, y + 0.5)], Some([colour.0, colour.1, colour.2]), &said);
        plot.note((x, y), &format!("{rho:.2}"), true);
    }
    Some(plot.figure(&of.caption("Correlations of the interior orientation: blue negative, orange positive.")))
}

/// The uncertainty of projected points, by the name of the picture.
pub(super) fn uncertainty(of: &OfCamera<'_, '_>) -> Vec<(&'static str, String)> {
    let size = of.calibration.camera(of.camera).size();
    let figure = |map: &UncertaintyMap| {
        let name = if map.distance == Distance::Far { "uncertainty-far" } else { "uncertainty-near" };
        let values = map.sigmas();
        let scale = Scale::of(&values)?;
        let mut plot = Plot::frame(&of.id(name), &format!("Standard deviation of a projected point, {}", map.whose()), size);
        plot.series(1, None, &["x, px", "y, px", "standard deviation, px"]);
        for (index, (place, value)) in map.places.iter().zip(&values).enumerate() {
            let Some(place) = place else { continue };
            let corners = cell(size, (index % map.grid.0, index / map.grid.0), map.grid);
            let said = Said::of([format!("{:.0}", place.at.x), format!("{:.0}", place.at.y), plain(*value)]);
            plot.cell(corners, Some(rgb(scale.part(*value))), &said);
        }
        around(&mut plot, &map.measured);
        let levels: Vec<(f64, String)> = scale.levels().into_iter().map(|level| (scale.part(level), plain_level(level))).collect();
        plot.shades("px (log scale)", &levels);
        let caption = format!(
            "Standard deviation (2D) of the image of a point {}. The line surrounds the image points: outside nothing was measured, and the model's word is all there is.",
            map.whose()
        );
        Some((name, plot.figure(&of.caption(&caption))))
    };
    of.maps.iter().filter_map(figure).collect()
}

/// A line around what was measured.
fn around(plot: &mut Plot, hull: &Hull) {
    let mut places: Vec<(f64, f64)> = hull.sides().map(|[a, _]| (a.x, a.y)).collect();
    if let Some(first) = places.first().copied() {
        places.push(first);
        plot.series(7, None, &["measured"]);
        plot.line(&places, &Said::default());
    }
}

/// How far distortion moves points of the frame, from where the same camera without it pictures their rays.
pub(super) fn distortion(of: &OfCamera<'_, '_>) -> Option<String> {
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
    let mut plot = Plot::frame(&of.id("distortion"), "Distortion over the frame", size);
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
    plot.shades("px", &[0.0, 0.25, 0.5, 0.75, 1.0].map(|part| (part, plain(part * top))));
    Some(plot.figure(&of.caption(&format!(
        "How far distortion moves points, from where the same camera without it pictures their rays to where they are; at most {} px. Arrows {times} times their length. White: no such place.",
        plain(most)
    ))))
}

/// The height of a bent board over its lowest place.
pub(super) fn board(calibration: &Calibration<'_>) -> Option<String> {
    const PLACES: usize = 31;
    let (board, coefficients, _) = adjusted(calibration)?;
    let [half_u, half_v] = board.half;
    let at = |i: usize| 2.0 * (i as f64 + 0.5) / PLACES as f64 - 1.0;
    let lift = |k: usize| Board::lift(coefficients, [at(k % PLACES), at(k / PLACES)]);
    let lowest = (0..PLACES * PLACES).map(lift).fold(f64::INFINITY, f64::min);
    let highest = (0..PLACES * PLACES).map(|k| lift(k) - lowest).fold(f64::MIN_POSITIVE, f64::max);
    let height = (760.0 * half_v / half_u).clamp(120.0, 1000.0);
    let axis = |name: &str, half: f64| Axis::linear(&format!("{name} from the middle, object units"), [-half, half]);
    let mut plot = Plot::new("board", "Shape of the board", axis("u", half_u), axis("v", half_v), height);
    plot.series(1, None, &["u", "v", "height"]);
    for k in 0..PLACES * PLACES {
        let (u, v) = (at(k % PLACES), at(k / PLACES));
        let part = 1.0 / PLACES as f64;
        let corners = [-part, part].map(|side| ((u + side) * half_u, (v + side) * half_v));
        let height = lift(k) - lowest;
        plot.cell(corners, Some(rgb(height / highest)), &Said::of([u * half_u, v * half_v, height].map(plain)));
    }
    plot.shades("height", &[0.0, 0.25, 0.5, 0.75, 1.0].map(|part| (part, plain(part * highest))));
    Some(plot.figure("Height of the board over its lowest place, towards the camera, object units: what the control file does not say."))
}
