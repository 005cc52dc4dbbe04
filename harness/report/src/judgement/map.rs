//! Over the frame: how far halves differ, and how far they should.

use calibench_records::judgement::Cell;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::canvas::Canvas;
use crate::field::{LEFT, TOP, colour_bar, shade, write};

/// x, y, RMS difference and the predicted one.
type Place = (f64, f64, f64, f64);
/// What a panel shows of a place.
type Shown = fn(&Place) -> f64;

const MAP: u32 = 460;
const GAP: u32 = 60;
const RIGHT: u32 = 130;
const BOTTOM: u32 = 80;

/// Columns and rows of the places, px.
pub fn grid(places: &[Place]) -> [Vec<f64>; 2] {
    [|place: &Place| place.0, |place: &Place| place.1].map(|of: fn(&Place) -> f64| {
        let mut ticks: Vec<f64> = places.iter().map(of).collect();
        ticks.sort_by(f64::total_cmp);
        ticks.dedup();
        ticks
    })
}

/// Two maps with one scale. `None` without halves.
pub fn picture(cell: &Cell) -> Option<Canvas> {
    let places = &cell.map;
    let [xs, ys] = grid(places);
    let (width, height) = (xs.last()? + 1.0, ys.last()? + 1.0);
    let map = (MAP, (f64::from(MAP) * height / width).round() as u32);
    let most = places.iter().map(|place| place.2.max(place.3)).fold(f64::MIN_POSITIVE, f64::max);
    let both = (2 * MAP + GAP, map.1);
    let mut canvas = Canvas::new(LEFT + both.0 + RIGHT, TOP + map.1 + BOTTOM);
    let split = cell.split?;
    canvas.paint(|area| {
        let panels: [(&str, Shown); 2] =
            [("RMS difference of halves", |place| place.2), ("predicted by their covariances", |place| place.3)];
        for (panel, (title, of)) in (0..).zip(panels) {
            let left = (LEFT + panel * (MAP + GAP)) as i32;
            write(area, title, (left + MAP as i32 / 2, TOP as i32 - 16), HPos::Center);
            let edge = |ticks: &[f64], value: f64, px: u32| {
                let at = ticks.partition_point(|tick| *tick < value);
                [at, at + 1].map(|i| (i as f64 / ticks.len() as f64 * f64::from(px)).round() as i32)
            };
            for place in places {
                let ([x0, x1], [y0, y1]) = (edge(&xs, place.0, map.0), edge(&ys, place.1, map.1));
                let corners = [(left + x0, TOP as i32 + y0), (left + x1, TOP as i32 + y1)];
                area.draw(&Rectangle::new(corners, shade(of(place) / most).filled())).ok();
            }
            let (right, down) = (left + map.0 as i32, (TOP + map.1) as i32);
            area.draw(&Rectangle::new([(left, TOP as i32), (right, down)], BLACK)).ok();
            for i in 0..=4 {
                let part = f64::from(i) / 4.0;
                write(area, &format!("{}", (part * width).round()), (left + map.0 as i32 * i / 4, down + 14), HPos::Center);
                if panel == 0 {
                    write(area, &format!("{}", (part * height).round()), (left - 8, TOP as i32 + map.1 as i32 * i / 4), HPos::Right);
                }
            }
            write(area, "x, px", (left + map.0 as i32 / 2, down + 34), HPos::Center);
        }
        write(area, "y, px", (LEFT as i32 - 8, TOP as i32 - 14), HPos::Right);
        colour_bar(area, both, most);
    });
    let said = format!(
        "over the frame {} px in place of {} px, {} splits",
        crate::plain(split.difference),
        crate::plain(split.predicted),
        split.count
    );
    canvas.text(&said, 16, (LEFT, TOP + map.1 + BOTTOM - 18));
    Some(canvas)
}
