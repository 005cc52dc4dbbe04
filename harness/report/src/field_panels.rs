//! Vector fields over the same frame side by side, with one scale of colours and of arrows.

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use crate::Canvas;
use crate::field::{Area, Field, arrow, shade, stretch, write};
use crate::frame::Map;
use crate::levels::Scale;
use crate::markdown::plain;

/// Width of a panel, px of the picture.
const PANEL: u32 = 440;
const COLUMNS: usize = 2;
/// From panel to panel, px of the picture.
const GAP: (u32, u32) = (90, 100);
const LEFT: u32 = 70;
const TOP: u32 = 90;
/// Arrows across a panel, about.
const ARROWS: usize = 13;
/// The least length that is told apart, as a part of the largest.
const LEAST: f64 = 0.01;
/// The darkest colour, of those of [`shade`]: black arrows stay readable on it.
const DARKEST: f64 = 0.75;
/// Height of a colour in the legend, px of the picture.
const STEP: i32 = 28;

/// Round lengths between which a colour stays the same, px; from the longest of all vectors down to a hundredth of it.
pub(crate) struct Bands {
    levels: Vec<f64>,
    top: f64,
}

impl Bands {
    /// Those of all `fields`; `None` where no vector has a length.
    pub(crate) fn of(fields: &[Field]) -> Option<Self> {
        let lengths: Vec<f64> = fields.iter().flat_map(|field| &field.vectors).filter_map(|(_, v)| *v).map(|(x, y)| x.hypot(y)).collect();
        let top = lengths.iter().copied().fold(0.0, f64::max);
        let told: Vec<f64> = lengths.into_iter().filter(|length| *length >= LEAST * top).collect();
        let mut levels = Scale::of(&told)?.levels();
        levels.retain(|level| *level < top);
        Some(Self { levels, top })
    }

    /// The colour of a length, px.
    pub(crate) fn colour(&self, length: f64) -> RGBColor {
        self.step(self.levels.iter().filter(|level| **level <= length).count())
    }

    fn step(&self, band: usize) -> RGBColor {
        shade(DARKEST * band as f64 / self.levels.len().max(1) as f64)
    }

    /// The colours from the shortest upwards, with the lengths at their borders.
    fn legend(&self, area: &Area<'_>, (x, y): (i32, i32)) {
        let count = self.levels.len() as i32 + 1;
        let down = y + count * STEP;
        for band in 0..count {
            let low = down - band * STEP;
            area.draw(&Rectangle::new([(x, low - STEP), (x + 24, low)], self.step(band as usize).filled())).ok();
            area.draw(&Rectangle::new([(x, low - STEP), (x + 24, low)], BLACK)).ok();
        }
        for (border, value) in (0..).zip([0.0].iter().chain(&self.levels).chain([&self.top])) {
            let text = if *value == self.top { plain(*value) } else { value.to_string() };
            write(area, &text, (x + 32, down - border * STEP), HPos::Left);
        }
        write(area, "px", (x, y - 14), HPos::Left);
    }
}

/// The picture of fields over frames of one size; `None` where there is nothing to see.
pub(crate) fn panels(title: &str, fields: &[Field]) -> Option<Canvas> {
    let bands = Bands::of(fields)?;
    let (width, height) = fields.first()?.size;
    let size = ImageSize { width, height };
    let rows = fields.len().div_ceil(COLUMNS) as u32;
    let columns = fields.len().min(COLUMNS) as u32;
    let extent = Map::new(size, (0, 0), PANEL).extent;
    let right = LEFT + columns * (PANEL + GAP.0);
    let bottom = TOP + rows * (extent.1 + GAP.1);
    let legend = 60 + (bands.levels.len() as u32 + 1) * STEP as u32;
    let mut canvas = Canvas::new(right + 60, (bottom + 20).max(TOP + legend));
    canvas.text(title, 20, (LEFT, 22));
    let times = stretch(f64::from(width) / ARROWS as f64 * 1.2, bands.top);
    for (place, field) in fields.iter().enumerate() {
        let (column, row) = ((place % COLUMNS) as u32, (place / COLUMNS) as u32);
        let corner = (LEFT + column * (PANEL + GAP.0), TOP + row * (extent.1 + GAP.1));
        let map = Map::new(size, corner, PANEL);
        canvas.paint(|area| {
            shades(area, &map, corner, field, &bands);
            map.axes(area);
            arrows(area, &map, field, times);
            write(area, &field.title, ((corner.0 + PANEL / 2) as i32, corner.1 as i32 - 14), HPos::Center);
        });
    }
    canvas.paint(|area| bands.legend(area, (right as i32 - 30, TOP as i32)));
    let drawn = if times == 1.0 { "arrows to scale".to_owned() } else { format!("arrows {times} times too long") };
    let gaps = fields.iter().any(|field| field.vectors.iter().any(|(_, vector)| vector.is_none()));
    canvas.text(&format!("{drawn}{}", if gaps { "; white: not compared" } else { "" }), 16, (LEFT, bottom - 6));
    Some(canvas)
}

/// A colour for every pixel of the map, from lengths between the nodes of the grid.
fn shades(area: &Area<'_>, map: &Map, (left, top): (u32, u32), field: &Field, bands: &Bands) {
    for row in 0..map.extent.1 {
        for column in 0..map.extent.0 {
            let part = |at: u32, of: u32, size: u32| (f64::from(at) + 0.5) / f64::from(of) * f64::from(size) - 0.5;
            let at = PixelPoint::new(part(column, map.extent.0, field.size.0), part(row, map.extent.1, field.size.1));
            if let Some((dx, dy)) = between(field, at) {
                area.draw_pixel(((left + column) as i32, (top + row) as i32), &bands.colour(dx.hypot(dy))).ok();
            }
        }
    }
}

/// The vector at a place, linear between the four nodes around it; `None` where one of them has none. Outside of the nodes that of the border.
pub(crate) fn between(field: &Field, at: PixelPoint) -> Option<(f64, f64)> {
    let (columns, rows) = field.grid;
    let (first, last) = (field.vectors.first()?.0, field.vectors.last()?.0);
    let along = |value: f64, low: f64, high: f64, count: usize| {
        let index = ((value - low) / (high - low) * (count - 1) as f64).clamp(0.0, (count - 1) as f64);
        let node = (index.floor() as usize).min(count.saturating_sub(2));
        (node, index - node as f64)
    };
    let ((column, u), (row, v)) = (along(at.x, first.x, last.x, columns), along(at.y, first.y, last.y, rows));
    let node = |c: usize, r: usize| field.vectors.get((row + r) * columns + column + c)?.1;
    let [a, b, c, d] = [node(0, 0)?, node(1, 0)?, node(0, 1)?, node(1, 1)?];
    let mix = |a: f64, b: f64, c: f64, d: f64| (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
    Some((mix(a.0, b.0, c.0, d.0), mix(a.1, b.1, c.1, d.1)))
}

fn arrows(area: &Area<'_>, map: &Map, field: &Field, times: f64) {
    let (columns, rows) = field.grid;
    let every = columns.max(rows).div_ceil(ARROWS).max(1);
    // Within the frame, and as far from both ends.
    let first = |count: usize| match (count - 1) % every {
        left @ 0..2 => (left + every) / 2,
        left => left / 2,
    };
    for row in (first(rows)..rows).step_by(every) {
        for column in (first(columns)..columns).step_by(every) {
            let (at, Some((dx, dy))) = field.vectors[row * columns + column] else { continue };
            arrow(area, map.place(at), map.place(PixelPoint::new(at.x + times * dx, at.y + times * dy)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A field of vectors (x / 100, y / 50) over 400 x 200 px; none beyond x = 300.
    fn field() -> Field {
        let nodes = (0..5).flat_map(|row| (0..9).map(move |column| PixelPoint::new(49.875 * f64::from(column), 49.75 * f64::from(row))));
        let mut field = Field::of("a", (400, 200), nodes.map(|at| (at, (at.x / 100.0, at.y / 50.0))));
        field.vectors.iter_mut().filter(|(at, _)| at.x > 300.0).for_each(|(_, vector)| *vector = None);
        field
    }

    #[test]
    fn between_nodes_a_linear_field_is_itself_and_has_no_value_beyond_a_gap() {
        for (x, y) in [(0.0, 0.0), (123.4, 77.7), (10.0, 199.0)] {
            let (dx, dy) = between(&field(), PixelPoint::new(x, y)).unwrap();
            assert!((dx - x / 100.0).abs() < 1e-12 && (dy - y / 50.0).abs() < 1e-12, "{dx} {dy}");
        }
        assert_eq!(between(&field(), PixelPoint::new(330.0, 10.0)), None);
    }

    /// The longest vector is at the end of both axes: sqrt(2.9925^2 + 3.98^2) = 4.979.
    #[test]
    fn colours_change_at_round_lengths() {
        let bands = Bands::of(&[field()]).unwrap();
        assert!((bands.top - 4.9795).abs() < 1e-3, "{}", bands.top);
        assert_eq!(bands.levels, [0.5, 1.0, 2.0]);
        assert_eq!(bands.colour(0.6), bands.colour(0.9));
        let mut all: Vec<RGBColor> = [0.1, 0.6, 1.5, 4.0].map(|length| bands.colour(length)).into();
        all.dedup();
        assert_eq!(all.len(), 4);
        assert!(Bands::of(&[Field::of("none", (400, 200), std::iter::once((PixelPoint::new(0.0, 0.0), (0.0, 0.0))))]).is_none());
    }
}
