//! A plot as SVG that is whole as it stands, with what the script must know to zoom it and to read it off.

use std::fmt::Write;

use super::mark::{Element, Entry, Said, Shades, Shape, px};
use super::{Axis, Plot, WIDTH};
use crate::field::shade;
use crate::markup::{between_bars, escaped};

const LEFT: f64 = 76.0;
const TOP: f64 = 30.0;
const BOTTOM: f64 = 52.0;
/// Steps of a scale of colours.
const STEPS: usize = 64;
/// Cells without lines between them: more than so many are a picture.
const CELLS: usize = 250;
/// Room at the right, and for a scale of colours there.
const RIGHT: f64 = 24.0;
const BAR: f64 = 110.0;

impl Plot {
    /// The figure, with a caption.
    pub(crate) fn figure(&self, caption: &str) -> String {
        let (id, drawing) = (escaped(&self.id), self.drawing());
        format!("<figure class=\"plot\" id=\"{id}\">{drawing}{}<figcaption>{}</figcaption></figure>\n", self.entries(), escaped(caption))
    }

    /// The legend.
    fn entries(&self) -> String {
        let entry = |entry: &Entry| {
            let name = escaped(&entry.name);
            let series = if entry.is_series { format!(" data-series=\"{name}\"") } else { String::new() };
            let (colour, path) = (entry.colour, entry.shape.path());
            format!(
                "<li{series}><svg class=\"swatch s{colour}\" viewBox=\"-6 -6 12 12\" aria-hidden=\"true\"><path class=\"mark\" d=\"{path}\"/></svg> {name}</li>"
            )
        };
        let entries: String = self.legend.iter().map(entry).collect();
        if entries.is_empty() { entries } else { format!("<ul class=\"legend\">{entries}</ul>") }
    }

    /// Left, top, width, height of what is inside the axes, px of the drawing.
    pub(super) fn at(&self) -> [f64; 4] {
        let left = self.left(LEFT);
        [left, TOP, if self.named { (LEFT + WIDTH - left).max(300.0) } else { WIDTH }, self.height]
    }

    /// All that is inside the axes.
    fn marks(&self, at: [f64; 4]) -> String {
        let cells = self.elements.iter().filter(|element| matches!(element, Element::Cell { .. })).count();
        let mut pen = Pen { plot: self, at, out: String::new(), cell: if cells > CELLS { "cell fine" } else { "cell" } };
        self.elements.iter().for_each(|element| pen.draw(element));
        if !pen.out.is_empty() {
            pen.out.push_str("</g>\n");
        }
        pen.out
    }

    /// The drawing alone.
    pub(crate) fn drawing(&self) -> String {
        let at = self.at();
        let [left, top, width, height] = at;
        let [l, t, bw, bh] = at.map(px);
        let (marks, right) = (self.marks(at), if self.shades.is_some() { BAR } else { RIGHT });
        let (x, y) = (self.axis(at, true), self.axis(at, false));
        let log = |axis: &Axis| if axis.log { "log" } else { "linear" };
        format!(
            "<svg viewBox=\"0 0 {w} {h}\" role=\"img\" aria-label=\"{label}\" data-box=\"{l} {t} {bw} {bh}\" data-x=\"{x0} {x1}\" data-y=\"{y1} {y0}\" \
             data-xscale=\"{xs}\" data-yscale=\"{ys}\"{equal}>\n{x}{y}\
             <svg class=\"clip\" x=\"{l}\" y=\"{t}\" width=\"{bw}\" height=\"{bh}\" viewBox=\"{l} {t} {bw} {bh}\"><g class=\"marks\">\n{marks}</g></svg>\n\
             <rect class=\"box\" x=\"{l}\" y=\"{t}\" width=\"{bw}\" height=\"{bh}\" pointer-events=\"none\"/>{beside}</svg>\n",
            w = px(left + width + right),
            h = px(top + height + BOTTOM + self.below(width)),
            label = escaped(&self.label),
            x0 = self.x.ends[0],
            x1 = self.x.ends[1],
            y0 = self.y.ends[0],
            y1 = self.y.ends[1],
            xs = log(&self.x),
            ys = log(&self.y),
            equal = if self.equal { " data-equal=\"1\"" } else { "" },
            beside = self.shades.as_ref().map_or_else(String::new, |shades| shades.drawing(at)),
        )
    }

    fn axis(&self, at: [f64; 4], is_x: bool) -> String {
        let [left, top, width, height] = at;
        let axis = if is_x { &self.x } else { &self.y };
        // Names are not made anew when the plot is zoomed.
        let class = if axis.names.is_empty() { "tick" } else { "name" };
        let mut text = format!("<g class=\"axis {}\">", if is_x { "x" } else { "y" });
        for (value, label) in axis.ticks() {
            let label = escaped(&label);
            let part = axis.part(value);
            let _ = if is_x && self.below(width) > 0.0 {
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
                px(top + height + 42.0 + self.below(width))
            )
        } else {
            write!(text, "</g><text class=\"title y\" x=\"{}\" y=\"{}\">{title}</text>", px(left - 60.0), px(top - 12.0))
        };
        text.push('\n');
        text
    }
}

/// Draws elements.
struct Pen<'p> {
    plot: &'p Plot,
    at: [f64; 4],
    out: String,
    /// The class of cells.
    cell: &'static str,
}

impl Pen<'_> {
    /// A place in the drawing.
    fn place(&self, at: (f64, f64)) -> (f64, f64) {
        self.plot.place(self.at, at)
    }

    fn draw(&mut self, element: &Element) {
        match element {
            Element::Series { colour, name, says } => self.series(*colour, name.as_deref(), says),
            Element::Symbol { shape, at, said } => self.symbol(*shape, *at, said),
            Element::Arrow { from, to, said } => self.arrow(*from, *to, said),
            Element::Cell { corners, fill, said } => self.fill(*corners, *fill, said),
            Element::Line { places, said } => {
                let path = self.path(places);
                let _ = write!(self.out, "<path class=\"line\" d=\"{path}\"{}/>", said.attributes());
            }
            Element::Dashed(places) => {
                let path = self.path(places);
                let _ = write!(self.out, "<path class=\"dashed under\" d=\"{path}\"/><path class=\"dashed\" d=\"{path}\"/>");
            }
            Element::Contour(pieces) => {
                let path: String = pieces.iter().map(|ends| self.path(ends)).collect();
                let _ = write!(self.out, "<path class=\"contour under\" d=\"{path}\"/><path class=\"contour\" d=\"{path}\"/>");
            }
            Element::Dots(places) => {
                let at = |place: &(f64, f64)| {
                    let (x, y) = self.place(*place);
                    format!("M{} {}h0", px(x), px(y))
                };
                let path: String = places.iter().map(at).collect();
                let _ = write!(self.out, "<path class=\"dots\" d=\"{path}\"/>");
            }
            Element::Ring(at) => {
                let (x, y) = self.place(*at);
                let _ = write!(self.out, "<circle class=\"ring\" cx=\"{}\" cy=\"{}\" r=\"10\"/>", px(x), px(y));
            }
            Element::Whisker { x, ends: [low, high], said } => {
                let ((x, a), (_, b)) = (self.place((*x, *low)), self.place((*x, *high)));
                let _ = write!(self.out, "<path class=\"bar\" d=\"M{} {}V{}\"{}/>", px(x), px(a), px(b), said.attributes());
            }
            Element::Note { at, text, is_on_shade } => self.text(if *is_on_shade { "note dark" } else { "note" }, *at, text),
            Element::Tag { at, text } => self.text("note tag", *at, text),
        }
    }

    /// Ends the series before, if there is one, and begins another.
    fn series(&mut self, colour: usize, name: Option<&str>, says: &[String]) {
        if !self.out.is_empty() {
            self.out.push_str("</g>\n");
        }
        let name = name.map_or(String::new(), |name| format!(" data-series=\"{}\"", escaped(name)));
        let says: Vec<String> = says.iter().map(|one| between_bars(one)).collect();
        // Writing to a String cannot fail.
        let _ = write!(self.out, "<g class=\"series s{colour}\"{name} data-names=\"{}\">", says.join("|"));
    }

    fn symbol(&mut self, shape: Shape, at: (f64, f64), said: &Said) {
        let (x, y) = self.place(at);
        let (x, y, path) = (px(x), px(y), shape.path());
        let _ = write!(self.out, "<path class=\"mark\" transform=\"translate({x} {y})\" d=\"{path}\"{}/>", said.attributes());
    }

    fn arrow(&mut self, from: (f64, f64), to: (f64, f64), said: &Said) {
        let ((x, y), (tx, ty)) = (self.place(from), self.place(to));
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
        let _ = write!(self.out, "<path class=\"arrow\" d=\"M{} {}L{} {}{head}\"{}/>", px(x), px(y), px(tx), px(ty), said.attributes());
    }

    fn fill(&mut self, [from, to]: [(f64, f64); 2], fill: Option<[u8; 3]>, said: &Said) {
        let ((ax, ay), (bx, by)) = (self.place(from), self.place(to));
        // What has no colour is pointed at as well.
        let fill = fill.map_or("none\" pointer-events=\"all".to_owned(), |[r, g, b]| format!("#{r:02x}{g:02x}{b:02x}"));
        let _ = write!(
            self.out,
            "<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{fill}\"{}/>",
            self.cell,
            px(ax.min(bx)),
            px(ay.min(by)),
            px((bx - ax).abs()),
            px((by - ay).abs()),
            said.attributes()
        );
    }

    fn path(&self, places: &[(f64, f64)]) -> String {
        let at = |place: &(f64, f64)| {
            let (x, y) = self.place(*place);
            format!("{} {}", px(x), px(y))
        };
        format!("M{}", places.iter().map(at).collect::<Vec<_>>().join("L"))
    }

    fn text(&mut self, class: &str, at: (f64, f64), text: &str) {
        let (x, y) = self.place(at);
        let _ = write!(
            self.out,
            "<text class=\"{class}\" pointer-events=\"none\" x=\"{}\" y=\"{}\" text-anchor=\"middle\" dominant-baseline=\"central\">{}</text>",
            px(x),
            px(y),
            escaped(text)
        );
    }
}

impl Shades {
    /// Beside a plot whose inside lies there.
    fn drawing(&self, [left, top, width, height]: [f64; 4]) -> String {
        let x = left + width + 18.0;
        let mut text = format!("<g class=\"shades\"><text x=\"{}\" y=\"{}\">{}</text>", px(x), px(top - 12.0), escaped(&self.title));
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
        for (part, label) in &self.levels {
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
        text + "</g>"
    }
}
