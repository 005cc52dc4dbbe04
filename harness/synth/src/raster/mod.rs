//! Outlines in the image to grey values, exact under the kernel of lens and photosite.

mod flow;
mod nodes;
mod outlined;
mod piece;
mod sharp;
mod strip;
#[cfg(test)]
mod tests;

use std::ops::Range;

use calibench_model::{Image, Scene};
use rayon::prelude::*;

use crate::optics::{Kernel, Levels, Optics, OpticsError, Place};
use nodes::Rules;
use strip::Strip;

pub(crate) use flow::{COLUMNS, Derivatives, Flow, LANES, MARGIN, Square, stride};
pub(crate) use outlined::Extent;
pub use outlined::Outlined;
pub use piece::Piece;
use piece::{at, polygon};
pub(crate) use piece::{join_left, orient};

/// Rows that are worked on together.
pub const STRIP_ROWS: usize = 32;
/// Pieces are cut to this length, px, so that few reach into more than two strips.
const LONGEST_PIECE: f64 = 24.0;

/// What is to be rendered: closed outlines over a uniform background.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns, px.
    pub width: usize,
    /// Rows, px.
    pub height: usize,
    /// Grey value outside all outlines, fraction of full scale.
    pub background: f64,
    /// The outlines' pieces. Each outline is closed; what overlapping outlines enclose adds up.
    pub pieces: Vec<Piece>,
}

impl From<&Scene> for Picture {
    fn from(scene: &Scene) -> Self {
        let pieces = scene.polygons.iter().flat_map(|area| polygon(area, scene.background)).collect();
        Self { width: scene.width, height: scene.height, background: scene.background, pieces }
    }
}

/// Renders pictures of one size through one lens.
pub struct Renderer {
    width: usize,
    height: usize,
    levels: Levels,
    rules: &'static Rules,
}

impl Renderer {
    /// For images of `width` x `height` px through `optics`.
    ///
    /// # Errors
    /// Optics that are out of range.
    pub fn new(optics: &Optics, width: usize, height: usize) -> Result<Self, OpticsError> {
        optics.check()?;
        Ok(Self { width, height, levels: Levels::new(optics, width, height), rules: Rules::all() })
    }

    /// How far around a pixel light matters to it, px: along the row and along the column.
    pub(crate) fn reach(&self) -> [f64; 2] {
        self.levels.reach()
    }

    /// The noise-free image. `jitter` is the shift of each row to the right, px, or empty.
    pub fn render(&self, picture: &Picture, jitter: &[f64]) -> Image<'static> {
        self.render_with(picture, jitter, |_, _| ())
    }

    /// The image, each strip of rows handed to `finish` with the number of its first row while it is at hand: for what comes after the lens. A
    /// strip's grey values are fractions of full scale, row by row; `jitter` is that of [`Self::render`]. Strips are finished
    /// in any order, on any thread.
    ///
    /// # Panics
    /// If the picture is not of this renderer's size, or `jitter` neither empty nor one shift a row.
    pub fn render_with(&self, picture: &Picture, jitter: &[f64], finish: impl Fn(usize, &mut [f32]) + Sync) -> Image<'static> {
        assert_eq!((picture.width, picture.height), (self.width, self.height), "the renderer's size");
        assert!(jitter.is_empty() || jitter.len() == self.height, "one shift a row");
        let pieces = self.cut(&picture.pieces);
        let listed = Listed::new(&pieces, self.height, self.levels.reach()[1]);
        let mut grey = vec![0.0_f32; self.width * self.height];
        let new_strip = || Strip::new(self.width, STRIP_ROWS, self.levels.reach()[0]);
        grey.par_chunks_mut(self.width * STRIP_ROWS).enumerate().for_each_init(new_strip, |strip, (number, rows)| {
            let (top, count) = (number * STRIP_ROWS, rows.len() / self.width);
            let jitter = jitter.get(top..top + count).filter(|jitter| !jitter.is_empty());
            let listed = listed.of(number);
            let band =
                Band { pieces: &pieces, listed, background: picture.background, jitter, top: top as i64, rows: count, origin: [0, 0] };
            if let [kernel] = &*self.levels.kernels {
                self.mark(strip, &band, kernel);
                strip.finish_into(band.background, rows);
            } else {
                self.band(strip, &band, |y, values| {
                    for (grey, value) in rows[y * self.width..].iter_mut().zip(values) {
                        *grey = *value as f32;
                    }
                });
            }
            finish(top, rows);
        });
        Image::new(self.width, self.height, grey)
    }

    /// The grey values of `square`, row by row, in f64, of the pieces as `moved` moves them on `background`.
    pub(crate) fn render_window(&self, picture: &Picture, background: f64, moved: impl Fn(&Piece) -> Piece, square: Square) -> Vec<f64> {
        let Square { corner: [left, top], side } = square;
        let [reach_x, reach_y] = self.levels.reach();
        let (low, high) = (top as f64 - reach_y - 1.0, top as f64 + side as f64 + reach_y + 1.0);
        let right = left as f64 + side as f64 + reach_x + 1.0;
        let shifted = |piece: Piece| Piece { points: piece.points.map(|[x, y]| [x - left as f64, y - top as f64]), ..piece };
        let counts = |piece: &Piece| piece.contrast != 0.0 && piece.rows()[1] > low && piece.rows()[0] < high && piece.columns()[0] < right;
        let pieces: Vec<Piece> = picture.pieces.iter().map(moved).filter(counts).map(shifted).collect();
        let listed: Vec<u32> = (0..pieces.len() as u32).collect();
        let band = Band { pieces: &pieces, listed: &listed, background, jitter: None, top: 0, rows: side, origin: [left, top] };
        let mut grey = Vec::with_capacity(side * side);
        self.band(&mut Strip::new(side, side, reach_x), &band, |_, values| grey.extend_from_slice(values));
        grey
    }

    /// Renders a band and hands on its rows, counted from its first.
    fn band(&self, strip: &mut Strip, band: &Band<'_>, mut row: impl FnMut(usize, &[f64])) {
        if let [kernel] = &*self.levels.kernels {
            self.mark(strip, band, kernel);
            return strip.finish(band.background, row);
        }
        // At every level of blur, blended at each pixel that a piece reaches; the others are alike at all of them.
        let columns = self.columns(band, strip.width());
        let place = |y: usize, column: usize| {
            self.levels.place((band.origin[0] + column as i64) as f64, (band.origin[1] + band.top + y as i64) as f64)
        };
        let places: Vec<Place> =
            (0..band.rows).flat_map(|y| columns.clone().map(move |column| (y, column))).map(|(y, x)| place(y, x)).collect();
        let mut blended = vec![0.0; band.rows * strip.width()];
        for (level, kernel) in self.levels.kernels.iter().enumerate() {
            self.mark(strip, band, kernel);
            strip.finish(band.background, |y, values| {
                let sums = &mut blended[y * values.len()..(y + 1) * values.len()];
                if level == 0 {
                    sums.copy_from_slice(values);
                    sums[columns.clone()].fill(0.0);
                }
                let places = &places[y * columns.len()..(y + 1) * columns.len()];
                self.levels.add(level, places, &values[columns.clone()], &mut sums[columns.clone()]);
            });
            if columns.is_empty() {
                break;
            }
        }
        blended.chunks_exact(strip.width()).enumerate().for_each(|(y, values)| row(y, values));
    }

    /// What the pieces of a band change through one kernel.
    fn mark(&self, strip: &mut Strip, band: &Band<'_>, kernel: &Kernel) {
        strip.reset(band.top, band.rows);
        strip.add(band.pieces, band.listed, kernel, self.rules, band.jitter);
    }

    /// The columns of a band, which has `width` of them, that any of its pieces reaches.
    fn columns(&self, band: &Band<'_>, width: usize) -> Range<usize> {
        let shift = |ends: [f64; 2], jitter: f64| [ends[0].min(jitter), ends[1].max(jitter)];
        let [least, most] = band.jitter.unwrap_or_default().iter().fold([0.0, 0.0], |ends, jitter| shift(ends, *jitter));
        let reach = self.levels.reach()[0] + 2.0;
        let reached = band.listed.iter().map(|&piece| band.pieces[piece as usize].columns());
        let [low, high] = reached.fold([f64::INFINITY, f64::NEG_INFINITY], |ends, [low, high]| [ends[0].min(low), ends[1].max(high)]);
        let column = |at: f64| at.clamp(0.0, width as f64) as usize;
        let (first, end) = (column((low + least - reach).floor()), column((high + most + reach).ceil() + 1.0));
        first..end.max(first)
    }

    /// The pieces that matter, none of them long.
    fn cut(&self, pieces: &[Piece]) -> Vec<Piece> {
        let [reach_x, reach_y] = self.levels.reach();
        let (right, bottom) = (self.width as f64 + reach_x, self.height as f64 + reach_y);
        // An outline wholly above, below or right of the frame marks nothing; one on the left marks what adds up to nothing, but only as a whole.
        let kept = |piece: &Piece| piece.rows()[1] > -reach_y && piece.rows()[0] < bottom && piece.columns()[0] < right;
        let mut cut = Vec::with_capacity(pieces.len());
        for piece in pieces.iter().filter(|piece| kept(piece)) {
            let n = (piece.length() / LONGEST_PIECE).ceil().max(1.0);
            if n == 1.0 {
                cut.push(*piece);
                continue;
            }
            let [x, y] = piece.polynomial();
            let point = |t: f64| [at(x, t), at(y, t)];
            let [mut start, .., last] = piece.points;
            for i in 0..n as usize {
                let inner = |quarter: f64| point((i as f64 + quarter / 4.0) / n);
                let end = if i + 1 == n as usize { last } else { inner(4.0) };
                let part = Piece { points: [start, inner(1.0), inner(2.0), inner(3.0), end], contrast: piece.contrast };
                if kept(&part) {
                    cut.push(part);
                }
                start = end;
            }
        }
        cut
    }
}

/// Rows to be rendered.
struct Band<'a> {
    pieces: &'a [Piece],
    /// The pieces that reach into these rows.
    listed: &'a [u32],
    background: f64,
    /// The shift of each of the rows to the right, px.
    jitter: Option<&'a [f64]>,
    /// The first row, in the pieces' coordinates.
    top: i64,
    rows: usize,
    /// Where the origin of the pieces' coordinates lies in the frame.
    origin: [i64; 2],
}

/// Which pieces reach into which strip.
struct Listed {
    starts: Vec<usize>,
    indices: Vec<u32>,
}

impl Listed {
    fn new(pieces: &[Piece], height: usize, reach: f64) -> Self {
        let strips = height.div_ceil(STRIP_ROWS);
        let range = |piece: &Piece| {
            let [low, high] = piece.rows();
            let strip = |y: f64| (y / STRIP_ROWS as f64).floor().clamp(0.0, strips as f64 - 1.0) as usize;
            strip(low - reach)..strip(high + reach) + 1
        };
        let mut starts = vec![0; strips + 1];
        for piece in pieces {
            for strip in range(piece) {
                starts[strip + 1] += 1;
            }
        }
        for strip in 0..strips {
            starts[strip + 1] += starts[strip];
        }
        let mut next = starts.clone();
        let mut indices = vec![0; starts[strips]];
        for (index, piece) in pieces.iter().enumerate() {
            for strip in range(piece) {
                indices[next[strip]] = index as u32;
                next[strip] += 1;
            }
        }
        Self { starts, indices }
    }

    fn of(&self, strip: usize) -> &[u32] {
        &self.indices[self.starts[strip]..self.starts[strip + 1]]
    }
}
