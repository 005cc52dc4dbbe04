//! Operator by model: hold-out RMS with its interval.

use calibench_records::judgement::{Cell, Estimate, Summary, Trusted};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::canvas::Canvas;
use crate::field::{shade, write};
use crate::plain;

const CELL: (i32, i32) = (150, 54);
const TOP: i32 = 100;
const GAP: i32 = 20;
/// Width of a letter, px of the picture, about.
const LETTER: i32 = 9;

/// Where a hold-out RMS stands among all of them, 0 to 1, on a logarithmic scale.
pub fn scale(summary: &Summary) -> impl Fn(f64) -> f64 + use<> {
    let values = summary.cells.iter().filter_map(|cell| Some(cell.holdout?.value)).filter(|value| *value > 0.0);
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    move |value| if high > low { (value / low).ln() / (high / low).ln() } else { 0.0 }
}

/// The matrix; the darker the larger, on a logarithmic scale.
pub fn picture(summary: &Summary, trusted: &Trusted<'_>) -> Canvas {
    let methods: Vec<&str> = summary.methods.iter().filter(|method| method.unavailable.is_none()).map(|method| &*method.method).collect();
    let longest = methods.iter().map(|name| name.chars().count()).max().unwrap_or(0) as i32;
    let left = GAP + longest * LETTER + 10;
    let (columns, rows) = (summary.models.len() as i32, methods.len() as i32);
    let mut canvas = Canvas::new((left + columns * CELL.0 + GAP) as u32, (TOP + rows * CELL.1 + GAP) as u32);
    let part = scale(summary);
    canvas.text("Hold-out RMS, px, and its 95 % interval over views", 20, (GAP as u32, 20));
    canvas.paint(|area| {
        for (column, model) in (0..).zip(&summary.models) {
            let (name, solved) = model.split_once(':').unwrap_or((model, ""));
            let x = left + column * CELL.0 + CELL.0 / 2;
            write(area, name, (x, TOP - 36), HPos::Center);
            write(area, solved, (x, TOP - 16), HPos::Center);
        }
        for (row, method) in (0..).zip(&methods) {
            write(area, method, (left - 10, TOP + row * CELL.1 + CELL.1 / 2), HPos::Right);
            for (column, model) in (0..).zip(&summary.models) {
                let corner = (left + column * CELL.0, TOP + row * CELL.1);
                let found = summary.cell(method, model).and_then(|cell| cell.holdout);
                cell(area, corner, found, found.map_or(0.0, |found| part(found.value)));
            }
        }
        let frame = |chosen: &Cell, width: u32| {
            let row = methods.iter().position(|method| **method == *chosen.method);
            let column = summary.models.iter().position(|model| *model == chosen.model);
            if let (Some(row), Some(column)) = (row, column) {
                let (x, y) = (left + column as i32 * CELL.0, TOP + row as i32 * CELL.1);
                let style = ShapeStyle::from(&RGBColor(213, 94, 0)).stroke_width(width);
                area.draw(&Rectangle::new([(x + 2, y + 2), (x + CELL.0 - 3, y + CELL.1 - 3)], style)).ok();
            }
        };
        frame(trusted.least, 4);
        frame(trusted.cell, 2);
    });
    canvas
}

fn cell(area: &crate::field::Area<'_>, (x, y): (i32, i32), found: Option<Estimate>, part: f64) {
    let corners = [(x + 1, y + 1), (x + CELL.0 - 2, y + CELL.1 - 2)];
    let Some(found) = found else {
        area.draw(&Rectangle::new(corners, BLACK.mix(0.3))).ok();
        write(area, "not judged", (x + CELL.0 / 2, y + CELL.1 / 2), HPos::Center);
        return;
    };
    area.draw(&Rectangle::new(corners, shade(part).filled())).ok();
    let colour = if part > 0.55 { WHITE } else { BLACK };
    let (low, high) = found.interval;
    for (text, size, dy) in [(plain(found.value), 20, -9), (format!("{} to {}", plain(low), plain(high)), 15, 12)] {
        let style = ("sans-serif", size).into_font().color(&colour);
        let style = style.pos(plotters::style::text_anchor::Pos::new(HPos::Center, plotters::style::text_anchor::VPos::Center));
        area.draw(&Text::new(text, (x + CELL.0 / 2, y + CELL.1 / 2 + dy), style)).ok();
    }
}
