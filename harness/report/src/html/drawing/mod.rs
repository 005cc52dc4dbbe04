//! A picture as a drawing of lines: what was drawn, once more.

mod series;

use std::fmt::Write;

use plotters::style::FontTransform;
use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{BackendColor, BackendCoord};

use super::embedded::{self, Embedded};
use super::markup::escaped;
use crate::Canvas;
use crate::canvas::{Stroke, Written};

/// Rows of a scale of colours that are drawn as one.
const STEP: usize = 6;
/// The size of a drawing's text, px, as the page's style has it.
const USUAL_SIZE: f64 = 15.0;

/// A picture as a drawing, before it is known where it stands.
pub(crate) struct Drawing {
    size: (u32, u32),
    attributes: String,
    inside: String,
}

impl Drawing {
    /// What was drawn.
    pub(crate) fn of(canvas: &Canvas) -> Self {
        Self { size: (canvas.width(), canvas.height()), attributes: series::attributes(canvas), inside: series::groups(canvas.strokes()) }
    }

    /// The figure, with a caption.
    pub(crate) fn figure(&self, id: &str, caption: &str) -> String {
        let Self { size: (width, height), attributes, inside } = self;
        let (id, caption) = (escaped(id), escaped(caption));
        format!(
            "<figure class=\"plot\" id=\"{id}\"><svg class=\"still\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{caption}\" data-box=\"0 0 {width} {height}\">\
             <rect width=\"{width}\" height=\"{height}\" fill=\"#fff\"/><g class=\"marks\" fill=\"none\"{attributes}>{inside}</g></svg><figcaption>{caption}</figcaption></figure>\n"
        )
    }
}

/// Adds strokes, in their order.
fn draw(pen: &mut Pencil, strokes: &[Stroke]) {
    let mut rest = strokes;
    while let [stroke, ..] = rest {
        let (rows, dots) = (scale(rest), rest.iter().take_while(|one| matches!(one, Stroke::Dots(..))).count());
        if rows > 1 {
            rest[..rows].chunks(STEP).for_each(|part| pen.band(part));
        } else if dots > 0 {
            pen.dots(&rest[..dots]);
        } else {
            pen.draw(stroke);
        }
        rest = &rest[rows.max(dots)..];
    }
}

/// A line along a row: left, right, row and colour.
fn row(stroke: &Stroke) -> Option<(i32, i32, i32, BackendColor)> {
    let (from, to, pen) = match stroke {
        Stroke::Line([from, to], pen) => (*from, *to, pen),
        Stroke::Path(path, pen) if path.len() == 2 => (path[0], path[1], pen),
        _ => return None,
    };
    (from.1 == to.1 && pen.width == 1).then_some((from.0.min(to.0), from.0.max(to.0), from.1, pen.colour))
}

/// How many strokes from the first on are the rows of a scale of colours, one below the other; 1 if it is none.
fn scale(strokes: &[Stroke]) -> usize {
    let Some((left, right, first, _)) = row(&strokes[0]) else { return 1 };
    let follows = |(place, stroke): (i32, &Stroke)| row(stroke).is_some_and(|(l, r, y, _)| (l, r, y) == (left, right, first + place));
    let rows = (0..).zip(strokes).take_while(|one| follows(*one)).count();
    if rows > STEP { rows } else { 1 }
}

/// The centre and the radius of a mark that is drawn as a circle of short lines.
fn ring(path: &[BackendCoord]) -> Option<(BackendCoord, u32)> {
    const LEAST: usize = 20;
    if path.len() < LEAST || path.first() != path.last() {
        return None;
    }
    let ends = |of: fn(&BackendCoord) -> i32| Some((path.iter().map(of).min()?, path.iter().map(of).max()?));
    let ((left, right), (top, bottom)) = (ends(|at| at.0)?, ends(|at| at.1)?);
    let (x, y, radius) = ((left + right) / 2, (top + bottom) / 2, (right - left) / 2);
    let near = |(px, py): &BackendCoord| (f64::from(px - x).hypot(f64::from(py - y)) - f64::from(radius)).abs() < 0.75;
    (right - left == bottom - top && path.iter().all(near)).then_some(((x, y), radius as u32))
}

/// SVG under way: what follows in one style is one path.
#[derive(Default)]
struct Pencil {
    out: String,
    style: String,
    path: String,
    /// Where the path ends.
    at: BackendCoord,
}

/// A part of a path: where it begins, how it goes on from there, and where the next one is measured from.
struct Piece {
    start: BackendCoord,
    rest: String,
    end: BackendCoord,
}

impl Piece {
    /// One that ends where it began.
    fn closed(start: BackendCoord, rest: String) -> Self {
        Self { start, rest, end: start }
    }

    fn rectangle((left, top): BackendCoord, width: i32, height: i32) -> Self {
        Self::closed((left, top), format!("h{width}v{height}h{}z", -width))
    }

    fn circle((x, y): BackendCoord, radius: u32) -> Self {
        let (r, wide) = (radius as i32, 2 * radius);
        // Both flags of an arc are one digit.
        Self::closed((x - r, y), format!("a{r} {r} 0 10{wide} 0a{r} {r} 0 10-{wide} 0"))
    }

    /// Lines through places, each relative to the one before: shorter. Of a place alone nothing is to be seen but a round end.
    fn lines(path: &[BackendCoord]) -> Self {
        let start = path.first().copied().unwrap_or_default();
        let (mut rest, mut last, mut is_oblique) = (String::new(), start, false);
        for &(x, y) in path.iter().skip(1) {
            let (dx, dy) = (x - last.0, y - last.1);
            let oblique = dx != 0 && dy != 0;
            let _ = match (oblique, is_oblique) {
                (false, _) if dx == 0 && dy != 0 => write!(rest, "v{dy}"),
                (false, _) => write!(rest, "h{dx}"),
                (true, false) => write!(rest, "l{dx}{}{dy}", apart(dy)),
                (true, true) => write!(rest, "{}{dx}{}{dy}", apart(dx), apart(dy)),
            };
            (last, is_oblique) = ((x, y), oblique);
        }
        Self { start, rest, end: last }
    }
}

/// What parts a number from the one before it: a sign does so itself.
fn apart(number: i32) -> &'static str {
    if number < 0 { "" } else { " " }
}

impl Pencil {
    /// What was drawn.
    fn end(mut self) -> String {
        self.close();
        self.out
    }

    fn close(&mut self) {
        if !self.path.is_empty() {
            // Writing to a String cannot fail.
            let _ = write!(self.out, "<path {} d=\"{}\"/>", self.style, self.path);
            self.path.clear();
        }
    }

    fn trace(&mut self, style: String, piece: &Piece) {
        if style != self.style {
            self.close();
            self.style = style;
        }
        let (x, y) = piece.start;
        let _ = if self.path.is_empty() {
            write!(self.path, "M{x} {y}{}", piece.rest)
        } else {
            write!(self.path, "m{}{}{}{}", x - self.at.0, apart(y - self.at.1), y - self.at.1, piece.rest)
        };
        self.at = piece.end;
    }

    fn fill(&mut self, colour: BackendColor, piece: &Piece) {
        self.trace(paint("fill", colour), piece);
    }

    fn line(&mut self, colour: BackendColor, width: u32, piece: &Piece) {
        let width = if width == 1 { String::new() } else { format!(" stroke-width=\"{width}\"") };
        self.trace(format!("{}{width}", paint("stroke", colour)), piece);
    }

    /// A full circle: the round ends of a line of no length, which is shorter than two arcs.
    fn dot(&mut self, centre: BackendCoord, radius: u32, colour: BackendColor) {
        let style = format!("{} stroke-width=\"{}\" stroke-linecap=\"round\"", paint("stroke", colour), 2 * radius);
        self.trace(style, &Piece::closed(centre, "h0".to_owned()));
    }

    /// Rows of a scale of colours, in the colour of the middle one.
    fn band(&mut self, rows: &[Stroke]) {
        let middle = row(&rows[rows.len() / 2]);
        if let (Some((left, right, top, _)), Some((.., colour))) = (row(&rows[0]), middle) {
            self.fill(colour, &Piece::rectangle((left, top), right - left, rows.len() as i32));
        }
    }

    fn draw(&mut self, stroke: &Stroke) {
        match stroke {
            Stroke::Dots(..) => self.dots(std::slice::from_ref(stroke)),
            Stroke::Line([from, to], pen) => self.line(pen.colour, pen.width, &Piece::lines(&[*from, *to])),
            Stroke::Path(path, pen) => {
                let piece = ring(path).map_or_else(|| Piece::lines(path), |(centre, radius)| Piece::circle(centre, radius));
                self.line(pen.colour, pen.width, &piece);
            }
            Stroke::Polygon(corners, colour) => {
                let lines = Piece::lines(corners);
                self.fill(*colour, &Piece::closed(lines.start, format!("{}z", lines.rest)));
            }
            Stroke::Rectangle([(ax, ay), (bx, by)], pen, fill) => {
                let piece = Piece::rectangle((*ax, *ay), bx - ax, by - ay);
                if *fill { self.fill(pen.colour, &piece) } else { self.line(pen.colour, pen.width, &piece) }
            }
            Stroke::Circle(centre, radius, pen, true) => self.dot(*centre, *radius, pen.colour),
            Stroke::Circle(centre, radius, pen, false) => self.line(pen.colour, pen.width, &Piece::circle(*centre, *radius)),
            Stroke::Text(text) => self.write(text),
            Stroke::Pixels { at, columns, zoom, levels } => self.image(*at, (*columns, *zoom), levels),
            // Taken apart before.
            Stroke::Belongs(_) | Stroke::Said(..) => {}
        }
    }

    fn write(&mut self, text: &Written) {
        self.close();
        let (x, y) = text.at;
        let anchor = match text.anchor.h_pos {
            HPos::Left => "",
            HPos::Center => " class=\"m\"",
            HPos::Right => " class=\"e\"",
        };
        let turn = match text.transform {
            FontTransform::None => String::new(),
            FontTransform::Rotate90 => format!(" transform=\"rotate(90 {x} {y})\""),
            FontTransform::Rotate180 => format!(" transform=\"rotate(180 {x} {y})\""),
            FontTransform::Rotate270 => format!(" transform=\"rotate(270 {x} {y})\""),
        };
        let rim = if text.has_rim { " stroke=\"#fff\" stroke-width=\"2\" paint-order=\"stroke\"" } else { "" };
        let _ = write!(self.out, "<text x=\"{x}\" y=\"{y}\"{}{anchor}{turn}{rim}>{}</text>", text_style(text), escaped(&text.text));
    }

    /// Single pixels, one after the other: an image.
    fn dots(&mut self, strokes: &[Stroke]) {
        self.close();
        let row = |stroke: &Stroke| if let Stroke::Dots(at, count, colour) = stroke { Some((*at, *count, *colour)) } else { None };
        self.put(&embedded::dots(strokes.iter().filter_map(row)));
    }

    fn image(&mut self, at: (u32, u32), (columns, zoom): (u32, u32), levels: &[Option<u8>]) {
        self.close();
        self.put(&embedded::part(at, (columns, zoom), levels));
    }

    fn put(&mut self, image: &Embedded) {
        let Embedded { at: (x, y), size: (width, height), url } = image;
        let _ = write!(
            self.out,
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" href=\"{url}\"/>"
        );
    }
}

fn hex(BackendColor { rgb: (r, g, b), .. }: BackendColor) -> String {
    if [r, g, b].iter().all(|part| part % 17 == 0) {
        format!("#{:x}{:x}{:x}", r / 17, g / 17, b / 17)
    } else {
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

fn paint(what: &str, colour: BackendColor) -> String {
    let alpha = if colour.alpha < 1.0 { format!(" {what}-opacity=\"{:.2}\"", colour.alpha) } else { String::new() };
    format!("{what}=\"{}\"{alpha}", hex(colour))
}

/// What differs from the usual text of a drawing, which the page's style says: from the middle of its height, beginning at its place.
fn text_style(text: &Written) -> String {
    // A letter of the pictures' font is as many px high as eleven twelfths of one of a browser's.
    let size = (text.size * 11.0 / 12.0).round();
    let mut parts = Vec::new();
    match text.anchor.v_pos {
        VPos::Top => parts.push("dominant-baseline:text-before-edge".to_owned()),
        VPos::Center => {}
        VPos::Bottom => parts.push("dominant-baseline:auto".to_owned()),
    }
    if size != USUAL_SIZE {
        parts.push(format!("font-size:{size}px"));
    }
    if text.colour.rgb != (0, 0, 0) {
        parts.push(format!("fill:{}", hex(text.colour)));
    }
    if text.colour.alpha < 1.0 {
        parts.push(format!("fill-opacity:{:.2}", text.colour.alpha));
    }
    if parts.is_empty() { String::new() } else { format!(" style=\"{}\"", parts.join(";")) }
}

#[cfg(test)]
mod tests {
    use plotters::prelude::*;

    use super::*;

    #[test]
    fn a_path_is_where_it_was_drawn() {
        let mut pencil = Pencil::default();
        let black = BackendColor { alpha: 1.0, rgb: (0, 0, 0) };
        pencil.line(black, 1, &Piece::lines(&[(10, 20), (7, 24), (9, 24)]));
        pencil.line(black, 1, &Piece::rectangle((3, 4), 5, 6));
        pencil.line(black, 1, &Piece::lines(&[(3, 14), (3, 10)]));
        pencil.fill(BackendColor { alpha: 0.5, rgb: (1, 34, 255) }, &Piece::lines(&[(1, 1), (2, 3)]));
        pencil.close();
        let one = "<path stroke=\"#000\" d=\"M10 20l-3 4h2m-6-20h5v6h-5zm0 10v-4\"/>";
        assert_eq!(pencil.out, format!("{one}<path fill=\"#0122ff\" fill-opacity=\"0.50\" d=\"M1 1l1 2\"/>"));
    }

    #[test]
    fn lines_along_the_axes_and_dots_are_short() {
        let mut pencil = Pencil::default();
        let black = BackendColor { alpha: 1.0, rgb: (0, 0, 0) };
        pencil.line(black, 1, &Piece::lines(&[(1, 1), (4, 1), (4, 0), (5, 1), (3, 4), (3, 4), (1, 2)]));
        pencil.dot((7, 8), 3, black);
        pencil.dot((5, 9), 3, black);
        let dots = "<path stroke=\"#000\" stroke-width=\"6\" stroke-linecap=\"round\" d=\"M7 8h0m-2 1h0\"/>";
        assert_eq!(pencil.end(), format!("<path stroke=\"#000\" d=\"M1 1h3v-1l1 1-2 3h0l-2-2\"/>{dots}"));
    }

    #[test]
    fn a_circle_of_short_lines_is_a_circle_and_no_other_shape_is() {
        let round = |r: f64, squeeze: f64| -> Vec<BackendCoord> {
            let at = |k: i32| f64::from(k) * std::f64::consts::TAU / 24.0;
            (0..=24).map(|k| (50 + (r * at(k).cos()).round() as i32, 60 + (squeeze * r * at(k).sin()).round() as i32)).collect()
        };
        assert_eq!(ring(&round(6.0, 1.0)), Some(((50, 60), 6)));
        assert_eq!(ring(&round(20.0, 0.8)), None);
        assert_eq!(ring(&round(6.0, 1.0)[..24]), None);
        assert_eq!(ring(&[(0, 0), (4, 0), (4, 4), (0, 4), (0, 0)]), None);
    }

    /// What is drawn on a canvas is in the drawing once: lines, texts with their markup as text, and the caption.
    #[test]
    fn a_drawing_holds_what_was_drawn() {
        let mut canvas = Canvas::new(200, 100);
        canvas.text("a < b", 12, (20, 30));
        canvas.frame((10, 10), (50, 40));
        canvas.paint(|area| {
            area.draw(&PathElement::new([(1, 2), (3, 4)], RED)).ok();
        });
        let html = Drawing::of(&canvas).figure("f--a", "it's <b>");
        for part in [
            "id=\"f--a\"",
            "viewBox=\"0 0 200 100\"",
            "a &lt; b</text>",
            "it&#39;s &lt;b&gt;</figcaption>",
            "M10 10h50v40h-50z",
            "stroke=\"#f00\" d=\"M1 2l2 2\"",
        ] {
            assert_eq!(html.matches(part).count(), 1, "{part}: {html}");
        }
    }
}
