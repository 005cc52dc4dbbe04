//! To what a stroke belongs, and what is said at its place: what a drawing that answers must know besides what it shows. Pixels know nothing of it.

use plotters::prelude::RGBColor;

use super::{Canvas, Mark, Stroke};
use crate::plain;

/// In place of a value that is not there.
const NONE: &str = "\u{2013}";

/// What lies above what, among all that belongs to something: no line crosses a mark, and no rim of a mark another mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Depth {
    Lines,
    Rims,
    Marks,
}

/// To which series a stroke belongs, as a place in the picture's list, and how it lies in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Owner {
    pub(crate) series: usize,
    pub(crate) depth: Depth,
}

/// The series of a picture.
#[derive(Default)]
pub(super) struct Series {
    names: Vec<String>,
    /// What is called how among the values that are said.
    says: Vec<String>,
    /// To which what is drawn next belongs.
    now: Option<Owner>,
}

/// A mark that belongs to the series of a name, or to none.
pub(crate) type OwnMark<'a> = (Option<&'a str>, (Mark, RGBColor, (f64, f64)));

impl Canvas {
    /// The names of all series, by their places.
    pub(crate) fn series(&self) -> &[String] {
        &self.series.names
    }

    /// What the values that are said are called, with units.
    pub(crate) fn says(&self) -> &[String] {
        &self.series.says
    }

    /// Calls the values that are said.
    pub(crate) fn say_as<'n>(&mut self, names: impl IntoIterator<Item = &'n str>) {
        self.series.says = names.into_iter().map(str::to_owned).collect();
    }

    /// Draws what belongs to the series of a name, say a method: it can be hidden with all else of that name. Of no name it belongs to the picture.
    pub(crate) fn of(&mut self, name: Option<&str>, draw: impl FnOnce(&mut Self)) {
        let (before, series) = (self.current(), name.map(|name| self.place_of(name)));
        self.belong(series, Depth::Lines);
        draw(self);
        self.belong(before, Depth::Lines);
    }

    /// As [`Self::marks`], each of a series of its own.
    pub(crate) fn marks_of(&mut self, marks: &[OwnMark<'_>]) {
        let own: Vec<_> = marks.iter().map(|(name, mark)| (name.map(|name| self.place_of(name)), *mark)).collect();
        self.marks_by(own.into_iter());
    }

    /// Says the values of what is at a place, px of the picture, of the series that is drawn.
    pub(crate) fn say(&mut self, (x, y): (f64, f64), values: impl IntoIterator<Item = String>) {
        self.strokes.push(Stroke::Said((x.round() as i32, y.round() as i32), values.into_iter().collect()));
    }

    /// As [`Self::say`], of what is drawn with a value and the ends of its interval: after `before` value, lower and upper end, a dash where there is none, then `after`.
    pub(crate) fn say_estimate(&mut self, at: (f64, f64), before: &[&str], (value, interval): (f64, Option<(f64, f64)>), after: &[&str]) {
        let ends = [interval.map(|ends| ends.0), interval.map(|ends| ends.1)].map(|end| end.map_or_else(|| NONE.to_owned(), plain));
        let texts = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>();
        self.say(at, texts(before).into_iter().chain([plain(value)]).chain(ends).chain(texts(after)));
    }

    /// The series that what is drawn next belongs to.
    pub(super) fn current(&self) -> Option<usize> {
        self.series.now.map(|owner| owner.series)
    }

    pub(super) fn belong(&mut self, series: Option<usize>, depth: Depth) {
        let owner = series.map(|series| Owner { series, depth });
        if owner != self.series.now {
            self.series.now = owner;
            self.strokes.push(Stroke::Belongs(owner));
        }
    }

    fn place_of(&mut self, name: &str) -> usize {
        let names = &mut self.series.names;
        names.iter().position(|known| known == name).unwrap_or_else(|| {
            names.push(name.to_owned());
            names.len() - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use plotters::prelude::*;

    use super::*;

    fn drawn(canvas: &mut Canvas) {
        canvas.paint(|area| {
            area.draw(&PathElement::new([(3, 3), (30, 20)], BLUE)).ok();
        });
        canvas.marks(&[(Mark::Circle, RED, (12.0, 12.0))]);
    }

    /// No pixel changes by what belongs to what.
    #[test]
    fn pixels_know_nothing_of_series() {
        let png = |canvas: &Canvas| {
            let mut png = Vec::new();
            canvas.encode(&mut png).unwrap();
            png
        };
        let (mut plain, mut owned) = (Canvas::new(40, 40), Canvas::new(40, 40));
        drawn(&mut plain);
        plain.marks(&[(Mark::Cross, GREEN, (14.0, 14.0)), (Mark::Circle, RED, (15.0, 12.0))]);
        owned.of(Some("a"), |canvas| {
            drawn(canvas);
            canvas.say((12.0, 12.0), ["1".to_owned()]);
        });
        owned.marks_of(&[(Some("b"), (Mark::Cross, GREEN, (14.0, 14.0))), (None, (Mark::Circle, RED, (15.0, 12.0)))]);
        assert_eq!(png(&plain), png(&owned));
        assert_eq!(owned.series(), ["a", "b"]);
    }

    #[test]
    fn a_stroke_belongs_to_what_is_drawn_and_afterwards_to_nothing() {
        let mut canvas = Canvas::new(40, 40);
        canvas.of(Some("a"), drawn);
        drawn(&mut canvas);
        let mut found = Vec::new();
        let mut now = None;
        for stroke in canvas.strokes() {
            match stroke {
                Stroke::Belongs(owner) => now = *owner,
                _ => found.push(now.map(|Owner { series, depth }| (series, depth))),
            }
        }
        found.dedup();
        assert_eq!(found, [Some((0, Depth::Lines)), Some((0, Depth::Rims)), Some((0, Depth::Marks)), None]);
    }
}
