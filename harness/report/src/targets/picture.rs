//! The camera's error by what changes, a curve for each board.

use plotters::prelude::*;

use super::load::{Comparison, kind};
use crate::Canvas;
use crate::axes::Axes;
use crate::canvas::{COLOURS, Mark};
use crate::sweep::titled;

const WIDTH: i32 = 520;
const HEIGHT: i32 = 320;
/// No two boards share shape and colour.
const MARKS: [Mark; 5] = [Mark::Cross, Mark::Circle, Mark::Triangle, Mark::Diamond, Mark::Square];

/// Curves over the places of the values; `None` where no camera was calibrated.
pub fn picture(sweep: &Comparison) -> Option<Canvas> {
    let (boards, values) = (sweep.boards(), sweep.values());
    let error = |board: usize, value: usize| Some(sweep.camera(board, value, sweep.method(board, value)?)?.error.0);
    let curves: Vec<Vec<(f64, f64)>> = (0..boards.len())
        .map(|board| (0..values.len()).filter_map(|value| Some((value as f64, error(board, value)?.log10()))).collect())
        .collect();
    let all = || curves.iter().flatten().map(|(_, y)| *y);
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        return None;
    }
    let mut canvas = Canvas::new((WIDTH + 320) as u32, (HEIGHT + 130) as u32);
    canvas.text("Error of the camera over the frame, px (logarithmic), by board", 19, (20, 14));
    let axes =
        Axes { at: [80, 60, WIDTH, HEIGHT], x: [-0.3, values.len() as f64 - 0.7], y: [low.floor(), high.ceil().max(low.floor() + 1.0)] };
    let mut marks = Vec::new();
    canvas.paint(|area| {
        axes.decades(area, "");
        axes.named(area, &titled(&sweep.sweep.sweep.axes[1]), &values.iter().map(String::as_str).collect::<Vec<_>>());
        for (board, points) in curves.iter().enumerate() {
            let line: Vec<(i32, i32)> = points.iter().map(|(x, y)| axes.place(*x, *y)).collect();
            let (mark, colour) = (MARKS[board % MARKS.len()], COLOURS[board % COLOURS.len()]);
            marks.extend(line.iter().map(|(x, y)| (mark, colour, (f64::from(*x), f64::from(*y)))));
            area.draw(&PathElement::new(line, ShapeStyle::from(&colour).stroke_width(2))).ok();
        }
    });
    for (board, word) in boards.iter().enumerate() {
        let y = 80 + 28 * board as i32;
        marks.push((MARKS[board % MARKS.len()], COLOURS[board % COLOURS.len()], (f64::from(WIDTH + 110), f64::from(y))));
        canvas.text(kind(word), 16, ((WIDTH + 130) as u32, y as u32));
    }
    canvas.marks(&marks);
    Some(canvas)
}
