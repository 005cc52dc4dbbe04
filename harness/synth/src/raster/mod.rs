//! Outlines in the image to grey values, exact under the kernel of lens and photosite.

mod piece;
mod sharp;
mod strip;
#[cfg(test)]
mod tests;

use calibench_model::{Image, Scene};
use rayon::prelude::*;

use crate::optics::{Levels, Optics, OpticsError};
use strip::{Rules, Strip};

pub use piece::Piece;
pub(crate) use piece::orient;
use piece::{at, polygon};

/// Rows that are worked on together.
pub const STRIP_ROWS: usize = 32;
/// Pieces are cut to this length, px, so that few reach into more than two strips.
const LONGEST_PIECE: f64 = 24.0;

/// What is to be rendered: closed outlines over a uniform background.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
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

    /// The noise-free image. `jitter` is the shift of each row to the right, px, or empty.
    pub fn render(&self, picture: &Picture, jitter: &[f64]) -> Image {
        self.render_with(picture, jitter, |_, _| ())
    }

    /// The image, each strip of rows handed to `finish` with the number of its first row while it is at hand: for what comes after the lens. Strips are finished
    /// in any order, on any thread.
    ///
    /// # Panics
    /// If the picture is not of this renderer's size, or `jitter` neither empty nor one shift a row.
    pub fn render_with(&self, picture: &Picture, jitter: &[f64], finish: impl Fn(usize, &mut [f32]) + Sync) -> Image {
        assert_eq!((picture.width, picture.height), (self.width, self.height), "the renderer's size");
        assert!(jitter.is_empty() || jitter.len() == self.height, "one shift a row");
        let pieces = self.cut(&picture.pieces);
        let listed = Listed::new(&pieces, self.height, self.levels.reach()[1]);
        let mut grey = vec![0.0_f32; self.width * self.height];
        let new_strip = || Strip::new(self.width, STRIP_ROWS, self.levels.reach()[0]);
        grey.par_chunks_mut(self.width * STRIP_ROWS).enumerate().for_each_init(new_strip, |strip, (number, rows)| {
            let top = number * STRIP_ROWS;
            let jitter = jitter.get(top..(top + STRIP_ROWS).min(self.height)).filter(|jitter| !jitter.is_empty());
            self.strip(strip, top, &pieces, listed.of(number), picture.background, jitter, rows);
            finish(top, rows);
        });
        Image::new(self.width, self.height, grey)
    }

    #[allow(clippy::too_many_arguments)]
    fn strip(
        &self,
        strip: &mut Strip,
        top: usize,
        pieces: &[Piece],
        listed: &[u32],
        background: f64,
        jitter: Option<&[f64]>,
        rows: &mut [f32],
    ) {
        let count = rows.len() / self.width;
        let [kernel] = &self.levels.kernels[..] else {
            return self.blended(strip, top, pieces, listed, background, jitter, rows);
        };
        strip.reset(top as i64, count);
        strip.add(pieces, listed, kernel, self.rules, jitter);
        strip.finish(|y, values| {
            for (grey, value) in rows[y * self.width..].iter_mut().zip(values) {
                *grey = (background + value) as f32;
            }
        });
    }

    /// Renders at every level of blur and blends.
    #[allow(clippy::too_many_arguments)]
    fn blended(
        &self,
        strip: &mut Strip,
        top: usize,
        pieces: &[Piece],
        listed: &[u32],
        background: f64,
        jitter: Option<&[f64]>,
        rows: &mut [f32],
    ) {
        let count = rows.len() / self.width;
        let n = self.levels.kernels.len();
        let mut blended = vec![background; rows.len()];
        let mut weights = vec![0.0; rows.len() * n];
        for (i, weights) in weights.chunks_exact_mut(n).enumerate() {
            self.levels.weights((i % self.width) as f64, (top + i / self.width) as f64, weights);
        }
        for (level, kernel) in self.levels.kernels.iter().enumerate() {
            strip.reset(top as i64, count);
            strip.add(pieces, listed, kernel, self.rules, jitter);
            strip.finish(|y, values| {
                for (i, value) in (y * self.width..).zip(values) {
                    blended[i] += weights[i * n + level] * value;
                }
            });
        }
        for (grey, value) in rows.iter_mut().zip(blended) {
            *grey = value as f32;
        }
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
