//! Pictures: enlarged images with marks on them.

mod raster;
mod recorder;
mod runs;
mod series;

use std::io::{self, Write};
use std::sync::Once;

use calibench_files::NewFolder;
use calibench_model::Image;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{ExtendedColorType, ImageEncoder};
use plotters::prelude::*;
use plotters::style::register_font;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use rayon::prelude::*;

pub(crate) use recorder::{Area, EM, Pen, Recorder, Stroke, Written};
pub(crate) use runs::{Run, STEP, ring, row, runs};
use series::Series;
pub(crate) use series::{Depth, OwnMark, Owner};

/// Pictures with their file names.
pub type Pictures = Vec<(String, Canvas)>;

/// Colours that a colour-blind reader can tell apart (Okabe & Ito 2008), dark enough for white paper, in the order of use.
pub const COLOURS: [RGBColor; 6] = [
    RGBColor(213, 94, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// The shape of a mark; no two methods of a picture share shape and colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A hollow square: an approximate position.
    Square,
    /// A long upright cross: the truth.
    Plus,
    /// A diagonal cross.
    Cross,
    /// A circle.
    Circle,
    /// A triangle.
    Triangle,
    /// A square on its corner.
    Diamond,
    /// A small upright cross: the truth of one among many.
    Dot,
    /// An upright cross.
    Upright,
}

impl Mark {
    /// Width of its lines, px of the picture: the truth is a hairline below everything.
    fn stroke(self) -> u32 {
        if self == Self::Plus { 1 } else { 2 }
    }
}

/// The marks of methods, in the order of use.
pub const METHOD_MARKS: [Mark; 4] = [Mark::Cross, Mark::Circle, Mark::Triangle, Mark::Diamond];

/// Half the size of a mark, px of the picture.
const MARK: i32 = 6;

/// A picture under way, white: what is drawn is kept, and becomes pixels or a drawing of lines when it is asked for.
pub struct Canvas {
    width: u32,
    height: u32,
    strokes: Vec<Stroke>,
    series: Series,
}

impl Canvas {
    /// A white picture.
    pub fn new(width: u32, height: u32) -> Self {
        static FONT: Once = Once::new();
        FONT.call_once(|| {
            // The font is compiled in; it is whole.
            let _ = register_font("sans-serif", FontStyle::Normal, ttf_noto_sans::REGULAR);
        });
        Self { width, height, strokes: Vec::new(), series: Series::default() }
    }

    /// Puts the part of `image` of `columns` x `rows` px from pixel (`left`, `top`) at (`x`, `y`), each pixel `zoom` px wide. Outside the image: hatched white.
    pub fn enlarge(&mut self, image: &Image, (left, top): (i64, i64), (columns, rows): (u32, u32), zoom: u32, at: (u32, u32)) {
        // What is not negative is rounded by cutting: the sum is exact.
        let level = |(x, y): (i64, i64)| {
            image.holds(x, y, 0).then(|| (f64::from(image.at(x as usize, y as usize).clamp(0.0, 1.0) * 255.0) + 0.5) as u8)
        };
        let row = |y: i64| (left..left + i64::from(columns)).map(move |x| (x, y));
        let mut levels = Vec::with_capacity(columns as usize * rows as usize);
        (top..top + i64::from(rows)).for_each(|y| levels.extend(row(y).map(level)));
        self.strokes.push(Stroke::Pixels { at, columns, zoom, levels });
    }

    /// Marks, each on a white rim so that it shows on any grey. All rims are drawn before the first mark: none hides another.
    pub fn marks(&mut self, marks: &[(Mark, RGBColor, (f64, f64))]) {
        let own = self.current();
        self.marks_by(marks.iter().map(|mark| (own, *mark)));
    }

    fn marks_by(&mut self, marks: impl Iterator<Item = (Option<usize>, (Mark, RGBColor, (f64, f64)))> + Clone) {
        let whole = |(x, y): (f64, f64)| (x.round() as i32, y.round() as i32);
        let before = self.current();
        for (series, (mark, _, at)) in marks.clone() {
            self.belong(series, Depth::Rims);
            self.outline(mark, WHITE, mark.stroke() + 2, whole(at));
        }
        for (series, (mark, colour, at)) in marks {
            self.belong(series, Depth::Marks);
            self.outline(mark, colour, mark.stroke(), whole(at));
        }
        self.belong(before, Depth::Lines);
    }

    fn outline(&mut self, mark: Mark, colour: RGBColor, width: u32, (x, y): (i32, i32)) {
        let lines: Vec<Vec<(i32, i32)>> = match mark {
            Mark::Square => vec![vec![
                (-MARK - 1, -MARK - 1),
                (MARK + 1, -MARK - 1),
                (MARK + 1, MARK + 1),
                (-MARK - 1, MARK + 1),
                (-MARK - 1, -MARK - 1),
            ]],
            Mark::Plus => vec![vec![(-2 * MARK, 0), (2 * MARK, 0)], vec![(0, -2 * MARK), (0, 2 * MARK)]],
            Mark::Upright => vec![vec![(-MARK - 2, 0), (MARK + 2, 0)], vec![(0, -MARK - 2), (0, MARK + 2)]],
            Mark::Dot => vec![vec![(-2, 0), (2, 0)], vec![(0, -2), (0, 2)]],
            Mark::Cross => vec![vec![(-MARK - 2, -MARK - 2), (MARK + 2, MARK + 2)], vec![(-MARK - 2, MARK + 2), (MARK + 2, -MARK - 2)]],
            Mark::Triangle => vec![vec![(0, -MARK), (MARK, MARK), (-MARK, MARK), (0, -MARK)]],
            Mark::Diamond => vec![vec![(0, -MARK - 2), (MARK + 2, 0), (0, MARK + 2), (-MARK - 2, 0), (0, -MARK - 2)]],
            Mark::Circle => {
                let circle = (0..=24).map(|i| f64::from(i) * std::f64::consts::TAU / 24.0);
                vec![circle.map(|a| ((f64::from(MARK) * a.cos()).round() as i32, (f64::from(MARK) * a.sin()).round() as i32)).collect()]
            }
        };
        let style = ShapeStyle::from(&colour).stroke_width(width);
        self.paint(|area| {
            for line in &lines {
                let line: Vec<_> = line.iter().map(|(dx, dy)| (x + dx, y + dy)).collect();
                area.draw(&PathElement::new(line, style)).ok();
            }
        });
    }

    /// A thin dark frame.
    pub fn frame(&mut self, (x, y): (u32, u32), (width, height): (u32, u32)) {
        let corners = [(x as i32, y as i32), ((x + width) as i32, (y + height) as i32)];
        self.paint(|area| {
            area.draw(&Rectangle::new(corners, BLACK.mix(0.6))).ok();
        });
    }

    /// Black text, its left middle at (`x`, `y`).
    pub fn text(&mut self, text: &str, size: u32, (x, y): (u32, u32)) {
        self.write_text(text, size, BLACK, (x as i32, y as i32));
    }

    /// Black text with a white rim, readable on any grey.
    pub fn label(&mut self, text: &str, size: u32, (x, y): (u32, u32)) {
        let from = self.strokes.len();
        self.write_text(text, size, BLACK, (x as i32, y as i32));
        for stroke in &mut self.strokes[from..] {
            if let Stroke::Text(written) = stroke {
                written.has_rim = true;
            }
        }
    }

    fn write_text(&mut self, text: &str, size: u32, colour: RGBColor, at: (i32, i32)) {
        let style = ("sans-serif", size).into_font().color(&colour).pos(Pos::new(HPos::Left, VPos::Center));
        self.paint(|area| {
            area.draw(&Text::new(text, at, style)).ok();
        });
    }

    /// Its width, px.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Its height, px.
    pub(crate) fn height(&self) -> u32 {
        self.height
    }

    /// What was drawn, in this order.
    pub(crate) fn strokes(&self) -> &[Stroke] {
        &self.strokes
    }

    /// Draws into the picture.
    pub(crate) fn paint(&mut self, draw: impl FnOnce(&Area<'_>)) {
        let area = Recorder::new(&mut self.strokes, (self.width, self.height)).into_drawing_area();
        draw(&area);
        area.present().ok();
    }

    /// Encodes the picture as PNG.
    ///
    /// # Errors
    /// What the output refuses.
    pub fn encode(&self, output: &mut dyn Write) -> io::Result<()> {
        let pixels = raster::pixels(&self.strokes, (self.width, self.height));
        let encoder = PngEncoder::new_with_quality(output, CompressionType::Default, FilterType::Adaptive);
        encoder.write_image(&pixels, self.width, self.height, ExtendedColorType::Rgb8).map_err(io::Error::other)
    }
}

/// Writes pictures by their names into a folder; each is encoded on a thread of its own.
///
/// # Errors
/// What the file system refuses, of the first picture in their order.
pub fn write_pictures(folder: &NewFolder, pictures: &[(String, Canvas)]) -> io::Result<()> {
    let written: Vec<_> = pictures.par_iter().map(|(name, picture)| folder.write(name, |file| picture.encode(file))).collect();
    written.into_iter().collect()
}
