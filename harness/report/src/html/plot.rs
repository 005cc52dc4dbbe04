//! A plot as SVG that is whole as it stands, with what the script must know to zoom it and to read it off.

use std::fmt::Write;

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;

use super::marks::{Said, Shape, px};
use super::markup::{between_bars, escaped};
use crate::axes::number;
use crate::field::shade;
use crate::ticks;

/// A scale along a side of a plot.
#[derive(Clone, Debug)]
pub(crate) struct Axis {
    /// What it shows, with its unit.
    pub(crate) title: String,
    /// Values at the left and the right end, or at the lower and the upper one.
    pub(crate) ends: [f64; 2],
    /// Whether it is logarithmic.
    pub(crate) log: bool,
    /// Names in place of numbers, at 0, 1, ...
    pub(crate) names: Vec<String>,
}

impl Axis {
    /// A linear one.
    pub(crate) fn linear(title: &str, ends: [f64; 2]) -> Self {
        Self { title: title.to_owned(), ends, log: false, names: Vec::new() }
    }

    /// One with a place for each name.
    pub(crate) fn named(title: &str, names: Vec<String>) -> Self {
        Self { title: title.to_owned(), ends: [-0.5, names.len() as f64 - 0.5], log: false, names }
    }

    fn part(&self, value: f64) -> f64 {
        let scaled = |value: f64| if self.log { value.log10() } else { value };
        let [low, high] = self.ends.map(scaled);
        (scaled(value) - low) / (high - low)
    }

    fn ticks(&self) -> Vec<(f64, String)> {
        if !self.names.is_empty() {
            return self.names.iter().enumerate().map(|(place, name)| (place as f64, name.clone())).collect();
        }
        let (low, high) = (self.ends[0].min(self.ends[1]), self.ends[0].max(self.ends[1]));
        if self.log {
            return ticks::decades(low, high, &[1.0, 2.0, 5.0]).into_iter().map(|value| (value, value.to_string())).collect();
        }
        let values = ticks::linear(low, high);
        values.iter().map(|&value| (value, number(value, &values))).collect()
    }
}

/// A plot under way.
pub(crate) struct Plot {
    id: String,
    label: String,
    /// Left, top, width, height of what is inside the axes, px of the drawing.
    at: [f64; 4],
    x: Axis,
    y: Axis,
    /// Whether both axes have one scale.
    equal: bool,
    marks: String,
    beside: String,
    legend: String,
    /// Room at the right, px of the drawing.
    right: f64,
}

const LEFT: f64 = 76.0;
const TOP: f64 = 30.0;
const WIDTH: f64 = 760.0;
const BOTTOM: f64 = 52.0;
/// Width of a letter of a name, px of the drawing, about.
const LETTER: f64 = 7.0;
/// Steps of a scale of colours.
const STEPS: usize = 64;
/// Cells without lines between them: more than so many are a picture.
const CELLS: usize = 250;
/// Room for a scale of colours.
const BAR: f64 = 110.0;

impl Plot {
    /// A plot of curves or points, `height` px of the drawing high inside its axes; its name in the page, and what it shows, for those who do not see it.
    pub(crate) fn new(id: &str, label: &str, x: Axis, y: Axis, height: f64) -> Self {
        let at = [LEFT, TOP, WIDTH, height];
        Self {
            id: id.into(),
            label: label.into(),
            at,
            x,
            y,
            equal: false,
            marks: String::new(),
            beside: String::new(),
            legend: String::new(),
            right: 24.0,
        }
    }

    /// The frame of an image, y down.
    pub(crate) fn frame(id: &str, label: &str, size: ImageSize) -> Self {
        let [width, height] = [size.width, size.height].map(f64::from);
        let x = Axis::linear("x, px", [-0.5, width - 0.5]);
        let y = Axis::linear("y, px", [height - 0.5, -0.5]);
        Self { equal: true, ..Self::new(id, label, x, y, (WIDTH * height / width).clamp(120.0, 2.0 * WIDTH)) }
    }

    /// A place in the drawing.
    pub(crate) fn place(&self, x: f64, y: f64) -> (f64, f64) {
        let [left, top, width, height] = self.at;
        (left + self.x.part(x) * width, top + (1.0 - self.y.part(y)) * height)
    }

    /// With as much room at the left as its longest name needs.
    pub(crate) fn with_names_at_the_left(mut self) -> Self {
        let longest = self.y.names.iter().map(|name| name.chars().count()).max().unwrap_or(0);
        let left = (24.0 + LETTER * longest as f64).max(LEFT);
        self.at = [left, TOP, (LEFT + WIDTH - left).max(300.0), self.at[3]];
        self
    }

    /// Says what a symbol stands for; of a series that may be hidden everywhere its name hides it.
    pub(crate) fn legend(&mut self, colour: usize, shape: Shape, name: &str, is_series: bool) {
        let name = escaped(name);
        let series = if is_series { format!(" data-series=\"{name}\"") } else { String::new() };
        // Writing to a String cannot fail.
        let _ = write!(
            self.legend,
            "<li{series}><svg class=\"swatch s{colour}\" viewBox=\"-6 -6 12 12\" aria-hidden=\"true\"><path class=\"mark\" d=\"{}\"/></svg> {name}</li>",
            shape.path()
        );
    }

    /// Begins a series in the colour of a number; `name` is that of a method that may be hidden everywhere, `says` what its marks say.
    pub(crate) fn series(&mut self, colour: usize, name: Option<&str>, says: &[&str]) {
        if !self.marks.is_empty() {
            self.marks.push_str("</g>\n");
        }
        let name = name.map_or(String::new(), |name| format!(" data-series=\"{}\"", escaped(name)));
        let says: Vec<String> = says.iter().map(|one| between_bars(one)).collect();
        // Writing to a String cannot fail.
        let _ = write!(self.marks, "<g class=\"series s{colour}\"{name} data-names=\"{}\">", says.join("|"));
    }

    /// A symbol at a place.
    pub(crate) fn symbol(&mut self, shape: Shape, (x, y): (f64, f64), said: &Said) {
        let (x, y) = self.place(x, y);
        let _ = write!(
            self.marks,
            "<path class=\"mark\" transform=\"translate({} {})\" d=\"{}\"{}/>",
            px(x),
            px(y),
            shape.path(),
            said.attributes()
        );
    }

    /// An arrow from a place in px of an image, so many times too long as asked for.
    pub(crate) fn arrow(&mut self, from: PixelPoint, (dx, dy): (f64, f64), said: &Said) {
        let ((x, y), (tx, ty)) = (self.place(from.x, from.y), self.place(from.x + dx, from.y + dy));
        let (ux, uy) = (tx - x, ty - y);
        let length = ux.hypot(uy);
        let head = if length < 3.0 {
            String::new()
        } else {
            let size = (length * 0.35).min(6.0) / length;
            let barb = |side: f64| (tx + size * (-ux + side * 0.5 * uy), ty + size * (-uy - side * 0.5 * ux));
            let ((ax, ay), (bx, by)) = (barb(1.0), barb(-1.0));
            format!("M{} {}L{} {}L{} {}", px(ax), px(ay), px(tx), px(ty), px(bx), px(by))
        };
        let _ = write!(self.marks, "<path class=\"arrow\" d=\"M{} {}L{} {}{head}\"{}/>", px(x), px(y), px(tx), px(ty), said.attributes());
    }

    /// A cell between two places, of a shade from 0 to 1; `None`: empty.
    pub(crate) fn cell(&mut self, [from, to]: [(f64, f64); 2], fill: Option<[u8; 3]>, said: &Said) {
        let ((ax, ay), (bx, by)) = (self.place(from.0, from.1), self.place(to.0, to.1));
        // What has no colour is pointed at as well.
        let fill = fill.map_or("none\" pointer-events=\"all".to_owned(), |[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
        let _ = write!(
            self.marks,
            "<rect class=\"cell\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{fill}\"{}/>",
            px(ax.min(bx)),
            px(ay.min(by)),
            px((bx - ax).abs()),
            px((by - ay).abs()),
            said.attributes()
        );
    }

    /// A line through places.
    pub(crate) fn line(&mut self, places: &[(f64, f64)], said: &Said) {
        let places: Vec<String> = places.iter().map(|&(x, y)| self.place(x, y)).map(|(x, y)| format!("{} {}", px(x), px(y))).collect();
        let _ = write!(self.marks, "<path class=\"line\" d=\"M{}\"{}/>", places.join("L"), said.attributes());
    }

    /// A bar between two values of y at one of x.
    pub(crate) fn whisker(&mut self, x: f64, [low, high]: [f64; 2], said: &Said) {
        let ((x, a), (_, b)) = (self.place(x, low), self.place(x, high));
        let _ = write!(self.marks, "<path class=\"bar\" d=\"M{} {}V{}\"{}/>", px(x), px(a), px(b), said.attributes());
    }

    /// Text in the middle of a place of the plot, which is zoomed with it; dark in any theme where it stands on a shade.
    pub(crate) fn note(&mut self, (x, y): (f64, f64), text: &str, is_on_shade: bool) {
        let (x, y) = self.place(x, y);
        let _ = write!(
            self.marks,
            "<text class=\"{}\" pointer-events=\"none\" x=\"{}\" y=\"{}\" text-anchor=\"middle\" dominant-baseline=\"central\">{}</text>",
            if is_on_shade { "note dark" } else { "note" },
            px(x),
            px(y),
            escaped(text)
        );
    }

    /// A scale of shades beside the plot: what stands at which part of it, 0 to 1 from below, and its title.
    pub(crate) fn shades(&mut self, title: &str, levels: &[(f64, String)]) {
        let [left, top, width, height] = self.at;
        let x = left + width + 18.0;
        let mut text = format!("<g class=\"shades\"><text x=\"{}\" y=\"{}\">{}</text>", px(x), px(top - 12.0), escaped(title));
        for step in 0..STEPS {
            let part = (step as f64 + 0.5) / STEPS as f64;
            let colour = shade(part);
            let up = top + height * (1.0 - (step + 1) as f64 / STEPS as f64);
            let _ = write!(
                text,
                "<rect x=\"{}\" y=\"{}\" width=\"18\" height=\"{}\" fill=\"#{:02x}{:02x}{:02x}\"/>",
                px(x),
                px(up),
                px(height / STEPS as f64 + 0.5),
                colour.0,
                colour.1,
                colour.2
            );
        }
        for (part, label) in levels {
            let y = top + height * (1.0 - part);
            let _ = write!(
                text,
                "<path d=\"M{} {2}H{}\" stroke=\"currentColor\"/><text x=\"{3}\" y=\"{2}\" dominant-baseline=\"central\">{4}</text>",
                px(x + 18.0),
                px(x + 23.0),
                px(y),
                px(x + 28.0),
                escaped(label)
            );
        }
        text.push_str("</g>");
        self.beside.push_str(&text);
        self.right = BAR;
    }

    /// The figure, with a caption.
    pub(crate) fn figure(self, caption: &str) -> String {
        let id = escaped(&self.id);
        let legend = if self.legend.is_empty() { String::new() } else { format!("<ul class=\"legend\">{}</ul>", self.legend) };
        format!("<figure class=\"plot\" id=\"{id}\">{}{legend}<figcaption>{}</figcaption></figure>\n", self.drawing(), escaped(caption))
    }

    /// The drawing alone.
    pub(super) fn drawing(mut self) -> String {
        if !self.marks.is_empty() {
            self.marks.push_str("</g>\n");
        }
        let [left, top, width, height] = self.at;
        let [l, t, bw, bh] = self.at.map(px);
        let (x, y) = (self.axis(true), self.axis(false));
        let log = |axis: &Axis| if axis.log { "log" } else { "linear" };
        format!(
            "<svg viewBox=\"0 0 {w} {h}\" role=\"img\" aria-label=\"{label}\" data-box=\"{l} {t} {bw} {bh}\" data-x=\"{x0} {x1}\" data-y=\"{y1} {y0}\" \
             data-xscale=\"{xs}\" data-yscale=\"{ys}\"{equal}>\n{x}{y}\
             <svg class=\"clip\" x=\"{l}\" y=\"{t}\" width=\"{bw}\" height=\"{bh}\" viewBox=\"{l} {t} {bw} {bh}\"><g class=\"marks\">\n{marks}</g></svg>\n\
             <rect class=\"box\" x=\"{l}\" y=\"{t}\" width=\"{bw}\" height=\"{bh}\" pointer-events=\"none\"/>{beside}</svg>\n",
            w = px(left + width + self.right),
            h = px(top + height + BOTTOM + self.below()),
            label = escaped(&self.label),
            x0 = self.x.ends[0],
            x1 = self.x.ends[1],
            y0 = self.y.ends[0],
            y1 = self.y.ends[1],
            xs = log(&self.x),
            ys = log(&self.y),
            equal = if self.equal { " data-equal=\"1\"" } else { "" },
            marks = if self.marks.matches("<rect").count() > CELLS {
                self.marks.replace("class=\"cell\"", "class=\"cell fine\"")
            } else {
                self.marks
            },
            beside = self.beside,
        )
    }

    /// Room that names below need because they are turned, px of the drawing; 0 where they fit as they are.
    fn below(&self) -> f64 {
        let longest = self.x.names.iter().map(|name| name.chars().count()).max().unwrap_or(0) as f64 * LETTER;
        if longest < self.at[2] / self.x.names.len().max(1) as f64 { 0.0 } else { 0.5 * longest }
    }

    fn axis(&self, is_x: bool) -> String {
        let [left, top, width, height] = self.at;
        let axis = if is_x { &self.x } else { &self.y };
        // Names are not made anew when the plot is zoomed.
        let class = if axis.names.is_empty() { "tick" } else { "name" };
        let mut text = format!("<g class=\"axis {}\">", if is_x { "x" } else { "y" });
        for (value, label) in axis.ticks() {
            let label = escaped(&label);
            let part = axis.part(value);
            let _ = if is_x && self.below() > 0.0 {
                let x = px(left + part * width);
                write!(
                    text,
                    "<g class=\"{class}\" transform=\"translate({x} {})\"><line y2=\"5\"/><text y=\"14\" transform=\"rotate(-30)\" style=\"text-anchor:end\">{label}</text></g>",
                    px(top + height)
                )
            } else if is_x {
                let x = px(left + part * width);
                write!(
                    text,
                    "<g class=\"{class}\" transform=\"translate({x} {})\"><line y2=\"5\"/><text y=\"20\">{label}</text></g>",
                    px(top + height)
                )
            } else {
                let y = px(top + (1.0 - part) * height);
                write!(
                    text,
                    "<g class=\"{class}\" transform=\"translate({} {y})\"><line x2=\"-5\"/><text x=\"-9\">{label}</text></g>",
                    px(left)
                )
            };
        }
        let title = escaped(&axis.title);
        let _ = if is_x {
            write!(
                text,
                "</g><text class=\"title x\" x=\"{}\" y=\"{}\">{title}</text>",
                px(left + width / 2.0),
                px(top + height + 42.0 + self.below())
            )
        } else {
            write!(text, "</g><text class=\"title y\" x=\"{}\" y=\"{}\">{title}</text>", px(left - 60.0), px(top - 12.0))
        };
        text.push('\n');
        text
    }
}
