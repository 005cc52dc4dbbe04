//! The shape of a bent board, as a map of heights.

use calibench_adjust::Status;
use calibench_calibrate::{Board, Calibration};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::super::board::adjusted;
use crate::field::{Area, BOTTOM, LEFT, MAP, RIGHT, TOP, shade, shades_beside, write};
use crate::levels::contour;
use crate::ticks::linear;
use crate::{Canvas, plain};

pub(super) const CAPTION: &str =
    "Height of the board over its lowest place, towards the camera: what the control file does not say. Dots are control points.";

/// Places along either side.
const PLACES: usize = 41;

/// The map, if a bend was adjusted.
pub(super) fn picture(calibration: &Calibration<'_>) -> Option<Canvas> {
    let (board, coefficients, sigmas) = adjusted(calibration)?;
    let at = |i: usize| 2.0 * i as f64 / (PLACES - 1) as f64 - 1.0;
    // The picture's rows go down, v goes up.
    let lift = |k: usize| Board::lift(coefficients, [at(k % PLACES), -at(k / PLACES)]);
    let lowest = (0..PLACES * PLACES).map(lift).fold(f64::INFINITY, f64::min);
    let heights: Vec<f64> = (0..PLACES * PLACES).map(|k| lift(k) - lowest).collect();
    let highest = heights.iter().copied().fold(0.0, f64::max).max(f64::MIN_POSITIVE);
    let extent = (MAP, (f64::from(MAP) * board.half[1] / board.half[0]).round().clamp(120.0, 2.0 * f64::from(MAP)) as u32);
    let mut canvas = Canvas::new(LEFT + extent.0 + RIGHT, TOP + extent.1 + BOTTOM);
    canvas.text("Shape of the board, object units", 20, (LEFT, TOP / 2));
    let levels = linear(0.0, highest);
    canvas.paint(|area| {
        shades(area, extent, &heights, highest);
        lines(area, extent, &heights, &levels);
        dots(area, extent, calibration, board);
        axes(area, extent, board);
        scale(area, extent, &levels, highest);
    });
    let sigma = sigmas.iter().copied().fold(0.0, f64::max);
    let said =
        format!("{} from the lowest to the highest place; standard deviation of a coefficient {} at most", plain(highest), plain(sigma));
    canvas.text(&said, 16, (LEFT, TOP + extent.1 + BOTTOM - 20));
    Some(canvas)
}

fn node((x, y): (f64, f64), extent: (u32, u32)) -> (i32, i32) {
    let along = |part: f64, px: u32| (part / (PLACES - 1) as f64 * f64::from(px)).round() as i32;
    (LEFT as i32 + along(x, extent.0), TOP as i32 + along(y, extent.1))
}

fn shades(area: &Area<'_>, extent: (u32, u32), heights: &[f64], highest: f64) {
    let last = (PLACES - 1) as f64;
    for (k, height) in heights.iter().enumerate() {
        let (x, y) = ((k % PLACES) as f64, (k / PLACES) as f64);
        let corner = |side: f64| node(((x + side).clamp(0.0, last), (y + side).clamp(0.0, last)), extent);
        area.draw(&Rectangle::new([corner(-0.5), corner(0.5)], shade(height / highest).filled())).ok();
    }
}

fn lines(area: &Area<'_>, extent: (u32, u32), heights: &[f64], levels: &[f64]) {
    for level in levels.iter().filter(|level| **level > 0.0) {
        for ends in contour(heights, (PLACES, PLACES), *level) {
            let ends = ends.map(|end| node(end, extent));
            for (colour, width) in [(WHITE, 3), (BLACK, 1)] {
                area.draw(&PathElement::new(ends.to_vec(), colour.stroke_width(width))).ok();
            }
        }
    }
}

fn dots(area: &Area<'_>, extent: (u32, u32), calibration: &Calibration<'_>, board: &Board) {
    let fixed = calibration.prepared.network.points.iter().filter(|point| point.coordinates == [Status::Fixed; 3]);
    for [u, v] in fixed.map(|point| board.place(&point.position)) {
        let half = 0.5 * (PLACES - 1) as f64;
        let at = node(((1.0 + u) * half, (1.0 - v) * half), extent);
        area.draw(&Circle::new(at, 3, WHITE.filled())).ok();
        area.draw(&Circle::new(at, 2, BLACK.filled())).ok();
    }
}

fn axes(area: &Area<'_>, (width, height): (u32, u32), board: &Board) {
    let (left, up, width, height) = (LEFT as i32, TOP as i32, width as i32, height as i32);
    area.draw(&Rectangle::new([(left, up), (left + width, up + height)], BLACK)).ok();
    let [u, v] = [0, 1].map(|i| board.middle.coords.dot(&board.axes[i]));
    for i in 0..=4 {
        let part = f64::from(i) / 4.0;
        let along = |middle: f64, half: f64, part: f64| plain_place(middle + half * (2.0 * part - 1.0), half);
        write(area, &along(u, board.half[0], part), (left + width * i / 4, up + height + 14), HPos::Center);
        write(area, &along(v, board.half[1], 1.0 - part), (left - 8, up + height * i / 4), HPos::Right);
    }
    write(area, &format!("u = {}, object units", direction(board, 0)), (left + width / 2, up + height + 34), HPos::Center);
    write(area, &format!("v = {}", direction(board, 1)), (left - 8, up - 14), HPos::Right);
}

/// A coordinate with the digits that the board's size leaves.
fn plain_place(value: f64, half: f64) -> String {
    let digits = (1 - half.log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.digits$}");
    if text.trim_start_matches(['-', '0', '.']).is_empty() { "0".into() } else { text }
}

/// The object's axis along which one of the board's lies, or what it is made of.
fn direction(board: &Board, axis: usize) -> String {
    let axis = board.axes[axis];
    let along = ["X", "Y", "Z"].into_iter().zip(axis.iter()).find(|(_, part)| part.abs() > 1.0 - 1e-6);
    along.map_or_else(
        || format!("({:.2}, {:.2}, {:.2})", axis.x, axis.y, axis.z),
        |(name, part)| if *part < 0.0 { format!("-{name}") } else { name.to_owned() },
    )
}

fn scale(area: &Area<'_>, extent: (u32, u32), levels: &[f64], highest: f64) {
    let (x, up, down) = shades_beside(area, extent);
    for level in levels {
        let y = down - (level / highest * f64::from(down - up)).round() as i32;
        area.draw(&PathElement::new([(x + 20, y), (x + 25, y)], BLACK)).ok();
        write(area, &plain(*level), (x + 30, y), HPos::Left);
    }
}
