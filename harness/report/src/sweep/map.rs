//! A figure over two swept keys as shades with the figure in each cell, in panels.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axes::Scale;
use super::layout::{Dimension, Layout};
use crate::canvas::Canvas;
use crate::field::{Area, shade, write};
use crate::load::sweep::LoadedSweep;
use crate::markdown::plain;

/// A cell of the map, px of the picture.
const CELL: (u32, u32) = (74, 44);
const LEFT: u32 = 100;
const TOP: u32 = 46;
const RIGHT: u32 = 24;
const BOTTOM: u32 = 60;
const LINE: u32 = 26;

/// The sweep as a map: one shade a cell, the figure written in it; cells are of equal size whatever the steps.
pub fn map(loaded: &LoadedSweep, layout: &Layout) -> Canvas {
    let panels = layout.panels(loaded);
    let (columns, rows) = (layout.shown(loaded, Dimension::Axis(layout.x)), layout.shown(loaded, layout.by));
    let at = |panel: usize, column: usize, row: usize| panels[panel].1.with(Dimension::Axis(layout.x), column).with(layout.by, row);
    let value = |panel, column, row| layout.estimate(loaded, &at(panel, column, row)).map(|found| found.value);
    let all: Vec<f64> = (0..panels.len())
        .flat_map(|panel| columns.iter().flat_map(move |&column| rows_of(layout, loaded).into_iter().map(move |row| (panel, column, row))))
        .filter_map(|(panel, column, row)| value(panel, column, row))
        .collect();
    let scale = Scale::of(all.iter().copied());
    let inside = (columns.len() as u32 * CELL.0, rows.len() as u32 * CELL.1);
    let (width, height) = (LEFT + inside.0 + RIGHT, TOP + inside.1 + BOTTOM);
    let across = (1710 / width).clamp(1, panels.len().max(1) as u32);
    let down = (panels.len() as u32).div_ceil(across);
    let mut canvas = Canvas::new(across * width, down * height + 3 * LINE);
    for (index, (title, _)) in panels.iter().enumerate() {
        let (x, y) = (index as u32 % across * width + LEFT, index as u32 / across * height + TOP);
        canvas.paint(|area: &Area<'_>| {
            for (i, &column) in columns.iter().enumerate() {
                for (j, &row) in rows.iter().enumerate() {
                    let corner = ((x + i as u32 * CELL.0) as i32, (y + (rows.len() - 1 - j) as u32 * CELL.1) as i32);
                    cell(area, corner, value(index, column, row), &scale);
                }
            }
            let (right, bottom) = ((x + inside.0) as i32, (y + inside.1) as i32);
            area.draw(&Rectangle::new([(x as i32, y as i32), (right, bottom)], BLACK)).ok();
            for (i, &column) in columns.iter().enumerate() {
                let label = super::layout::value(loaded, Dimension::Axis(layout.x), column);
                write(area, &label, ((x + i as u32 * CELL.0 + CELL.0 / 2) as i32, bottom + 14), HPos::Center);
            }
            for (j, &row) in rows.iter().enumerate() {
                let middle = bottom - (j as u32 * CELL.1 + CELL.1 / 2) as i32;
                write(area, &super::layout::value(loaded, layout.by, row), (x as i32 - 8, middle), HPos::Right);
            }
            write(area, &super::units::titled(&loaded.sweep.axes[layout.x]), ((x + inside.0 / 2) as i32, bottom + 38), HPos::Center);
            write(area, &super::layout::title(loaded, layout.by), (x as i32 - 92, y as i32 - 14), HPos::Left);
            write(area, title, (right, y as i32 - 14), HPos::Right);
        });
    }
    legend(&mut canvas, &scale, &format!("{}{}", layout.metric.title(), layout.held(loaded)), down * height);
    canvas
}

fn rows_of(layout: &Layout, loaded: &LoadedSweep) -> Vec<usize> {
    layout.shown(loaded, layout.by)
}

fn cell(area: &Area<'_>, (x, y): (i32, i32), value: Option<f64>, scale: &Scale) {
    let (right, bottom) = (x + CELL.0 as i32, y + CELL.1 as i32);
    let part = value.map(|value| scale.part(value));
    let colour = part.map_or(WHITE, shade);
    area.draw(&Rectangle::new([(x, y), (right, bottom)], colour.filled())).ok();
    let text = value.map_or_else(|| "none".to_owned(), plain);
    let ink = if part.is_some_and(|part| part > 0.6) { WHITE } else { BLACK };
    let style = ("sans-serif", 16).into_font().color(&ink).pos(Pos::new(HPos::Center, VPos::Center));
    area.draw(&Text::new(text, ((x + right) / 2, (y + bottom) / 2), style)).ok();
}

/// The shades with their values, in a line.
fn legend(canvas: &mut Canvas, scale: &Scale, title: &str, top: u32) {
    let (left, right) = (LEFT as i32, (canvas.width() - RIGHT) as i32);
    let top = top as i32;
    canvas.paint(|area: &Area<'_>| {
        write(area, title, (left, top + 10), HPos::Left);
        for x in left..right {
            let part = f64::from(x - left) / f64::from(right - left);
            area.draw(&PathElement::new([(x, top + 26), (x, top + 44)], shade(part))).ok();
        }
        area.draw(&Rectangle::new([(left, top + 26), (right, top + 44)], BLACK)).ok();
        for (value, label) in scale.ticks() {
            let x = left + (scale.part(value) * f64::from(right - left)).round() as i32;
            area.draw(&PathElement::new([(x, top + 44), (x, top + 49)], BLACK)).ok();
            write(area, &label, (x, top + 60), HPos::Center);
        }
    });
}
