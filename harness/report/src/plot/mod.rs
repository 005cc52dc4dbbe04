//! What a figure shows, once: places in the units of its axes, with what they say. It is drawn as a picture and, for a page, as SVG that answers.

mod axis;
mod figure;
mod mark;
mod panels;
mod picture;
mod svg;

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;

use crate::plain;
pub(crate) use axis::Axis;
pub(crate) use figure::Figure;
use mark::{Element, Entry, Shades};
pub(crate) use mark::{Said, Shape};
pub(crate) use panels::{PANEL, panels};

/// A plot: what lies inside its axes in the order in which it is drawn.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    /// Its name in a page.
    id: String,
    /// What it shows, for those who do not see it.
    label: String,
    x: Axis,
    y: Axis,
    /// Height inside the axes, px where it is [`WIDTH`] wide.
    height: f64,
    /// Whether both axes have one scale.
    equal: bool,
    /// Whether names stand at the left, which need room.
    named: bool,
    elements: Vec<Element>,
    legend: Vec<Entry>,
    shades: Option<Shades>,
}

/// Width inside the axes, px of a drawing.
const WIDTH: f64 = 760.0;
/// Width of a letter of a name, px of a drawing, about.
const LETTER: f64 = 7.0;

impl Plot {
    /// A plot of curves or points, `height` px of the drawing high inside its axes; its name in the page, and what it shows, for those who do not see it.
    pub(crate) fn new(id: &str, label: &str, x: Axis, y: Axis, height: f64) -> Self {
        Self {
            id: id.into(),
            label: label.into(),
            x,
            y,
            height,
            equal: false,
            named: false,
            elements: Vec::new(),
            legend: Vec::new(),
            shades: None,
        }
    }

    /// The frame of an image, y down.
    pub(crate) fn frame(id: &str, label: &str, size: ImageSize) -> Self {
        let [width, height] = [size.width, size.height].map(f64::from);
        let x = Axis::linear("x, px", [-0.5, width - 0.5]);
        let y = Axis::linear("y, px", [height - 0.5, -0.5]);
        Self { equal: true, ..Self::new(id, label, x, y, (WIDTH * height / width).clamp(120.0, 2.0 * WIDTH)) }
    }

    /// With as much room at the left as its longest name needs.
    pub(crate) fn with_names_at_the_left(mut self) -> Self {
        self.named = true;
        self
    }

    /// Says what a symbol stands for; of a series that may be hidden everywhere its name hides it.
    pub(crate) fn legend(&mut self, colour: usize, shape: Shape, name: &str, is_series: bool) {
        self.legend.push(Entry { colour, shape, name: name.to_owned(), is_series });
    }

    /// Begins a series in the colour of a number; `name` is that of a method that may be hidden everywhere, `says` what its marks say.
    pub(crate) fn series(&mut self, colour: usize, name: Option<&str>, says: &[&str]) {
        let says = says.iter().map(|one| (*one).to_owned()).collect();
        self.elements.push(Element::Series { colour, name: name.map(str::to_owned), says });
    }

    /// A symbol at a place.
    pub(crate) fn symbol(&mut self, shape: Shape, at: (f64, f64), said: &Said) {
        self.elements.push(Element::Symbol { shape, at, said: said.clone() });
    }

    /// An arrow from a place in px of an image, so many times too long as asked for.
    pub(crate) fn arrow(&mut self, from: PixelPoint, by: (f64, f64), said: &Said) {
        self.elements.push(Element::Arrow { from: (from.x, from.y), to: (from.x + by.0, from.y + by.1), said: said.clone() });
    }

    /// A cell between two places, of a colour; `None`: empty.
    pub(crate) fn cell(&mut self, corners: [(f64, f64); 2], fill: Option<[u8; 3]>, said: &Said) {
        self.elements.push(Element::Cell { corners, fill, said: said.clone() });
    }

    /// A line through places.
    pub(crate) fn line(&mut self, places: &[(f64, f64)], said: &Said) {
        self.elements.push(Element::Line { places: places.to_vec(), said: said.clone() });
    }

    /// A dashed line through places, which is seen on every shade.
    pub(crate) fn dashed(&mut self, places: &[(f64, f64)]) {
        self.elements.push(Element::Dashed(places.to_vec()));
    }

    /// Pieces of a thin line that is seen on every shade.
    pub(crate) fn contour(&mut self, pieces: Vec<[(f64, f64); 2]>) {
        self.elements.push(Element::Contour(pieces));
    }

    /// Dots that say nothing: where something is.
    pub(crate) fn dots(&mut self, places: Vec<(f64, f64)>) {
        self.elements.push(Element::Dots(places));
    }

    /// A bar between two values of y at one of x.
    pub(crate) fn whisker(&mut self, x: f64, ends: [f64; 2], said: &Said) {
        self.elements.push(Element::Whisker { x, ends, said: said.clone() });
    }

    /// Text in the middle of a place of the plot, which is zoomed with it; dark in any theme where it stands on a shade.
    pub(crate) fn note(&mut self, at: (f64, f64), text: &str, is_on_shade: bool) {
        self.elements.push(Element::Note { at, text: text.to_owned(), is_on_shade });
    }

    /// A ring around a place: it is to be noticed.
    pub(crate) fn ring(&mut self, at: (f64, f64)) {
        self.elements.push(Element::Ring(at));
    }

    /// Text on white in the middle of a place, as on a line.
    pub(crate) fn tag(&mut self, at: (f64, f64), text: &str) {
        self.elements.push(Element::Tag { at, text: text.to_owned() });
    }

    /// A scale of shades beside the plot: what stands at which part of it, 0 to 1 from below, and its title.
    pub(crate) fn shades(&mut self, title: &str, levels: &[(f64, String)]) {
        self.shades = Some(Shades { title: title.to_owned(), levels: levels.to_vec() });
    }

    /// A scale of shades from 0 to `top`.
    pub(crate) fn shades_to(&mut self, title: &str, top: f64) {
        self.shades(title, &[0.0, 0.25, 0.5, 0.75, 1.0].map(|part| (part, plain(part * top))));
    }

    /// A place of the drawing whose axes lie at left, top, width and height.
    fn place(&self, [left, top, width, height]: [f64; 4], (x, y): (f64, f64)) -> (f64, f64) {
        (left + self.x.part(x) * width, top + (1.0 - self.y.part(y)) * height)
    }

    /// Room that names below need because they are turned, px of a drawing; 0 where they fit `width` as they are.
    fn below(&self, width: f64) -> f64 {
        let longest = self.x.names.iter().map(|name| name.chars().count()).max().unwrap_or(0) as f64 * LETTER;
        if longest < width / self.x.names.len().max(1) as f64 { 0.0 } else { 0.5 * longest }
    }

    /// Room at the left, px of a drawing: `usual`, or as the longest name needs.
    fn left(&self, usual: f64) -> f64 {
        if !self.named {
            return usual;
        }
        let longest = self.y.names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
        (24.0 + LETTER * longest as f64).max(usual)
    }
}

/// A line around the cell of two names, a little inside it.
pub(crate) fn around((x, y): (f64, f64)) -> [(f64, f64); 5] {
    [(-0.48, -0.46), (0.48, -0.46), (0.48, 0.46), (-0.48, 0.46), (-0.48, -0.46)].map(|(dx, dy)| (x + dx, y + dy))
}

#[cfg(test)]
mod tests;
