//! A figure over two swept keys as shades with the figure in each cell, in panels.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::axes::Scale;
use super::layout::{At, Dimension, Layout};
use super::metric::Estimate;
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
    let values: Vec<f64> =
        panels.iter().flat_map(|(_, start)| cells(loaded, layout, start)).filter_map(|cell| Some(cell.found?.value)).collect();
    let scale = Scale::of(values.into_iter());
    let inside = (columns.len() as u32 * CELL.0, rows.len() as u32 * CELL.1);
    let (width, height) = (LEFT + inside.0 + RIGHT, TOP + inside.1 + BOTTOM);
    let across = (1710 / width).clamp(1, panels.len().max(1) as u32);
    let down = (panels.len() as u32).div_ceil(across);
    let mut canvas = Canvas::new(across * width, down * height + 3 * LINE);
    let facet = layout.facet.map_or_else(String::new, |facet| super::layout::title(loaded, facet));
    let (across_title, up_title) = (super::units::titled(&loaded.sweep.axes[layout.x]), super::layout::title(loaded, layout.by));
    canvas.say_as([&*facet, &up_title, &across_title, layout.metric.title(), "95 % from", "to", "trials"]);
    for (index, panel) in panels.iter().enumerate() {
        let (x, y) = (index as u32 % across * width + LEFT, index as u32 / across * height + TOP);
        // A panel of a method is hidden with it.
        let method = (layout.facet == Some(Dimension::Method)).then_some(&*panel.0);
        canvas.of(method, |canvas| {
            say(canvas, (loaded, layout), panel, (x, y));
            canvas.paint(|area: &Area<'_>| draw(area, (loaded, layout), panel, (x, y), &scale));
        });
    }
    legend(&mut canvas, &scale, &format!("{}{}", layout.metric.title(), layout.held(loaded)), down * height);
    canvas
}

/// A panel whose upper left corner is (`x`, `y`): its cells, its frame, the values along it.
fn draw(area: &Area<'_>, (loaded, layout): (&LoadedSweep, &Layout), (title, start): &(String, At), (x, y): (u32, u32), scale: &Scale) {
    let along = Dimension::Axis(layout.x);
    let (columns, rows) = (layout.shown(loaded, along), layout.shown(loaded, layout.by));
    for Cell { across, down, found, .. } in cells(loaded, layout, start) {
        let corner = ((x + across * CELL.0) as i32, (y + down * CELL.1) as i32);
        cell(area, corner, found.map(|found| found.value), scale);
    }
    let (right, bottom) = ((x + columns.len() as u32 * CELL.0) as i32, (y + rows.len() as u32 * CELL.1) as i32);
    area.draw(&Rectangle::new([(x as i32, y as i32), (right, bottom)], BLACK)).ok();
    for (i, &column) in columns.iter().enumerate() {
        write(area, &super::layout::value(loaded, along, column), ((x + i as u32 * CELL.0 + CELL.0 / 2) as i32, bottom + 14), HPos::Center);
    }
    for (j, &row) in rows.iter().enumerate() {
        let middle = bottom - (j as u32 * CELL.1 + CELL.1 / 2) as i32;
        write(area, &super::layout::value(loaded, layout.by, row), (x as i32 - 8, middle), HPos::Right);
    }
    write(area, &super::units::titled(&loaded.sweep.axes[layout.x]), ((x as i32 + right) / 2, bottom + 38), HPos::Center);
    write(area, &super::layout::title(loaded, layout.by), (x as i32 - 92, y as i32 - 14), HPos::Left);
    write(area, title, (right, y as i32 - 14), HPos::Right);
}

/// Says the figure of each cell of a panel whose upper left corner is (`x`, `y`).
fn say(canvas: &mut Canvas, (loaded, layout): (&LoadedSweep, &Layout), (title, start): &(String, At), (x, y): (u32, u32)) {
    let panel = layout.facet.map_or("", |_| title.rsplit(" = ").next().unwrap_or(title));
    for Cell { across, down, at, found } in cells(loaded, layout, start) {
        let Some(found) = found else { continue };
        let middle = |corner: u32, place: u32, side: u32| f64::from(corner) + (f64::from(place) + 0.5) * f64::from(side);
        let trials = loaded.cells.get(at.cell(loaded)).map_or(0, |cell| cell.trials).to_string();
        let names = [layout.by, Dimension::Axis(layout.x)].map(|dimension| super::layout::value(loaded, dimension, at.place(dimension)));
        let middle = (middle(x, across, CELL.0), middle(y, down, CELL.1));
        canvas.say_estimate(middle, &[panel, &names[0], &names[1]], (found.value, found.interval), &[&trials]);
    }
}

/// A cell of a panel: its place from the left and from above, which it is of the sweep, what was found there.
struct Cell {
    across: u32,
    down: u32,
    at: At,
    found: Option<Estimate>,
}

/// The cells of the panel that goes on from `start`.
fn cells(loaded: &LoadedSweep, layout: &Layout, start: &At) -> Vec<Cell> {
    let along = Dimension::Axis(layout.x);
    let (columns, rows) = (layout.shown(loaded, along), layout.shown(loaded, layout.by));
    let mut cells = Vec::new();
    for (across, &column) in (0..).zip(&columns) {
        // Rows are drawn upwards.
        for (down, &row) in (0..rows.len() as u32).rev().zip(&rows) {
            let at = start.with(along, column).with(layout.by, row);
            cells.push(Cell { across, down, found: layout.estimate(loaded, &at), at });
        }
    }
    cells
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::Stroke;
    use crate::sweep::{Choice, Metric};
    use crate::tests::swept::loaded;

    /// Each cell that has a figure says it where it lies, with its interval and its trials; a panel of a method is hidden with it.
    #[test]
    fn a_cell_says_its_figure() {
        let loaded = loaded();
        let choice = Choice { by: Some("noise".into()), ..Choice::default() };
        let canvas = map(&loaded, &Layout::new(&loaded, &choice, Metric::MeanX, true).unwrap());
        assert_eq!(canvas.series(), ["other", "m"]);
        assert_eq!(canvas.says(), ["method", "noise", "blur, px", Metric::MeanX.title(), "95 % from", "to", "trials"]);
        let said: Vec<(&(i32, i32), &Vec<String>)> = canvas
            .strokes()
            .iter()
            .filter_map(|stroke| if let Stroke::Said(at, values) = stroke { Some((at, values)) } else { None })
            .collect();
        assert_eq!(said.len(), 4 + 3, "nothing was measured in the last cell of the second method");
        // The second method's panel: noise upwards, blur to the right; the first column has noise 0 below and 0.1 above it.
        let [(below, first), (above, second), (aside, third)] = said[4..] else { panic!("{said:?}") };
        assert_eq!((first[..4].join(" "), &*first[6]), ("m 0 0.5 2.00".to_owned(), "2"));
        let interval = loaded.cells[0].scores[1].whole.dx.interval(0.95).unwrap();
        assert_eq!(first[4..6], [plain(interval.0), plain(interval.1)]);
        assert_eq!((second[..4].join(" "), &*second[4]), ("m 0.1 0.5 0.500".to_owned(), "\u{2013}"), "one error has no interval");
        assert_eq!(third[..4].join(" "), "m 0 2 0");
        assert_eq!((below.0 - above.0, below.1 - above.1), (0, CELL.1 as i32));
        assert_eq!((aside.0 - below.0, aside.1 - below.1), (CELL.0 as i32, 0));
    }
}
