//! PNG files in bands of rows: only their grey values are ever there as a whole, and they are made while the next rows are decoded.

use std::io;
use std::sync::Arc;

use calibench_model::Image;
use image::error::{DecodingError, ImageFormatHint, LimitError, LimitErrorKind};
use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageResult};

use super::helped::{Pixels, grey_while};
use super::{Input, budget, reader};

/// Whether the rows of a file come one after the other: of a PNG that is not interlaced. A file that cannot be read is none of these.
pub(super) fn is_in_rows(input: &mut dyn Input) -> io::Result<bool> {
    if reader(input)?.format() != Some(ImageFormat::Png) {
        return Ok(false);
    }
    let in_rows = png::Decoder::new(&mut *input).read_header_info().is_ok_and(|info| !info.interlaced);
    input.rewind()?;
    Ok(in_rows)
}

/// The grey values of a PNG whose rows come one after the other, whose head says that its pixels are of this size and colour, and of whose memory
/// `share` tells.
pub(super) fn grey_of(input: &mut dyn Input, (size, colour): ((u32, u32), ColorType), share: budget::Share) -> ImageResult<Image<'static>> {
    input.rewind()?;
    // As image's own decoder: what has less than 8 bits, and palettes, in 8.
    let mut decoder =
        png::Decoder::new_with_limits(input, png::Limits { bytes: usize::try_from(budget::MOST_BYTES).unwrap_or(usize::MAX) });
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().map_err(of_png)?;
    grey_while((size.0 as usize, size.1 as usize), share, move |rows| {
        let band = Band { reader: &mut reader, width: size.0, rows: rows.len() as u32, colour, last: rows.end == size.1 as usize };
        Ok(Pixels { decoded: Arc::new(DynamicImage::from_decoder(band)?), first: 0 })
    })
}

/// The next rows of a PNG.
struct Band<'r, 'i> {
    reader: &'r mut png::Reader<&'i mut dyn Input>,
    width: u32,
    rows: u32,
    colour: ColorType,
    /// No others follow.
    last: bool,
}

impl ImageDecoder for Band<'_, '_> {
    fn dimensions(&self) -> (u32, u32) {
        (self.width, self.rows)
    }

    fn color_type(&self) -> ColorType {
        self.colour
    }

    fn read_image(self, bytes: &mut [u8]) -> ImageResult<()> {
        for row in bytes.chunks_exact_mut(self.width as usize * usize::from(self.colour.bytes_per_pixel())) {
            self.reader.read_row(row).map_err(of_png)?;
        }
        if self.last {
            // To the end of the pixels' data, whose checksum comes last.
            self.reader.read_row(&mut []).map_err(of_png)?;
        }
        if self.colour.bytes_per_pixel() > self.colour.channel_count() {
            bytes.as_chunks_mut::<2>().0.iter_mut().for_each(|level| *level = u16::from_be_bytes(*level).to_ne_bytes());
        }
        Ok(())
    }

    fn read_image_boxed(self: Box<Self>, bytes: &mut [u8]) -> ImageResult<()> {
        (*self).read_image(bytes)
    }
}

/// The decoder's errors as those of image's own.
pub(crate) fn of_png(error: png::DecodingError) -> ImageError {
    match error {
        png::DecodingError::IoError(source) => ImageError::IoError(source),
        png::DecodingError::LimitsExceeded => ImageError::Limits(LimitError::from_kind(LimitErrorKind::InsufficientMemory)),
        other => ImageError::Decoding(DecodingError::new(ImageFormatHint::Exact(ImageFormat::Png), other)),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use image::DynamicImage;
    use png::{BitDepth, ColorType as Colour};

    use super::super::{grey, parse_photo};
    use super::*;

    /// A PNG of any levels.
    fn written((width, height): (u32, u32), (colour, depth): (Colour, BitDepth), transparent: Option<&[u8]>) -> Vec<u8> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, width, height);
        encoder.set_color(colour);
        encoder.set_depth(depth);
        if colour == Colour::Indexed {
            encoder.set_palette((0..768_u32).map(|k| (k * k / 5) as u8).take(3 << depth as u8).collect::<Vec<u8>>());
        }
        if let Some(transparent) = transparent {
            encoder.set_trns(transparent.to_vec());
        }
        let row = (width as usize * colour.samples() * depth as usize).div_ceil(8);
        let bytes: Vec<u8> = (0..row * height as usize).map(|k| ((k * k / 7) ^ (k * 5)) as u8).collect();
        encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
        file
    }

    /// What the `image` crate makes of all of it.
    fn whole(file: &[u8]) -> Option<Image<'static>> {
        let decoded: DynamicImage = image::load_from_memory(file).ok()?;
        Some(grey::of_rows(&decoded, 0..decoded.height() as usize))
    }

    fn in_bands(file: &[u8]) -> Option<Image<'static>> {
        assert!(is_in_rows(&mut io::Cursor::new(file)).unwrap());
        parse_photo(Path::new("photo"), file).ok().map(|photo| photo.image)
    }

    #[test]
    fn every_kind_of_png_is_in_bands_what_it_is_as_a_whole() {
        use BitDepth::{Eight, Four, One, Sixteen, Two};
        let kinds = [
            (Colour::Grayscale, &[One, Two, Four, Eight, Sixteen][..], Some(&[0, 1][..])),
            (Colour::GrayscaleAlpha, &[Eight, Sixteen], None),
            (Colour::Rgb, &[Eight, Sixteen], Some(&[0, 1, 0, 2, 0, 3])),
            (Colour::Rgba, &[Eight, Sixteen], None),
            (Colour::Indexed, &[One, Two, Four, Eight], Some(&[7, 200])),
        ];
        // The last has more rows than one band.
        for size in [(1, 1), (13, 5), (701, 409)] {
            for (colour, depths, transparent) in kinds {
                for &depth in depths {
                    for transparent in [None, transparent] {
                        let file = written(size, (colour, depth), transparent);
                        let expected = whole(&file).unwrap();
                        assert!(in_bands(&file).unwrap() == expected, "{size:?} {colour:?} {depth:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn damage_is_told_as_of_the_whole() {
        let file = written((40, 30), (Colour::Grayscale, BitDepth::Eight), None);
        // From the pixels' data on.
        let begin = file.windows(4).position(|bytes| bytes == b"IDAT").unwrap() - 4;
        let mut told = 0;
        for place in begin..file.len() {
            let mut damaged = file.clone();
            damaged[place] ^= 0x10;
            let expected = whole(&damaged);
            told += usize::from(expected.is_none());
            assert!(in_bands(&damaged) == expected, "byte {place}");
        }
        assert!(told > (file.len() - begin) / 2);
    }

    /// The checksum of a part of a PNG.
    fn checksum(bytes: &[u8]) -> u32 {
        let of_bit = |sum: u32, _| sum >> 1 ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 };
        !bytes.iter().fold(!0, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), of_bit))
    }

    /// Rows 0 and 1 of a 3 x 2 image in the passes of Adam7 that have any: 1 (column 0), 4 (column 2), 6 (column 1), 7 (row 1).
    #[test]
    fn rows_that_come_in_passes_are_read_as_a_whole() {
        let mut file = Vec::new();
        let passes = [[0, 10].as_slice(), &[0, 30], &[0, 20], &[0, 40, 50, 60]].concat();
        let mut writer = png::Encoder::new(&mut file, 3, 2).write_header().unwrap();
        writer.write_chunk(png::chunk::IDAT, &fdeflate::compress_to_vec(&passes)).unwrap();
        writer.finish().unwrap();
        file[28] = 1;
        let sum = checksum(&file[12..29]);
        file[29..33].copy_from_slice(&sum.to_be_bytes());
        assert!(!is_in_rows(&mut io::Cursor::new(&file)).unwrap());
        let image = parse_photo(Path::new("photo"), &file).unwrap().image;
        assert_eq!(image.to_u8(), [10, 20, 30, 40, 50, 60]);
    }
}
