//! What distortion does to straight lines: a square grid, seen by cameras.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel};
use calibench_records::description::Printed;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::Canvas;
use crate::field::{stretch, write};
use crate::markdown::plain;

/// Squares along the longer side.
const SQUARES: f64 = 12.0;
/// The share of a square by which the last one may leave the frame.
const NEARLY: f64 = 0.01;
/// Places on a line from one crossing to the next.
const FINE: usize = 6;
/// Width of the frame in a panel, px of the picture.
const PANEL: f64 = 380.0;
/// Around the frame, as a share of its width: lines bent outwards leave it.
const ROOM: f64 = 0.1;
const COLUMNS: usize = 3;
const LEFT: i32 = 20;
const TOP: i32 = 60;
/// Below a panel, px of the picture.
const WORDS: i32 = 80;
/// The longest displacement as it is drawn, as a share of the frame's width: shorter ones are lengthened to about the first, if they are below the second.
const DRAWN: (f64, f64) = (0.08, 0.03);
const IDEAL: RGBColor = RGBColor(150, 150, 150);
const SEEN: RGBColor = RGBColor(0, 114, 178);

/// A grid as a camera sees it.
pub(super) struct Grid {
    pub(super) name: String,
    /// Lines, each of places without distortion and where the camera has them, px. What the camera does not picture is left out.
    pub(super) lines: Vec<Vec<(PixelPoint, PixelPoint)>>,
    /// Columns and rows of the frame.
    size: [u32; 2],
}

impl Grid {
    /// The grids of all cameras that are to be shown so.
    pub(super) fn all(printed: &Printed) -> Vec<Self> {
        let of = |shown| {
            let (camera, ideal): (Camera, Camera) = (printed.camera(shown).into(), printed.undistorted(shown).into());
            let seen = |at: PixelPoint| Some((at, camera.project(ideal.unproject(at).ok()?).ok()?));
            let lines = lines(printed.size).into_iter().map(|line| line.into_iter().filter_map(seen).collect()).collect();
            Self { name: shown.name.clone(), lines, size: printed.size }
        };
        printed.grids.iter().map(of).collect()
    }

    /// The longest displacement, px.
    pub(super) fn longest(&self) -> f64 {
        self.lines.iter().flatten().map(|(ideal, seen)| ideal.distance(*seen)).fold(0.0, f64::max)
    }

    /// How many times too long displacements are drawn.
    pub(super) fn times(&self) -> f64 {
        let (width, longest) = (f64::from(self.size[0]), self.longest());
        if longest >= DRAWN.1 * width { 1.0 } else { stretch(DRAWN.0 * width, longest).max(1.0) }
    }

    /// The displacement and how it is drawn.
    pub(super) fn words(&self) -> String {
        let times = self.times();
        let drawn = if times == 1.0 { "drawn to scale".to_owned() } else { format!("drawn {times} times too large") };
        format!("at most {} px, {drawn}", plain(self.longest()))
    }
}

/// The lines of a grid of squares about the middle of a frame, without distortion, px.
fn lines([width, height]: [u32; 2]) -> Vec<Vec<PixelPoint>> {
    let (x, y) = (0.5 * (f64::from(width) - 1.0), 0.5 * (f64::from(height) - 1.0));
    let side = 2.0 * x.max(y) / SQUARES;
    let count = |half: f64| (half / side + NEARLY).floor() as i64;
    let (columns, rows) = (count(x), count(y));
    let fine = FINE as i64;
    let place = |column: f64, row: f64| PixelPoint::new(x + side * column, y + side * row);
    let part = |step: i64| step as f64 / FINE as f64;
    let across = (-rows..=rows).map(|row| (-columns * fine..=columns * fine).map(|step| place(part(step), row as f64)).collect());
    let down = (-columns..=columns).map(|column| (-rows * fine..=rows * fine).map(|step| place(column as f64, part(step))).collect());
    across.chain(down).collect()
}

/// A panel for each grid; `None` without any.
pub(super) fn picture(grids: &[Grid]) -> Option<Canvas> {
    let [width, height] = grids.first()?.size.map(f64::from);
    let scale = PANEL / width;
    let (wide, high) = ((PANEL * (1.0 + 2.0 * ROOM)).round() as i32, (scale * height + 2.0 * ROOM * PANEL).round() as i32);
    let (columns, rows) = (grids.len().min(COLUMNS) as i32, grids.len().div_ceil(COLUMNS) as i32);
    let mut canvas = Canvas::new((2 * LEFT + columns * wide) as u32, (TOP + rows * (high + WORDS) + 20) as u32);
    for (index, grid) in grids.iter().enumerate() {
        let (left, top) = (LEFT + (index % COLUMNS) as i32 * wide, TOP + (index / COLUMNS) as i32 * (high + WORDS));
        let place = |at: PixelPoint| {
            let (corner, room) = (at.to_corner(), ROOM * PANEL);
            (left + (room + scale * corner.x).round() as i32, top + (room + scale * corner.y).round() as i32)
        };
        let times = grid.times();
        let drawn = |(ideal, seen): &(PixelPoint, PixelPoint)| {
            place(PixelPoint::new(ideal.x + times * (seen.x - ideal.x), ideal.y + times * (seen.y - ideal.y)))
        };
        canvas.paint(|area| {
            for line in &grid.lines {
                let ideal: Vec<_> = line.iter().map(|(ideal, _)| place(*ideal)).collect();
                // Every other piece: a dashed line.
                for piece in ideal.windows(2).step_by(2) {
                    area.draw(&PathElement::new(piece.to_vec(), IDEAL)).ok();
                }
            }
            for line in &grid.lines {
                area.draw(&PathElement::new(line.iter().map(drawn).collect::<Vec<_>>(), SEEN.stroke_width(2))).ok();
            }
            let middle = left + wide / 2;
            write(area, &grid.name, (middle, top - 16), HPos::Center);
            write(area, &grid.words(), (middle, top + high + 14), HPos::Center);
        });
    }
    canvas.text("dashed: without distortion; solid: as the camera has it", 16, (LEFT as u32, (TOP + rows * (high + WORDS) - 10) as u32));
    Some(canvas)
}
