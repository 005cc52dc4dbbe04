//! Pictures through maps.

mod job;
mod pairs;
mod planes;
mod spline;
mod squares;
mod taps;

use std::ops::Range;

use rayon::prelude::*;

use crate::kernel::Kernel;
use crate::map::Map;
use crate::picture::{Picture, PictureError};
use job::{Job, Weights};
pub use planes::reach;
pub use squares::Level;

/// Makes `rows` of the picture that `map` describes from `picture`, its source, of which the rows [`Map::rows_for`] with [`reach`] must be there.
///
/// `rows` begin at a multiple of [`Map::BAND`] and end at one, or at the end. Pixels that come from outside of the source, or from nowhere, become 0 in all
/// channels; beyond its border the source is taken as mirrored at the middles of its outermost pixels. Under alpha (2 and 4 channels) colours count by it.
/// Levels are used as they are, whatever their gamma. The same bytes on any number of threads.
///
/// # Errors
/// A picture that is not of the size of the map's source, or lacks rows; `into` of another length than `rows`.
pub fn resample<T: Level>(
    map: &Map,
    kernel: Kernel,
    picture: &Picture<'_, T>,
    rows: Range<usize>,
    into: &mut [T],
) -> Result<(), PictureError> {
    check(map, kernel, picture, &rows, into.len())?;
    let stride = map.size().width as usize * picture.channels;
    let Some(squares) = T::squares(kernel, picture.channels) else {
        planes::resample(map, kernel, picture, rows, into);
        return Ok(());
    };
    let weights = Weights::new(kernel, picture.channels);
    into.par_chunks_mut(Map::BAND * stride).enumerate().for_each(|(band, into)| {
        let row = rows.start + band * Map::BAND;
        let job = Job { cells: map.cells(row), source: map.source(), picture: *picture, offset: [0, 0], weights: &weights };
        squares(&job, into);
    });
    Ok(())
}

fn check<T>(map: &Map, kernel: Kernel, picture: &Picture<'_, T>, rows: &Range<usize>, levels: usize) -> Result<(), PictureError> {
    let (source, size) = (map.source(), map.size());
    let expected = || format!("{} x {}", source.width, source.height);
    if picture.size != source {
        return Err(PictureError::Size { found: format!("{} x {} px", picture.size.width, picture.size.height), expected: expected() });
    }
    let whole = rows.start.is_multiple_of(Map::BAND) && (rows.end.is_multiple_of(Map::BAND) || rows.end == size.height as usize);
    if !whole || rows.end > size.height as usize || rows.len() * size.width as usize * picture.channels != levels {
        let channels = picture.channels;
        return Err(PictureError::Rows { found: levels, width: size.width, height: size.height, channels });
    }
    let (needed, there) = (map.rows_for(rows.clone(), reach(kernel, map)), picture.rows());
    if !needed.is_empty() && (needed.start < there.start || needed.end > there.end) {
        let found = format!("rows {} to {} and not {} to {}", there.start, there.end, needed.start, needed.end);
        return Err(PictureError::Size { found, expected: expected() });
    }
    Ok(())
}

#[cfg(test)]
mod tests;
