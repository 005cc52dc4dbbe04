//! Decoded pixels to grey values.

use calibench_model::Image;
use image::DynamicImage;
use rayon::prelude::*;

/// Pixels that a thread takes at a time.
const SHARE: usize = 1 << 18;

/// The grey values of a decoded image, fractions of full scale; colour becomes luma, transparency is ignored.
pub(super) fn of(decoded: &DynamicImage) -> Image {
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
    let grey = match decoded {
        DynamicImage::ImageLuma8(i) => grey_of::<u8, 1>(i, 255.0),
        DynamicImage::ImageLumaA8(i) => grey_of::<u8, 2>(i, 255.0),
        DynamicImage::ImageRgb8(i) => grey_of::<u8, 3>(i, 255.0),
        DynamicImage::ImageRgba8(i) => grey_of::<u8, 4>(i, 255.0),
        DynamicImage::ImageLuma16(i) => grey_of::<u16, 1>(i, 65535.0),
        DynamicImage::ImageLumaA16(i) => grey_of::<u16, 2>(i, 65535.0),
        DynamicImage::ImageRgb16(i) => grey_of::<u16, 3>(i, 65535.0),
        DynamicImage::ImageRgba16(i) => grey_of::<u16, 4>(i, 65535.0),
        other => grey_of::<f32, 3>(&other.to_rgb32f(), 1.0),
    };
    Image::new(width, height, grey)
}

/// `CHANNELS` 1 or 2: grey (and alpha); 3 or 4: red, green, blue (and alpha).
fn grey_of<T: Copy + Into<f64> + Sync, const CHANNELS: usize>(values: &[T], full_scale: f64) -> Vec<f32> {
    let luma = |pixel: &[T; CHANNELS]| match pixel.as_slice() {
        [red, green, blue, ..] => 0.299 * (*red).into() + 0.587 * (*green).into() + 0.114 * (*blue).into(),
        [grey, ..] => (*grey).into(),
        [] => 0.0,
    };
    let (pixels, _) = values.as_chunks::<CHANNELS>();
    let mut grey = vec![0.0; pixels.len()];
    grey.par_chunks_mut(SHARE).zip(pixels.par_chunks(SHARE)).for_each(|(grey, pixels)| {
        grey.iter_mut().zip(pixels).for_each(|(grey, pixel)| *grey = (luma(pixel) / full_scale) as f32);
    });
    grey
}
