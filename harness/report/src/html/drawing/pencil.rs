//! Strokes as paths, texts and images of SVG.

use std::fmt::Write;

use plotters_backend::{BackendColor, BackendCoord};

use super::colour::paint;
use super::letters::{self, Lettering};
use crate::canvas::{Run, STEP, Stroke, Written, ring, row, runs};
use crate::html::embedded::{self, Embedded};

/// SVG under way: what follows in one style is one path.
pub(super) struct Pencil {
    lettering: Lettering,
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
    /// Nothing yet.
    pub(super) fn new(lettering: Lettering) -> Self {
        Self { lettering, out: String::new(), style: String::new(), path: String::new(), at: (0, 0) }
    }

    /// Adds strokes, in their order.
    pub(super) fn strokes(&mut self, strokes: &[Stroke]) {
        for run in runs(strokes) {
            match run {
                Run::Scale(rows) => rows.chunks(STEP).for_each(|part| self.band(part)),
                Run::Dots(dots) => self.dots(dots),
                Run::One(stroke) => self.draw(stroke),
            }
        }
    }

    /// What was drawn.
    pub(super) fn end(mut self) -> String {
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
        letters::write(&mut self.out, text, self.lettering);
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
        let Embedded { at: (x, y), size: (width, height), raster } = image;
        let url = raster.url();
        let _ = write!(
            self.out,
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\" href=\"{url}\"/>"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_where_it_was_drawn() {
        let mut pencil = Pencil::new(Lettering::OfPage);
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
        let mut pencil = Pencil::new(Lettering::OfPage);
        let black = BackendColor { alpha: 1.0, rgb: (0, 0, 0) };
        pencil.line(black, 1, &Piece::lines(&[(1, 1), (4, 1), (4, 0), (5, 1), (3, 4), (3, 4), (1, 2)]));
        pencil.dot((7, 8), 3, black);
        pencil.dot((5, 9), 3, black);
        let dots = "<path stroke=\"#000\" stroke-width=\"6\" stroke-linecap=\"round\" d=\"M7 8h0m-2 1h0\"/>";
        assert_eq!(pencil.end(), format!("<path stroke=\"#000\" d=\"M1 1h3v-1l1 1-2 3h0l-2-2\"/>{dots}"));
    }
}
