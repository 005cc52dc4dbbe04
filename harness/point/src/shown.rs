//! Photographs as a browser shows them: tiles of 8-bit grey values, in levels that are each half as large as the one before.

use std::fmt;
use std::path::Path;

use calibench_images::{PhotoError, head_of, read_photo};
use calibench_model::{Image, level};
use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageError};

/// Side of a tile, px.
pub const TILE: usize = 512;
/// Of JPEG: what it changes of grey values is a level or two.
const QUALITY: u8 = 95;
/// Share of the pixels at either end that is shown as black or white where grey values are stretched.
const CLIPPED: f64 = 5e-4;

/// The grey values that are shown as black and as white, fractions of full scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Shown as 0.
    pub black: f32,
    /// Shown as 255.
    pub white: f32,
}

impl Stretch {
    /// Full scale: as 8-bit photographs are shown.
    pub const NONE: Self = Self { black: 0.0, white: 1.0 };

    /// From the value below which a two-thousandth of the pixels lies to the one above which as many do.
    fn of(image: &Image) -> Self {
        let mut counts = vec![0_u64; 1 << 16];
        image.grey().iter().for_each(|&grey| counts[usize::from(level(grey, u16::MAX))] += 1);
        let most = (image.grey().len() as f64 * CLIPPED) as u64;
        let (black, white) = (end(0..counts.len(), &counts, most), end((0..counts.len()).rev(), &counts, most));
        if black < white { Self { black: black as f32 / 65535.0, white: white as f32 / 65535.0 } } else { Self::NONE }
    }

    fn apply(self, grey: f32) -> u8 {
        level((grey - self.black) / (self.white - self.black), 255) as u8
    }
}

/// The first of `levels` up to which more than `most` pixels were counted.
fn end(mut levels: impl Iterator<Item = usize>, counts: &[u64], most: u64) -> usize {
    let mut seen = 0;
    let found = levels.find(|&one| {
        seen += counts[one];
        seen > most
    });
    found.unwrap_or(0)
}

impl fmt::Display for Stretch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == Self::NONE {
            return f.write_str("grey values as they are");
        }
        write!(f, "16 bits: black is {:.4}, white is {:.4} of full scale", self.black, self.white)
    }
}

/// One level: grey values row by row.
struct Level {
    width: usize,
    height: usize,
    grey: Vec<u8>,
}

impl Level {
    /// Half as large, rounded up: means of squares of two pixels, of what of them is in the image at the right and at the bottom.
    fn halved(&self) -> Self {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut grey = Vec::with_capacity(width * height);
        for y in 0..height {
            let row = |y: usize| &self.grey[y * self.width..(y + 1) * self.width];
            let (upper, lower) = (row(2 * y), row((2 * y + 1).min(self.height - 1)));
            for x in 0..width {
                let right = (2 * x + 1).min(self.width - 1);
                let sum = [upper[2 * x], upper[right], lower[2 * x], lower[right]].map(u16::from).iter().sum::<u16>();
                grey.push(((sum + 2) / 4) as u8);
            }
        }
        Self { width, height, grey }
    }

    fn tile(&self, column: usize, row: usize) -> Option<(usize, usize, Vec<u8>)> {
        let (left, top) = (column.checked_mul(TILE)?, row.checked_mul(TILE)?);
        if left >= self.width || top >= self.height {
            return None;
        }
        let (width, height) = (TILE.min(self.width - left), TILE.min(self.height - top));
        let rows = (top..top + height).flat_map(|y| &self.grey[y * self.width + left..y * self.width + left + width]);
        Some((width, height, rows.copied().collect()))
    }
}

/// A photograph as it is shown: what [`read_photo`] reads, upright, as 8-bit grey values.
///
/// A pixel of the first level is a pixel of the image; one of level `l` covers `2^l` x `2^l` of them.
pub struct Shown {
    levels: Vec<Level>,
    /// Which grey values are black and white.
    pub stretch: Stretch,
}

impl Shown {
    /// Levels of an image down to one that is a single tile. Deep ones are stretched: see [`Stretch`].
    pub fn of(image: &Image, deep: bool) -> Self {
        let stretch = if deep { Stretch::of(image) } else { Stretch::NONE };
        let grey = image.grey().iter().map(|&grey| stretch.apply(grey)).collect();
        let mut levels = vec![Level { width: image.width(), height: image.height(), grey }];
        while let Some(last) = levels.last().filter(|last| last.width.max(last.height) > TILE) {
            levels.push(last.halved());
        }
        Self { levels, stretch }
    }

    /// The photograph of a file, and its grey values as operators get them.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn read(path: &Path) -> Result<(Self, Image<'static>), PhotoError> {
        let image = read_photo(path)?.image;
        Ok((Self::of(&image, head_of(path)?.is_deep), image))
    }

    /// Columns and rows, px.
    pub fn size(&self) -> [usize; 2] {
        self.levels.first().map_or([0, 0], |level| [level.width, level.height])
    }

    /// How many levels there are.
    pub fn levels(&self) -> usize {
        self.levels.len()
    }

    /// The places of all tiles: level, column, row.
    pub fn places(&self) -> Vec<[usize; 3]> {
        let of = |(index, level): (usize, &Level)| {
            let (columns, rows) = (level.width.div_ceil(TILE), level.height.div_ceil(TILE));
            (0..rows).flat_map(move |row| (0..columns).map(move |column| [index, column, row]))
        };
        self.levels.iter().enumerate().flat_map(of).collect()
    }

    /// A tile as JPEG; `None` where there is none.
    ///
    /// # Errors
    /// What the encoder refuses.
    pub fn tile(&self, [level, column, row]: [usize; 3]) -> Result<Option<Vec<u8>>, ImageError> {
        let Some((width, height, grey)) = self.levels.get(level).and_then(|level| level.tile(column, row)) else { return Ok(None) };
        let mut bytes = Vec::new();
        JpegEncoder::new_with_quality(&mut bytes, QUALITY).encode(&grey, width as u32, height as u32, ExtendedColorType::L8)?;
        Ok(Some(bytes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_the_image_and_show_its_grey_values() {
        let image = Image::from_fn(1301, 700, |x, y| if (x / 40 + y / 40) % 2 == 0 { 0.25 } else { 0.75 });
        let shown = Shown::of(&image, false);
        assert_eq!((shown.size(), shown.levels(), shown.stretch), ([1301, 700], 3, Stretch::NONE));
        assert_eq!(shown.places().len(), 3 * 2 + 2 + 1);
        for [level, column, row] in shown.places() {
            let tile = image::load_from_memory(&shown.tile([level, column, row]).unwrap().unwrap()).unwrap().to_luma8();
            for (x, y, pixel) in tile.enumerate_pixels().filter(|_| level == 0) {
                let grey = image.at(column * TILE + x as usize, row * TILE + y as usize) * 255.0;
                assert!((f32::from(pixel.0[0]) - grey).abs() < 12.0, "{column} {row} {x} {y}: {} {grey}", pixel.0[0]);
            }
        }
        assert!(shown.tile([0, 3, 0]).unwrap().is_none() && shown.tile([3, 0, 0]).unwrap().is_none());
        assert!(shown.tile([0, usize::MAX, 0]).unwrap().is_none());
        let last = shown.tile([2, 0, 0]).unwrap().unwrap();
        assert_eq!(image::load_from_memory(&last).unwrap().to_luma8().dimensions(), (326, 175));
    }

    #[test]
    fn deep_photographs_are_stretched() {
        let image = Image::from_fn(100, 100, |x, y| 0.1 + 0.05 * (y * 100 + x) as f32 / 9999.0);
        let Stretch { black, white } = Shown::of(&image, true).stretch;
        assert!((black - 0.1).abs() < 2e-4 && (white - 0.15).abs() < 2e-4, "{black} {white}");
        let flat = Shown::of(&Image::from_fn(9, 9, |_, _| 0.4), true);
        assert_eq!(flat.stretch, Stretch::NONE);
    }
}
