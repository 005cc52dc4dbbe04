//! Photographs in, images out.

use std::fs::File;
use std::io::{self, BufReader, Write};
use std::path::{Path, PathBuf};

use calibench_model::Image;
use image::codecs::png::{CompressionType, FilterType, PngEncoder};
use image::{DynamicImage, ExtendedColorType, ImageEncoder, ImageReader};
use thiserror::Error;

use crate::atomic::write_atomically;

/// A photograph that cannot be read, or an image that cannot be written.
#[derive(Debug, Error)]
pub enum PhotoError {
    /// The file itself.
    #[error("{}: {source}", path.display())]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file that cannot be written; the message names it.
    #[error(transparent)]
    Output(#[from] io::Error),
    /// Its content.
    #[error("{}: not an image that can be read: {source} (expected PNG, JPEG, TIFF or PNM)", path.display())]
    Content {
        /// Which file.
        path: PathBuf,
        /// What the decoder says.
        source: image::ImageError,
    },
}

/// Reads a photograph as grey values. The format is found by content; all bits of 16-bit images are kept.
///
/// Colour becomes luma with the weights .299, .587, .114 of Rec. 601, in floating point; transparency is ignored. Orientation tags are
/// ignored too: the frame of a camera is that of its sensor.
///
/// # Errors
/// A file that is missing or no image.
pub fn read_photo(path: &Path) -> Result<Image, PhotoError> {
    let in_file = |source| PhotoError::File { path: path.to_owned(), source };
    let file = File::open(path).map_err(in_file)?;
    if file.metadata().map_err(in_file)?.is_dir() {
        return Err(in_file(io::Error::other("is a folder, expected an image file")));
    }
    let reader = ImageReader::new(BufReader::new(file)).with_guessed_format().map_err(in_file)?;
    let decoded = reader.decode().map_err(|source| PhotoError::Content { path: path.to_owned(), source })?;
    Ok(to_grey(&decoded))
}

fn to_grey(decoded: &DynamicImage) -> Image {
    let (width, height) = (decoded.width() as usize, decoded.height() as usize);
    let eight = |values: &[u8], channels| grey_of(values, channels, 255.0);
    let sixteen = |values: &[u16], channels| grey_of(values, channels, 65535.0);
    let grey = match decoded {
        DynamicImage::ImageLuma8(i) => eight(i, 1),
        DynamicImage::ImageLumaA8(i) => eight(i, 2),
        DynamicImage::ImageRgb8(i) => eight(i, 3),
        DynamicImage::ImageRgba8(i) => eight(i, 4),
        DynamicImage::ImageLuma16(i) => sixteen(i, 1),
        DynamicImage::ImageLumaA16(i) => sixteen(i, 2),
        DynamicImage::ImageRgb16(i) => sixteen(i, 3),
        DynamicImage::ImageRgba16(i) => sixteen(i, 4),
        other => grey_of(&other.to_rgb32f(), 3, 1.0),
    };
    Image::new(width, height, grey)
}

/// `channels` 1 or 2: grey (and alpha); 3 or 4: red, green, blue (and alpha).
fn grey_of<T: Copy + Into<f64>>(values: &[T], channels: usize, full_scale: f64) -> Vec<f32> {
    let luma = |pixel: &[T]| match *pixel {
        [red, green, blue, ..] => 0.299 * red.into() + 0.587 * green.into() + 0.114 * blue.into(),
        [grey, ..] => grey.into(),
        [] => 0.0,
    };
    values.chunks_exact(channels).map(|pixel| (luma(pixel) / full_scale) as f32).collect()
}

/// Writes an image as PNG file: [`encode_png`].
///
/// # Errors
/// What the file system refuses; an older file is then as it was.
pub fn write_png(path: &Path, image: &Image, sixteen_bits: bool) -> Result<(), PhotoError> {
    Ok(write_atomically(path, |file| encode_png(file, image, sixteen_bits))?)
}

/// Encodes an image as PNG of 8 or 16 bits, compressed fast; values outside [0, 1] are clipped.
///
/// # Errors
/// What the output refuses.
pub fn encode_png(output: &mut dyn Write, image: &Image, sixteen_bits: bool) -> io::Result<()> {
    let (width, height) = (image.width() as u32, image.height() as u32);
    let (bytes, colour) = if sixteen_bits {
        let level = |g: &f32| (g.clamp(0.0, 1.0) * 65535.0).round() as u16;
        (image.grey().iter().flat_map(|g| level(g).to_ne_bytes()).collect(), ExtendedColorType::L16)
    } else {
        (image.to_u8(), ExtendedColorType::L8)
    };
    let encoder = PngEncoder::new_with_quality(output, CompressionType::Fast, FilterType::Adaptive);
    encoder.write_image(&bytes, width, height, colour).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_bits_are_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep.png");
        let image = Image::from_fn(256, 256, |x, y| (256 * y + x) as f32 / 65535.0);
        write_png(&path, &image, true).unwrap();
        assert_eq!(read_photo(&path).unwrap(), image);
        write_png(&path, &image, false).unwrap();
        assert!(read_photo(&path).unwrap() != image);
    }

    #[test]
    fn colour_is_not_rounded_to_levels() {
        let grey = grey_of(&[10_u8, 20, 30, 255, 255, 255], 3, 255.0);
        assert!((f64::from(grey[0]) - (2.99 + 11.74 + 3.42) / 255.0).abs() < 1e-8 && (grey[1] - 1.0).abs() < 1e-7);
    }

    #[test]
    fn what_is_no_image_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("text.png");
        std::fs::write(&path, "no image").unwrap();
        assert!(read_photo(&path).unwrap_err().to_string().contains("text.png"));
        assert!(matches!(read_photo(folder.path()), Err(PhotoError::File { .. })));
        assert!(matches!(read_photo(&folder.path().join("none.png")), Err(PhotoError::File { .. })));
    }
}
