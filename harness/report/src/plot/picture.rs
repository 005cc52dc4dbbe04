//! A plot as a picture.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::mark::{Element, Said, Shades};
use super::{Plot, WIDTH};
use crate::axes::upright;
use crate::canvas::{COLOURS, Canvas, OwnMark};
use crate::field::{Area, coloured_arrow, dashed, shade, write};

/// Px of a picture in one of a drawing: pictures are looked at without being zoomed.
const SCALE: f64 = 900.0 / WIDTH;
const LEFT: f64 = 70.0;
const TOP: i32 = 50;
const BOTTOM: i32 = 52;
/// Room at the right, and for a scale of colours there.
const RIGHT: i32 = 30;
const BAR: i32 = 150;
/// Heights of a line of the legend and of the remark, columns of the legend and their width.
const LINE: i32 = 26;
const COLUMNS: i32 = 3;
const COLUMN: i32 = 300;

/// The colour of a number, as the style of pages has it on white.
pub(super) fn colour(number: usize) -> RGBColor {
    COLOURS.get(number).copied().unwrap_or(if number == COLOURS.len() { RGBColor(85, 85, 85) } else { BLACK })
}

impl Plot {
    /// The picture, with a line below it, which may be empty.
    pub(crate) fn picture(&self, remark: &str) -> Canvas {
        let left = self.left(LEFT);
        let inside =
            Inside { plot: self, at: [left.round() as i32, TOP, (WIDTH * SCALE).round() as i32, (self.height * SCALE).round() as i32] };
        let [left, top, width, height] = inside.at;
        let right = if self.shades.is_some() { BAR } else { RIGHT };
        let below = BOTTOM + (SCALE * self.below(f64::from(width))).round() as i32;
        let rows = (self.legend.len() as i32 + COLUMNS - 1) / COLUMNS;
        let (legend, said) = (top + height + below, if remark.is_empty() { 0 } else { LINE });
        let mut canvas = Canvas::new((left + width + right) as u32, (legend + rows * LINE + said + 12) as u32);
        canvas.text(&self.label, 20, (left as u32, (TOP / 2 - 8) as u32));
        inside.draw(&mut canvas, |_| true);
        canvas.paint(|area| {
            inside.axes(area);
            if let Some(shades) = &self.shades {
                shades.beside(area, inside.at);
            }
        });
        for (index, entry) in (0..).zip(&self.legend) {
            let (x, y) = (left + 8 + index % COLUMNS * COLUMN, legend + LINE / 2 + index / COLUMNS * LINE);
            canvas.of(entry.is_series.then_some(&*entry.name), |canvas| {
                canvas.marks(&[(entry.shape.mark(), colour(entry.colour), (f64::from(x), f64::from(y)))]);
                canvas.text(&entry.name, 16, ((x + 18) as u32, y as u32));
            });
        }
        canvas.text(remark, 16, (left as u32, (legend + rows * LINE + LINE / 2) as u32));
        canvas
    }
}

/// What is inside the axes, and where: left, top, width and height, px of the picture.
#[derive(Clone, Copy)]
pub(super) struct Inside<'p> {
    pub(super) plot: &'p Plot,
    pub(super) at: [i32; 4],
}

impl Inside<'_> {
    fn place(&self, at: (f64, f64)) -> (f64, f64) {
        self.plot.place(self.at.map(f64::from), at)
    }

    fn pixel(&self, at: (f64, f64)) -> (i32, i32) {
        let (x, y) = self.place(at);
        (x.round() as i32, y.round() as i32)
    }

    /// The elements whose marks are `wanted`, in their order; symbols above all else.
    pub(super) fn draw(&self, canvas: &mut Canvas, wanted: impl Fn(&Said) -> bool) {
        let called = self.plot.elements.iter().find_map(|element| match element {
            Element::Series { name: Some(_), says, .. } => Some(says),
            _ => None,
        });
        if let Some(called) = called {
            canvas.say_as(called.iter().map(String::as_str));
        }
        let mut series = (BLACK, None, false);
        let mut marks: Vec<OwnMark<'_>> = Vec::new();
        for element in &self.plot.elements {
            match element {
                Element::Series { colour: number, name, says } => series = (colour(*number), name.as_deref(), Some(says) == called),
                Element::Symbol { shape, at, said } if wanted(said) => {
                    let place = self.place(*at);
                    marks.push((series.1, (shape.mark(), series.0, place)));
                    if series.2 {
                        canvas.of(series.1, |canvas| canvas.say(place, said.values.iter().cloned()));
                    }
                }
                _ => canvas.of(series.1, |canvas| canvas.paint(|area| self.element(area, element, series.0, &wanted))),
            }
        }
        canvas.marks_of(&marks);
    }

    fn element(&self, area: &Area<'_>, element: &Element, colour: RGBColor, wanted: &impl Fn(&Said) -> bool) {
        match element {
            Element::Arrow { from, to, said } if wanted(said) => {
                let Some(ends) = self.clipped([*from, *to]) else { return };
                if ends[0] == self.pixel(*from) {
                    area.draw(&Circle::new(ends[0], 2, colour.filled())).ok();
                }
                if ends[1] == self.pixel(*to) {
                    coloured_arrow(area, ends[0], ends[1], colour);
                } else {
                    area.draw(&PathElement::new(ends.to_vec(), colour.stroke_width(1))).ok();
                }
            }
            Element::Cell { corners, fill: Some([r, g, b]), .. } => {
                let corners = corners.map(|corner| self.pixel(corner));
                area.draw(&Rectangle::new(corners, RGBColor(*r, *g, *b).filled())).ok();
            }
            Element::Line { places, .. } => {
                for ends in places.windows(2).filter_map(|ends| self.clipped([ends[0], ends[1]])) {
                    area.draw(&PathElement::new(ends.to_vec(), colour.stroke_width(2))).ok();
                }
            }
            Element::Dashed(places) => self.pixels(places).windows(2).for_each(|ends| dashed(area, [ends[0], ends[1]])),
            Element::Contour(pieces) => {
                for (colour, width) in [(WHITE, 3), (BLACK, 1)] {
                    for ends in pieces {
                        area.draw(&PathElement::new(self.pixels(ends), colour.stroke_width(width))).ok();
                    }
                }
            }
            Element::Dots(places) => self.pixels(places).into_iter().for_each(|at| drop(area.draw(&Circle::new(at, 1, colour.filled())))),
            Element::Ring(at) => {
                area.draw(&Circle::new(self.pixel(*at), 13, BLACK.stroke_width(2))).ok();
            }
            Element::Whisker { x, ends, .. } => {
                let ends = ends.map(|y| self.pixel((*x, y)));
                area.draw(&PathElement::new(ends.to_vec(), colour.stroke_width(1))).ok();
            }
            Element::Note { at, text, .. } => write(area, text, self.pixel(*at), HPos::Center),
            Element::Tag { at, text } => {
                let ((x, y), half) = (self.pixel(*at), 4 * text.chars().count() as i32 + 3);
                area.draw(&Rectangle::new([(x - half, y - 9), (x + half, y + 9)], WHITE.filled())).ok();
                write(area, text, (x, y), HPos::Center);
            }
            // Of cells without a colour and of what is not wanted nothing is to be seen; series and symbols were drawn before.
            Element::Cell { .. } | Element::Arrow { .. } | Element::Series { .. } | Element::Symbol { .. } => {}
        }
    }

    fn pixels(&self, places: &[(f64, f64)]) -> Vec<(i32, i32)> {
        places.iter().map(|place| self.pixel(*place)).collect()
    }

    /// The part of a straight line that is inside the axes.
    ///
    /// Source: Liang & Barsky 1984.
    fn clipped(&self, ends: [(f64, f64); 2]) -> Option<[(i32, i32); 2]> {
        let [left, top, width, height] = self.at.map(f64::from);
        let [(ax, ay), (bx, by)] = ends.map(|end| self.place(end));
        let (dx, dy) = (bx - ax, by - ay);
        let (mut from, mut to) = (0.0_f64, 1.0_f64);
        for (step, room) in [(-dx, ax - left), (dx, left + width - ax), (-dy, ay - top), (dy, top + height - ay)] {
            if step == 0.0 && room < 0.0 {
                return None;
            }
            if step < 0.0 {
                from = from.max(room / step);
            } else if step > 0.0 {
                to = to.min(room / step);
            }
        }
        (from <= to).then(|| [from, to].map(|part| ((ax + part * dx).round() as i32, (ay + part * dy).round() as i32)))
    }

    /// The outline.
    pub(super) fn outline(&self, area: &Area<'_>) {
        let [left, top, width, height] = self.at;
        area.draw(&Rectangle::new([(left, top), (left + width, top + height)], BLACK)).ok();
    }

    fn axes(&self, area: &Area<'_>) {
        self.outline(area);
        let [left, top, width, height] = self.at;
        let turned = self.plot.below(f64::from(width)) > 0.0;
        for (value, label) in self.plot.x.ticks() {
            let x = left + (self.plot.x.part(value) * f64::from(width)).round() as i32;
            area.draw(&PathElement::new([(x, top + height), (x, top + height + 5)], BLACK)).ok();
            if turned {
                upright(area, &label, (x, top + height + 10));
            } else {
                write(area, &label, (x, top + height + 16), HPos::Center);
            }
        }
        for (value, label) in self.plot.y.ticks() {
            let y = top + ((1.0 - self.plot.y.part(value)) * f64::from(height)).round() as i32;
            area.draw(&PathElement::new([(left - 5, y), (left, y)], BLACK)).ok();
            write(area, &label, (left - 9, y), HPos::Right);
        }
        let below = (SCALE * self.plot.below(f64::from(width))).round() as i32;
        write(area, &self.plot.x.title, (left + width / 2, top + height + 38 + below), HPos::Center);
        write(area, &self.plot.y.title, (8, top - 14), HPos::Left);
    }
}

impl Shades {
    /// Beside a plot whose inside lies there.
    fn beside(&self, area: &Area<'_>, [left, top, width, height]: [i32; 4]) {
        let (x, down) = (left + width + 20, top + height);
        for y in top..down {
            let part = f64::from(down - y) / f64::from(height);
            area.draw(&PathElement::new([(x, y), (x + 20, y)], shade(part))).ok();
        }
        area.draw(&Rectangle::new([(x, top), (x + 20, down)], BLACK)).ok();
        for (part, label) in &self.levels {
            let y = down - (part * f64::from(height)).round() as i32;
            area.draw(&PathElement::new([(x + 20, y), (x + 25, y)], BLACK)).ok();
            write(area, label, (x + 30, y), HPos::Left);
        }
        write(area, &self.title, (x - 6, top - 14), HPos::Left);
    }
}
