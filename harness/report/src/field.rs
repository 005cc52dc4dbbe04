//! A vector field over the frame: colours for its length, arrows for its direction.

use calibench_model::PixelPoint;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::Canvas;
use super::hull::Hull;
use super::markdown::plain;

/// A regular grid of vectors over an image, row by row.
pub struct Field {
    /// What is shown, in a line.
    pub title: String,
    /// Columns and rows of the image, px.
    pub size: (u32, u32),
    /// Columns and rows of the grid.
    pub grid: (usize, usize),
    /// Where each vector stands and what it is, px; `None` where there is none.
    pub vectors: Vec<(PixelPoint, Option<(f64, f64)>)>,
    /// The part of the frame with image points, which a dashed line surrounds.
    pub measured: Hull,
}

/// Width of the picture's map, px of the picture.
pub(crate) const MAP: u32 = 900;
pub(crate) const LEFT: u32 = 70;
pub(crate) const TOP: u32 = 50;
pub(crate) const RIGHT: u32 = 150;
pub(crate) const BOTTOM: u32 = 80;
/// Arrows across the longer side, about.
const ARROWS: usize = 21;

impl Field {
    /// Vectors in any order, put on the regular grid that their places make.
    pub fn of(title: &str, size: (u32, u32), vectors: impl Iterator<Item = (PixelPoint, (f64, f64))>) -> Self {
        let vectors: Vec<_> = vectors.collect();
        let ticks = |of: fn(&PixelPoint) -> f64| {
            let mut ticks: Vec<f64> = vectors.iter().map(|(at, _)| of(at)).collect();
            ticks.sort_by(f64::total_cmp);
            ticks.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
            ticks
        };
        let (xs, ys) = (ticks(|p| p.x), ticks(|p| p.y));
        let nodes = ys.iter().flat_map(|&y| xs.iter().map(move |&x| PixelPoint::new(x, y)));
        let mut grid: Vec<(PixelPoint, Option<(f64, f64)>)> = nodes.map(|at| (at, None)).collect();
        let place = |ticks: &[f64], value: f64| ticks.partition_point(|tick| *tick < value - 1e-6);
        for (at, vector) in &vectors {
            grid[place(&ys, at.y) * xs.len() + place(&xs, at.x)].1 = Some(*vector);
        }
        Self { title: title.to_owned(), size, grid: (xs.len().max(1), ys.len().max(1)), vectors: grid, measured: Hull::default() }
    }

    /// The longest vector, px.
    fn longest(&self) -> f64 {
        self.vectors.iter().filter_map(|(_, v)| *v).map(|(dx, dy)| dx.hypot(dy)).fold(0.0, f64::max)
    }

    /// The field as a picture: a map with axes in px, a scale of colours, arrows that are as many times too long as the legend says.
    pub fn picture(&self) -> Canvas {
        let (width, height) = (f64::from(self.size.0), f64::from(self.size.1));
        let map = (MAP, (f64::from(MAP) * height / width).round().max(120.0) as u32);
        let mut canvas = Canvas::new(LEFT + map.0 + RIGHT, TOP + map.1 + BOTTOM);
        let longest = self.longest();
        // Lengths below rounding are shown as nothing, not as noise.
        let top = if longest > 1e-12 { longest } else { 1.0 };
        canvas.text(&self.title, 20, (LEFT, TOP / 2));
        canvas.paint(|area| {
            self.map(area, map, top);
            colour_bar(area, map, top);
        });
        canvas.paint(|area| self.measured.sides().for_each(|side| dashed(area, side.map(|end| self.place(end, map)))));
        if self.measured.sides().next().is_some() {
            canvas.text("dashed: around the measured points", 16, (LEFT + map.0 / 2 - 110, TOP + map.1 + 60));
        }
        let stretch = stretch(width / ARROWS as f64 * 1.2, top);
        if self.vectors.iter().any(|(_, vector)| vector.is_none()) {
            canvas.text("white: not compared", 16, (LEFT + map.0 - 150, TOP + map.1 + 60));
        }
        if longest > 1e-12 {
            canvas.paint(|area| self.arrows(area, map, stretch));
            canvas.text(&format!("arrows {stretch} times too long; longest {} px", plain(longest)), 16, (LEFT, TOP + map.1 + 60));
        } else {
            canvas.text("no difference", 16, (LEFT, TOP + map.1 + 60));
        }
        canvas
    }

    fn place(&self, at: PixelPoint, map: (u32, u32)) -> (i32, i32) {
        let corner = at.to_corner();
        let part = |value: f64, size: u32, px: u32| (value / f64::from(size) * f64::from(px)).round() as i32;
        (LEFT as i32 + part(corner.x, self.size.0, map.0), TOP as i32 + part(corner.y, self.size.1, map.1))
    }

    fn map(&self, area: &Area<'_>, map: (u32, u32), top: f64) {
        let (columns, rows) = self.grid;
        for (index, (_, vector)) in self.vectors.iter().enumerate() {
            let (column, row) = (index % columns, index / columns);
            let edge = |i: usize, n: usize, px: u32| (i as f64 / n as f64 * f64::from(px)).round() as i32;
            let x = (LEFT as i32 + edge(column, columns, map.0), LEFT as i32 + edge(column + 1, columns, map.0));
            let y = (TOP as i32 + edge(row, rows, map.1), TOP as i32 + edge(row + 1, rows, map.1));
            let colour = vector.map_or(WHITE, |(dx, dy)| shade(dx.hypot(dy) / top));
            area.draw(&Rectangle::new([(x.0, y.0), (x.1, y.1)], colour.filled())).ok();
        }
        let (left, up) = (LEFT as i32, TOP as i32);
        let (right, down) = (left + map.0 as i32, up + map.1 as i32);
        area.draw(&Rectangle::new([(left, up), (right, down)], BLACK)).ok();
        for i in 0..=4 {
            let part = f64::from(i) / 4.0;
            let x = left + (part * f64::from(map.0)) as i32;
            let y = up + (part * f64::from(map.1)) as i32;
            let (column, row) = ((part * f64::from(self.size.0)).round(), (part * f64::from(self.size.1)).round());
            write(area, &format!("{column}"), (x, down + 14), HPos::Center);
            write(area, &format!("{row}"), (left - 8, y), HPos::Right);
        }
        write(area, "x, px", (left + map.0 as i32 / 2, down + 34), HPos::Center);
        write(area, "y, px", (left - 8, up - 14), HPos::Right);
    }

    fn arrows(&self, area: &Area<'_>, map: (u32, u32), stretch: f64) {
        let (columns, rows) = self.grid;
        let every = columns.max(rows).div_ceil(ARROWS).max(1);
        for row in (every / 2..rows).step_by(every) {
            for column in (every / 2..columns).step_by(every) {
                let (at, Some((dx, dy))) = self.vectors[row * columns + column] else { continue };
                let from = self.place(at, map);
                let to = self.place(PixelPoint::new(at.x + dx * stretch, at.y + dy * stretch), map);
                arrow(area, from, to);
            }
        }
    }
}

/// Where is drawn.
pub(crate) use crate::canvas::Area;

/// A round number of times by which arrows are lengthened so that the longest is about `room` px of the image.
pub(crate) fn stretch(room: f64, longest: f64) -> f64 {
    let wanted = room / longest;
    let decade = 10_f64.powf(wanted.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|step| step * decade).find(|round| *round <= wanted).unwrap_or(wanted)
}

/// Light to dark, readable in grey and without colour vision: a part of viridis turned round, so that nothing is nearly white.
pub(crate) fn shade(part: f64) -> RGBColor {
    const STOPS: [(f64, f64, f64); 5] =
        [(250.0, 248.0, 220.0), (180.0, 222.0, 130.0), (53.0, 183.0, 121.0), (49.0, 104.0, 142.0), (68.0, 1.0, 84.0)];
    let scaled = part.clamp(0.0, 1.0) * 4.0;
    let low = (scaled.floor() as usize).min(3);
    let share = scaled - low as f64;
    let mix = |a: f64, b: f64| (a + (b - a) * share).round() as u8;
    let (a, b) = (STOPS[low], STOPS[low + 1]);
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// The same as red, green and blue.
pub(crate) fn rgb(part: f64) -> [u8; 3] {
    let colour = shade(part);
    [colour.0, colour.1, colour.2]
}

/// All colours of [`shade`] beside a map of a size, from the bottom up: where they stand, x and the rows of both ends.
pub(crate) fn shades_beside(area: &Area<'_>, map: (u32, u32)) -> (i32, i32, i32) {
    let x = (LEFT + map.0) as i32 + 20;
    let (up, down) = (TOP as i32, (TOP + map.1) as i32);
    for y in up..down {
        let part = f64::from(down - y) / f64::from(down - up);
        area.draw(&PathElement::new([(x, y), (x + 20, y)], shade(part))).ok();
    }
    area.draw(&Rectangle::new([(x, up), (x + 20, down)], BLACK)).ok();
    (x, up, down)
}

/// The scale of colours beside a map of a size, from 0 to `top` px.
pub(crate) fn colour_bar(area: &Area<'_>, map: (u32, u32), top: f64) {
    let (x, up, down) = shades_beside(area, map);
    for i in 0..=4 {
        let part = f64::from(i) / 4.0;
        let y = down - (part * f64::from(down - up)) as i32;
        write(area, &plain(part * top), (x + 28, y), HPos::Left);
    }
    write(area, "px", (x, up - 14), HPos::Left);
}

/// A dashed line, black on white: seen on every colour of the map.
pub(crate) fn dashed(area: &Area<'_>, [from, to]: [(i32, i32); 2]) {
    let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
    let length = dx.hypot(dy);
    let at = |along: f64| (from.0 + (dx * along / length).round() as i32, from.1 + (dy * along / length).round() as i32);
    area.draw(&PathElement::new(vec![from, to], WHITE.stroke_width(4))).ok();
    for dash in (0..length as u32).step_by(12) {
        let ends = vec![at(f64::from(dash)), at(f64::from(dash + 7).min(length))];
        area.draw(&PathElement::new(ends, BLACK.stroke_width(2))).ok();
    }
}

/// A black arrow.
pub(crate) fn arrow(area: &Area<'_>, from: (i32, i32), to: (i32, i32)) {
    coloured_arrow(area, from, to, BLACK);
}

/// An arrow.
pub(crate) fn coloured_arrow(area: &Area<'_>, from: (i32, i32), to: (i32, i32), colour: RGBColor) {
    let style = colour.stroke_width(1);
    area.draw(&PathElement::new([from, to], style)).ok();
    let (dx, dy) = (f64::from(to.0 - from.0), f64::from(to.1 - from.1));
    let length = dx.hypot(dy);
    if length >= 3.0 {
        let head = (length * 0.35).min(7.0) / length;
        let barb = |side: f64| {
            let (bx, by) = (-dx + side * 0.5 * dy, -dy - side * 0.5 * dx);
            (to.0 + (bx * head).round() as i32, to.1 + (by * head).round() as i32)
        };
        area.draw(&PathElement::new([barb(1.0), to, barb(-1.0)], style)).ok();
    }
}

/// Text, its middle or its side at a place.
pub(crate) fn write(area: &Area<'_>, text: &str, at: (i32, i32), side: HPos) {
    let style = ("sans-serif", 16).into_font().color(&BLACK).pos(Pos::new(side, VPos::Center));
    area.draw(&Text::new(text.to_owned(), at, style)).ok();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_are_stretched_by_round_numbers() {
        assert_eq!(stretch(100.0, 0.4), 200.0);
        assert_eq!(stretch(100.0, 1.1), 50.0);
        assert_eq!(stretch(100.0, 60.0), 1.0);
    }

    #[test]
    fn numbers_have_three_digits() {
        assert_eq!(
            (plain(0.012_345), plain(12.345), plain(1234.5), plain(1e-9)),
            ("0.0123".into(), "12.3".into(), "1234".into(), "1.00e-9".into())
        );
    }
}
