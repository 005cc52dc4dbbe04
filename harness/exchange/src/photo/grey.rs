//! Decoded pixels to grey values. On the thread that decodes: one that waited for others here might begin with the next photograph, and wait for the memory
//! that this one holds.

use std::ops::Range;

use calibench_model::Image;
use image::DynamicImage;

/// The grey values of a decoded image, fractions of full scale; colour becomes luma, transparency is ignored.
pub(super) fn of(decoded: &DynamicImage) -> Image<'static> {
    of_rows(decoded, 0..decoded.height() as usize)
}

/// As [`of`], of some rows.
pub(super) fn of_rows(decoded: &DynamicImage, rows: Range<usize>) -> Image<'static> {
    let width = decoded.width() as usize;
    let part = |channels: usize| rows.start * width * channels..rows.end * width * channels;
    let grey = match decoded {
        DynamicImage::ImageLuma8(i) => by_table::<1>(&i.as_raw()[part(1)]),
        DynamicImage::ImageLumaA8(i) => by_table::<2>(&i.as_raw()[part(2)]),
        DynamicImage::ImageRgb8(i) => grey_of::<u8, 3>(&i.as_raw()[part(3)], 255.0),
        DynamicImage::ImageRgba8(i) => grey_of::<u8, 4>(&i.as_raw()[part(4)], 255.0),
        DynamicImage::ImageLuma16(i) => grey_of::<u16, 1>(&i.as_raw()[part(1)], 65535.0),
        DynamicImage::ImageLumaA16(i) => grey_of::<u16, 2>(&i.as_raw()[part(2)], 65535.0),
        DynamicImage::ImageRgb16(i) => grey_of::<u16, 3>(&i.as_raw()[part(3)], 65535.0),
        DynamicImage::ImageRgba16(i) => grey_of::<u16, 4>(&i.as_raw()[part(4)], 65535.0),
        DynamicImage::ImageRgb32F(i) => grey_of::<f32, 3>(&i.as_raw()[part(3)], 1.0),
        DynamicImage::ImageRgba32F(i) => grey_of::<f32, 4>(&i.as_raw()[part(4)], 1.0),
        other => grey_of::<f32, 3>(&other.to_rgb32f().as_raw()[part(3)], 1.0),
    };
    Image::new(width, rows.len(), grey)
}

/// The grey values of `width` x `height` 8-bit levels, row by row; `None` if there are not so many.
pub fn of_bytes(width: usize, height: usize, levels: &[u8]) -> Option<Image<'static>> {
    (width.checked_mul(height) == Some(levels.len())).then(|| Image::new(width, height, by_table::<1>(levels)))
}

/// The grey values of `width` x `height` 16-bit levels, row by row; `None` if there are not so many.
pub fn of_words(width: usize, height: usize, levels: &[u16]) -> Option<Image<'static>> {
    (width.checked_mul(height) == Some(levels.len())).then(|| Image::new(width, height, grey_of::<u16, 1>(levels, 65535.0)))
}

/// Of 8-bit grey values (the first of `CHANNELS`), by a table: a division for each pixel takes about half as long as decoding it.
fn by_table<const CHANNELS: usize>(values: &[u8]) -> Vec<f32> {
    let table: [f32; 256] = std::array::from_fn(|level| (level as f64 / 255.0) as f32);
    values.as_chunks::<CHANNELS>().0.iter().map(|pixel| table[usize::from(pixel[0])]).collect()
}

/// `CHANNELS` 1 or 2: grey (and alpha); 3 or 4: red, green, blue (and alpha).
pub(super) fn grey_of<T: Copy + Into<f64>, const CHANNELS: usize>(values: &[T], full_scale: f64) -> Vec<f32> {
    let luma = |pixel: &[T; CHANNELS]| match *pixel.as_slice() {
        [red, green, blue, ..] => 0.299 * red.into() + 0.587 * green.into() + 0.114 * blue.into(),
        [grey, ..] => grey.into(),
        [] => 0.0,
    };
    values.as_chunks::<CHANNELS>().0.iter().map(|pixel| (luma(pixel) / full_scale) as f32).collect()
}
