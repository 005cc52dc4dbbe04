//! The camera's error by what changes, a curve for each board.

use plotters::prelude::*;

use super::load::{Camera, Comparison, kind};
use crate::Canvas;
use crate::axes::Axes;
use crate::canvas::{COLOURS, Mark, OwnMark};
use crate::sweep::titled;

const WIDTH: i32 = 520;
const HEIGHT: i32 = 320;
/// No two boards share shape and colour.
const MARKS: [Mark; 5] = [Mark::Cross, Mark::Circle, Mark::Triangle, Mark::Diamond, Mark::Square];

/// Curves over the places of the values; `None` where no camera was calibrated.
pub fn picture(sweep: &Comparison) -> Option<Canvas> {
    let (boards, values) = (sweep.boards(), sweep.values());
    let camera = |board: usize, value: usize| sweep.camera(board, value, sweep.method(board, value)?);
    let curves: Vec<Vec<(usize, Camera)>> =
        (0..boards.len()).map(|board| (0..values.len()).filter_map(|value| Some((value, camera(board, value)?))).collect()).collect();
    let all = || curves.iter().flatten().map(|(_, camera)| camera.error.0.log10());
    let (low, high) = (all().fold(f64::INFINITY, f64::min), all().fold(f64::NEG_INFINITY, f64::max));
    if low > high {
        return None;
    }
    let mut canvas = Canvas::new((WIDTH + 320) as u32, (HEIGHT + 130) as u32);
    canvas.text("Error of the camera over the frame, px (logarithmic), by board", 19, (20, 14));
    let axes =
        Axes { at: [80, 60, WIDTH, HEIGHT], x: [-0.3, values.len() as f64 - 0.7], y: [low.floor(), high.ceil().max(low.floor() + 1.0)] };
    let title = titled(&sweep.sweep.sweep.axes[1]);
    canvas.say_as(["board", &title, "error of the camera, px", "95 % from", "to", "trials"]);
    canvas.paint(|area| {
        axes.decades(area, "");
        axes.named(area, &title, &values.iter().map(String::as_str).collect::<Vec<_>>());
    });
    let look = |board: usize| (MARKS[board % MARKS.len()], COLOURS[board % COLOURS.len()]);
    let mut marks: Vec<OwnMark<'_>> = Vec::new();
    for (board, points) in curves.iter().enumerate() {
        let (name, (mark, colour)) = (kind(boards[board]), look(board));
        let line: Vec<(i32, i32)> = points.iter().map(|(value, camera)| axes.place(*value as f64, camera.error.0.log10())).collect();
        let places: Vec<(f64, f64)> = line.iter().map(|(x, y)| (f64::from(*x), f64::from(*y))).collect();
        marks.extend(places.iter().map(|at| (Some(name), (mark, colour, *at))));
        canvas.of(Some(name), |canvas| {
            canvas.paint(|area| {
                area.draw(&PathElement::new(line, ShapeStyle::from(&colour).stroke_width(2))).ok();
            });
            for ((value, camera), at) in points.iter().zip(places) {
                let (error, half) = camera.error;
                let ends = half.map(|half| (error - half, error + half));
                canvas.say_estimate(at, &[name, &values[*value]], (error, ends), &[&sweep.trials(board, *value).to_string()]);
            }
        });
    }
    for (board, word) in boards.iter().enumerate() {
        let (y, (mark, colour)) = (80 + 28 * board as i32, look(board));
        marks.push((Some(kind(word)), (mark, colour, (f64::from(WIDTH + 110), f64::from(y)))));
        canvas.of(Some(kind(word)), |canvas| canvas.text(kind(word), 16, ((WIDTH + 130) as u32, y as u32)));
    }
    canvas.marks_of(&marks);
    Some(canvas)
}
