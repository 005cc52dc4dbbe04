//! Decoded pixels to grey values.

use std::ops::Range;

use calibench_model::Image;
use image::DynamicImage;

/// The grey values of some rows of a decoded image, fractions of full scale; colour becomes luma, transparency is ignored.
pub(super) fn of_rows(decoded: &DynamicImage, rows: Range<usize>) -> Image<'static> {
    let mut grey = vec![0.0; decoded.width() as usize * rows.len()];
    fill(decoded, rows.start, &mut grey);
    Image::new(decoded.width() as usize, rows.len(), grey)
}

/// Writes the grey values of as many rows as there is room for, from row `first` on.
pub(super) fn fill(decoded: &DynamicImage, first: usize, into: &mut [f32]) {
    let begin = first * decoded.width() as usize;
    let part = |channels: usize| begin * channels..(begin + into.len()) * channels;
    match decoded {
        DynamicImage::ImageLuma8(i) => by_table::<1>(&i.as_raw()[part(1)], into),
        DynamicImage::ImageLumaA8(i) => by_table::<2>(&i.as_raw()[part(2)], into),
        DynamicImage::ImageRgb8(i) => grey_of::<u8, 3>(&i.as_raw()[part(3)], 255.0, into),
        DynamicImage::ImageRgba8(i) => grey_of::<u8, 4>(&i.as_raw()[part(4)], 255.0, into),
        DynamicImage::ImageLuma16(i) => grey_of::<u16, 1>(&i.as_raw()[part(1)], 65535.0, into),
        DynamicImage::ImageLumaA16(i) => grey_of::<u16, 2>(&i.as_raw()[part(2)], 65535.0, into),
        DynamicImage::ImageRgb16(i) => grey_of::<u16, 3>(&i.as_raw()[part(3)], 65535.0, into),
        DynamicImage::ImageRgba16(i) => grey_of::<u16, 4>(&i.as_raw()[part(4)], 65535.0, into),
        DynamicImage::ImageRgb32F(i) => grey_of::<f32, 3>(&i.as_raw()[part(3)], 1.0, into),
        DynamicImage::ImageRgba32F(i) => grey_of::<f32, 4>(&i.as_raw()[part(4)], 1.0, into),
        other => grey_of::<f32, 3>(&other.to_rgb32f().as_raw()[part(3)], 1.0, into),
    }
}

/// The grey values of `width` x `height` 8-bit levels, row by row; `None` if there are not so many.
pub fn of_bytes(width: usize, height: usize, levels: &[u8]) -> Option<Image<'static>> {
    (width.checked_mul(height) == Some(levels.len())).then(|| in_all(width, height, |into| by_table::<1>(levels, into)))
}

/// The grey values of `width` x `height` 16-bit levels, row by row; `None` if there are not so many.
pub fn of_words(width: usize, height: usize, levels: &[u16]) -> Option<Image<'static>> {
    (width.checked_mul(height) == Some(levels.len())).then(|| in_all(width, height, |into| grey_of::<u16, 1>(levels, 65535.0, into)))
}

fn in_all(width: usize, height: usize, fill: impl FnOnce(&mut [f32])) -> Image<'static> {
    let mut grey = vec![0.0; width * height];
    fill(&mut grey);
    Image::new(width, height, grey)
}

/// Of 8-bit grey values (the first of `CHANNELS`), by a table: a division for each pixel takes about half as long as decoding it.
fn by_table<const CHANNELS: usize>(values: &[u8], into: &mut [f32]) {
    let table: [f32; 256] = std::array::from_fn(|level| (level as f64 / 255.0) as f32);
    for (grey, pixel) in into.iter_mut().zip(values.as_chunks::<CHANNELS>().0) {
        *grey = table[usize::from(pixel[0])];
    }
}

/// `CHANNELS` 1 or 2: grey (and alpha); 3 or 4: red, green, blue (and alpha).
pub(super) fn grey_of<T: Copy + Into<f64>, const CHANNELS: usize>(values: &[T], full_scale: f64, into: &mut [f32]) {
    let luma = |pixel: &[T; CHANNELS]| match *pixel.as_slice() {
        [red, green, blue, ..] => 0.299 * red.into() + 0.587 * green.into() + 0.114 * blue.into(),
        [grey, ..] => grey.into(),
        [] => 0.0,
    };
    for (grey, pixel) in into.iter_mut().zip(values.as_chunks::<CHANNELS>().0) {
        *grey = (luma(pixel) / full_scale) as f32;
    }
}
