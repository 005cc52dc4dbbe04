//! Maps: where the pixels of a picture come from.

use std::ops::Range;

use calibench_model::PixelPoint;
use calibench_model::camera::ImageSize;
use rayon::prelude::*;

use crate::cell::{Cell, Run, SIDE, Shape};
use crate::view::View;

/// Where each pixel of a picture lies in another, the source, to better than 1e-3 px: made once, used for every photograph of a camera.
///
/// Squares of 32 x 32 px are described by polynomials through 4 x 4 exact places, where these are good enough (about 2e-4 px at the places where they are
/// worst), and place by place elsewhere: 0.13 bytes a pixel in place of 8.
#[derive(Clone, Debug)]
pub struct Map {
    size: ImageSize,
    source: ImageSize,
    across: usize,
    cells: Vec<Cell>,
}

impl Map {
    /// Rows of a map that are made together: bands of a picture begin at multiples of it.
    pub const BAND: usize = SIDE;

    /// The map of the pixels of `to` into the pictures of `from`.
    pub fn between(from: &View, to: &View) -> Self {
        Self::new(to.size(), from.size(), |at| to.place_in(from, at))
    }

    /// The map of a picture of `size` to one of the size `source`; `place` is where a pixel lies in it, `None` where it has no counterpart.
    pub fn new(size: ImageSize, source: ImageSize, place: impl Fn(PixelPoint) -> Option<PixelPoint> + Sync) -> Self {
        let (width, height) = (size.width as usize, size.height as usize);
        let (across, down) = (width.div_ceil(SIDE), height.div_ceil(SIDE));
        let cell = |i: usize| {
            let first = [i % across * SIDE, i / across * SIDE];
            Cell::new(first, [SIDE.min(width - first[0]), SIDE.min(height - first[1])], source, &place)
        };
        Self { size, source, across, cells: (0..across * down).into_par_iter().map(cell).collect() }
    }

    /// Columns and rows of the picture that is made.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// Columns and rows of the picture that it is made from.
    pub fn source(&self) -> ImageSize {
        self.source
    }

    /// The squares of the rows from `row`, a multiple of [`Self::BAND`], to the next.
    pub(crate) fn cells(&self, row: usize) -> &[Cell] {
        &self.cells[row / SIDE * self.across..][..self.across]
    }

    /// Pixels that come from the source.
    pub fn covered(&self) -> u64 {
        self.cells.iter().map(|cell| cell.covered as u64).sum()
    }

    /// The share of pixels that come from the source, 0 to 1.
    pub fn coverage(&self) -> f64 {
        self.covered() as f64 / (f64::from(self.size.width) * f64::from(self.size.height))
    }

    /// The most that the source moves from a pixel to the next, px: above 1 the picture shrinks there.
    pub fn shrinks(&self) -> f64 {
        self.cells.iter().flat_map(|cell| cell.stretch).fold(0.0, |most, stretch| f64::from(stretch).max(most))
    }

    /// The share of squares that are kept place by place.
    pub fn singles(&self) -> f64 {
        self.cells.iter().filter(|cell| matches!(cell.shape, Shape::Single(_))).count() as f64 / self.cells.len().max(1) as f64
    }

    /// Rows of the source from which `rows` of the picture come (whole bands), with `reach` more on both sides; empty where nothing comes from it.
    pub fn rows_for(&self, rows: Range<usize>, reach: usize) -> Range<usize> {
        let bands = rows.start / SIDE..rows.end.div_ceil(SIDE);
        let cells = self.cells[bands.start * self.across..(bands.end * self.across).min(self.cells.len())].iter();
        let some = cells.filter(|cell| cell.covered > 0);
        let [low, high] = some.fold([i32::MAX, i32::MIN], |[low, high], cell| [low.min(cell.rows[0]), high.max(cell.rows[1])]);
        if high < low {
            return 0..0;
        }
        let height = self.source.height as usize;
        let first = (i64::from(low) - reach as i64).max(0) as usize;
        first.min(height)..((i64::from(high) + 2 + reach as i64).max(0) as usize).min(height)
    }

    /// Where a pixel lies in the source as the map has it; `None` where that is outside of it.
    pub fn place(&self, column: usize, row: usize) -> Option<PixelPoint> {
        let cell = self.cells.get(row / SIDE * self.across + column / SIDE).filter(|_| column < self.size.width as usize)?;
        let (row, i) = (row % SIDE, column % SIDE);
        let mut run = Run::EMPTY;
        (row < cell.size[1]).then(|| cell.run(row, [0.0; 2], self.source, &mut run))?;
        let [x, y] = [(run.column[i], run.right[i]), (run.row[i], run.down[i])].map(|(whole, part)| f64::from(whole) + f64::from(part));
        run.inside[i].then(|| PixelPoint::new(x, y))
    }

    /// 255 for each pixel of `rows` that comes from the source, and 0 for the others.
    pub fn mask(&self, rows: Range<usize>) -> Vec<u8> {
        let width = self.size.width as usize;
        let mut mask = vec![0; width * rows.len()];
        mask.par_chunks_mut(width.max(1)).zip(rows).for_each(|(line, row)| {
            let mut run = Run::EMPTY;
            for (cell, line) in self.cells(row / SIDE * SIDE).iter().zip(line.chunks_mut(SIDE)) {
                cell.run(row % SIDE, [0.0; 2], self.source, &mut run);
                line.iter_mut().zip(run.inside).for_each(|(level, inside)| *level = if inside { u8::MAX } else { 0 });
            }
        });
        mask
    }
}

#[cfg(test)]
mod tests;
