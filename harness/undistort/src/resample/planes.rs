//! Pictures whose channels are made one by one in single precision: under alpha, by splines, of floating point.

use std::ops::Range;

use calibench_model::camera::ImageSize;
use rayon::prelude::*;

use super::job::{Job, Weights};
use super::squares::Level;
use super::{spline, squares};
use crate::cell::{Cell, SIDE};
use crate::kernel::Kernel;
use crate::map::Map;
use crate::picture::Picture;

/// Squares of a map along a side of a block, which is made for itself.
const BLOCK: usize = 8;

/// Rows of the source that a kernel asks for above and below the places of a map.
pub fn reach(kernel: Kernel, map: &Map) -> usize {
    kernel.taps() / 2
        + match kernel {
            Kernel::Spline => spline::MARGIN,
            Kernel::Area => map.shrinks().ceil() as usize,
            _ => 0,
        }
}

/// A block of squares.
struct Block<'a> {
    /// Bands of squares.
    bands: Vec<&'a [Cell]>,
    /// Columns of the picture.
    columns: Range<usize>,
}

/// As [`super::resample`], for any picture.
pub(super) fn resample<T: Level>(map: &Map, kernel: Kernel, picture: &Picture<'_, T>, rows: Range<usize>, into: &mut [T]) {
    let (width, channels) = (map.size().width as usize, picture.channels);
    let (stride, weights) = (width * channels, Weights::new(kernel, 1));
    for (i, into) in into.chunks_mut(BLOCK * SIDE * stride).enumerate() {
        let first = rows.start + i * BLOCK * SIDE;
        let last = first + into.len() / stride.max(1);
        let block = |left: usize| {
            let cells = left..(left + BLOCK).min(width.div_ceil(SIDE));
            let bands = (first..last).step_by(SIDE).map(|row| &map.cells(row)[cells.clone()]).collect();
            Block { bands, columns: cells.start * SIDE..(cells.end * SIDE).min(width) }
        };
        let blocks: Vec<Block<'_>> = (0..width.div_ceil(SIDE)).step_by(BLOCK).map(block).collect();
        let made: Vec<Vec<T>> = blocks.par_iter().map(|block| block.made(map, (kernel, &weights), picture)).collect();
        for (block, made) in blocks.iter().zip(made) {
            let (left, part) = (block.columns.start * channels, block.columns.len() * channels);
            for (into, made) in into.chunks_exact_mut(stride).zip(made.chunks_exact(part)) {
                into[left..left + part].copy_from_slice(made);
            }
        }
    }
}

impl Block<'_> {
    /// Its levels, row by row.
    fn made<T: Level>(&self, map: &Map, (kernel, weights): (Kernel, &Weights), picture: &Picture<'_, T>) -> Vec<T> {
        let rows: usize = self.bands.iter().filter_map(|band| band.first()).map(|cell| cell.size[1]).sum();
        let (pixels, channels) = (rows * self.columns.len(), picture.channels);
        let mut made = vec![T::default(); pixels * channels];
        let Some([columns, lines]) = self.part(map, reach(kernel, map)) else { return made };
        let size = ImageSize { width: columns.len() as u32, height: lines.len() as u32 };
        let loop_of = squares::of_plane(kernel);
        let alpha = picture.has_alpha();
        let mut planes = vec![0.0_f32; pixels * channels];
        for (channel, plane) in planes.chunks_exact_mut(pixels.max(1)).enumerate() {
            let mut part = part_of(picture, [&columns, &lines], channel);
            if kernel == Kernel::Spline {
                spline::filter(&mut part, columns.len(), lines.len());
            }
            let picture = Picture { size, channels: 1, first: 0, samples: &part };
            let mut rest = plane;
            for cells in &self.bands {
                let band = self.columns.len() * cells.first().map_or(0, |cell| cell.size[1]);
                let (into, behind) = rest.split_at_mut(band);
                let offset = [columns.start as i32, lines.start as i32];
                let job = Job { cells, source: map.source(), picture, offset, weights };
                loop_of(&job, into);
                rest = behind;
            }
        }
        for (i, into) in made.chunks_exact_mut(channels).enumerate() {
            let opaque = planes[(channels - 1) * pixels + i];
            for (channel, level) in into.iter_mut().enumerate() {
                let value = planes[channel * pixels + i];
                let is_colour = alpha && channel + 1 < channels;
                *level = T::of_f32(match () {
                    () if !is_colour => value,
                    // What nothing is seen of has no colour.
                    () if T::of_f32(opaque).to_f32() <= 0.0 => 0.0,
                    () => value * T::TOP / opaque,
                });
            }
        }
        made
    }

    /// Columns and rows of the source that it asks for.
    fn part(&self, map: &Map, reach: usize) -> Option<[Range<usize>; 2]> {
        let some = || self.bands.iter().flat_map(|band| band.iter()).filter(|cell| cell.covered > 0);
        some().next()?;
        let ImageSize { width, height } = map.source();
        let around = |bounds: fn(&Cell) -> [i32; 2], count: u32| {
            let [low, high] = some().map(bounds).fold([i32::MAX, i32::MIN], |[low, high], [a, b]| [low.min(a), high.max(b)]);
            let (low, high) = (i64::from(low) - reach as i64, i64::from(high) + 2 + reach as i64);
            low.clamp(0, i64::from(count) - 1) as usize..high.clamp(1, i64::from(count)) as usize
        };
        Some([around(|cell| cell.columns, width), around(|cell| cell.rows, height)])
    }
}

/// A channel of a part of a picture; colours by their alpha.
fn part_of<T: Level>(picture: &Picture<'_, T>, [columns, rows]: [&Range<usize>; 2], channel: usize) -> Vec<f32> {
    let (channels, stride) = (picture.channels, picture.stride());
    let by_alpha = picture.has_alpha() && channel + 1 < channels;
    let mut part = Vec::with_capacity(columns.len() * rows.len());
    for row in rows.clone() {
        let line = &picture.samples[(row - picture.first) * stride..][columns.start * channels..columns.end * channels];
        let pixels = line.chunks_exact(channels);
        if by_alpha {
            part.extend(pixels.map(|pixel| pixel[channel].to_f32() * (pixel[channels - 1].to_f32() / T::TOP)));
        } else {
            part.extend(pixels.map(|pixel| pixel[channel].to_f32()));
        }
    }
    part
}
