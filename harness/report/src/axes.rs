//! A box with two linear scales.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::field::{Area, write};
use crate::ticks;

/// Where a box lies in the picture and what it shows.
#[derive(Clone, Copy)]
pub(crate) struct Axes {
    /// Left, top, width, height, px of the picture.
    pub(crate) at: [i32; 4],
    /// Left and right value.
    pub(crate) x: [f64; 2],
    /// Lower and upper value.
    pub(crate) y: [f64; 2],
}

/// Grey of grid lines.
const GRID: RGBColor = RGBColor(220, 220, 220);

impl Axes {
    /// A place in the picture.
    pub(crate) fn place(&self, x: f64, y: f64) -> (i32, i32) {
        let [left, top, width, height] = self.at;
        let part = |value: f64, [low, high]: [f64; 2]| (value - low) / (high - low);
        (left + (part(x, self.x) * f64::from(width)).round() as i32, top + height - (part(y, self.y) * f64::from(height)).round() as i32)
    }

    /// The frame, grid lines and numbers at the left, and the title of the scale.
    pub(crate) fn vertical(&self, area: &Area<'_>, title: &str) {
        let [left, top, width, height] = self.at;
        let values = ticks::linear(self.y[0], self.y[1]);
        for &value in &values {
            let (_, y) = self.place(self.x[0], value);
            area.draw(&PathElement::new([(left, y), (left + width, y)], GRID)).ok();
            write(area, &number(value, &values), (left - 8, y), HPos::Right);
        }
        area.draw(&Rectangle::new([(left, top), (left + width, top + height)], BLACK)).ok();
        write(area, title, (left, top - 14), HPos::Left);
    }

    /// Numbers below, and the title of the scale.
    pub(crate) fn horizontal(&self, area: &Area<'_>, title: &str) {
        let [left, top, width, height] = self.at;
        let values = ticks::linear(self.x[0], self.x[1]);
        for &value in &values {
            let (x, _) = self.place(value, self.y[0]);
            area.draw(&PathElement::new([(x, top + height), (x, top + height + 5)], BLACK)).ok();
            write(area, &number(value, &values), (x, top + height + 16), HPos::Center);
        }
        write(area, title, (left + width / 2, top + height + 38), HPos::Center);
    }

    /// The frame, a line and a number at each power of ten of a logarithmic scale, and the title.
    pub(crate) fn decades(&self, area: &Area<'_>, title: &str) {
        let [left, top, width, height] = self.at;
        for power in self.y[0].ceil() as i32..=self.y[1].floor() as i32 {
            let (_, y) = self.place(self.x[0], f64::from(power));
            area.draw(&PathElement::new([(left, y), (left + width, y)], GRID)).ok();
            let decimals = (-power).max(0) as usize;
            write(area, &crate::markdown::fixed(10_f64.powi(power), decimals), (left - 8, y), HPos::Right);
        }
        area.draw(&Rectangle::new([(left, top), (left + width, top + height)], BLACK)).ok();
        write(area, title, (left, top - 14), HPos::Left);
    }

    /// Numbers below a logarithmic scale where these values are, and the title.
    pub(crate) fn values(&self, area: &Area<'_>, title: &str, values: &[f64]) {
        let [left, top, width, height] = self.at;
        for value in values {
            let (x, _) = self.place(value.log10(), self.y[0]);
            area.draw(&PathElement::new([(x, top + height), (x, top + height + 5)], BLACK)).ok();
            write(area, &value.to_string(), (x, top + height + 16), HPos::Center);
        }
        write(area, title, (left + width / 2, top + height + 38), HPos::Center);
    }

    /// Names below, at 0, 1, ... of the scale, and the title of the scale.
    pub(crate) fn named(&self, area: &Area<'_>, title: &str, names: &[&str]) {
        let [left, top, width, height] = self.at;
        for (value, name) in names.iter().enumerate() {
            let (x, _) = self.place(value as f64, self.y[0]);
            area.draw(&PathElement::new([(x, top + height), (x, top + height + 5)], BLACK)).ok();
            write(area, name, (x, top + height + 16), HPos::Center);
        }
        write(area, title, (left + width / 2, top + height + 38), HPos::Center);
    }

    /// A horizontal line at a value.
    pub(crate) fn level(&self, area: &Area<'_>, value: f64, colour: RGBColor) {
        let (_, y) = self.place(self.x[0], value);
        area.draw(&PathElement::new([(self.at[0], y), (self.at[0] + self.at[2], y)], ShapeStyle::from(&colour).stroke_width(2))).ok();
    }
}

/// A tick's number with the decimals that the step between `ticks` needs.
pub(crate) fn number(value: f64, ticks: &[f64]) -> String {
    let step = ticks.windows(2).map(|pair| pair[1] - pair[0]).next().unwrap_or(1.0);
    let decimals = (0..6).find(|&d| (step * 10_f64.powi(d) - (step * 10_f64.powi(d)).round()).abs() < 1e-6).unwrap_or(6);
    crate::markdown::fixed(value, decimals as usize)
}

/// Small text, read from below upwards, that ends at a place.
pub(crate) fn upright(area: &Area<'_>, text: &str, at: (i32, i32)) {
    let style = ("sans-serif", 13).into_font().transform(FontTransform::Rotate270).color(&BLACK).pos(Pos::new(HPos::Right, VPos::Center));
    area.draw(&Text::new(text.to_owned(), at, style)).ok();
}

/// A bar between two values with ends.
pub(crate) fn whisker(area: &Area<'_>, axes: &Axes, x: f64, (low, high): (f64, f64), colour: RGBColor) {
    let clamp = |value: f64| value.clamp(axes.y[0], axes.y[1]);
    let (a, b) = (axes.place(x, clamp(low)), axes.place(x, clamp(high)));
    let style = ShapeStyle::from(&colour).stroke_width(1);
    area.draw(&PathElement::new([a, b], style)).ok();
    for end in [a, b] {
        area.draw(&PathElement::new([(end.0 - 3, end.1), (end.0 + 3, end.1)], style)).ok();
    }
}
