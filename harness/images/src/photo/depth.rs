//! Files of 16 bits a level whose levels come from fewer: the largest of them is far from white.

use std::io::{BufReader, SeekFrom};
use std::path::Path;

use image::{DynamicImage, ImageFormat};
use tiff::tags::Tag;

use super::{Input, Photo, PhotoError, Reading, decoded, finished, helped, open, reader};

/// Bits that levels of cameras have, but for 8 and 16.
const OF_CAMERAS: [u8; 3] = [10, 12, 14];
/// Up to so many bits levels that do not reach further are no dark image's: whoever photographs a board uses more than a sixteenth of the scale.
const NEVER_DARK: u8 = 12;
/// What the levels of 16-bit files are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DeepLevels {
    /// The largest.
    pub largest: u16,
    /// The bits that are set in any of them.
    pub any: u16,
    /// Significant bits, where the file states them (`sBIT` of PNG, `MaxSampleValue` of TIFF).
    pub stated: Option<u8>,
}

/// How many bits the levels of 16-bit files have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// All, or those that there are stand at the upper end.
    Whole,
    /// So many, at the lower end.
    Bits(u8),
    /// So many, or the images are dark: levels do not tell.
    Unsure(u8),
}

impl DeepLevels {
    /// Those of both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        let stated = if self.stated == other.stated { self.stated } else { None };
        Self { largest: self.largest.max(other.largest), any: self.any | other.any, stated }
    }

    /// Whether no other photograph can change [`Self::depth`].
    pub fn is_whole(self) -> bool {
        self.largest > most(OF_CAMERAS[2])
    }

    /// How many bits these levels have: as many as the file states, if no level is beyond; those of a camera of 10, 12 or 14 bits whose largest level is there;
    /// of levels below 4096 the fewest of 10 and 12 that hold them. Levels whose lower bits are never set were shifted to the upper end: a dark image.
    pub fn depth(self) -> Depth {
        let Some(least) = OF_CAMERAS.into_iter().find(|bits| self.largest <= most(*bits)) else { return Depth::Whole };
        if self.any & 1 == 0 {
            return Depth::Whole;
        }
        let stated = self.stated.filter(|bits| *bits < 16 && self.largest <= most(*bits));
        match stated {
            Some(bits) => Depth::Bits(bits),
            None if least <= NEVER_DARK || self.largest == most(least) => Depth::Bits(least),
            None => Depth::Unsure(least),
        }
    }
}

/// The largest level of so many bits.
pub(super) const fn most(bits: u8) -> u16 {
    ((1_u32 << bits) - 1) as u16
}

/// A photograph, and what its levels are if they have 16 bits. Those of PNM come with their white at the upper end.
///
/// # Errors
/// As [`super::read_photo`].
pub fn read_with_levels(path: &Path, reading: Reading) -> Result<(Photo, Option<DeepLevels>), PhotoError> {
    let mut input = BufReader::new(open(path)?);
    let stated = stated(&mut input);
    let (image, turn, share) = decoded(path, &mut input)?;
    let levels = match &image {
        DynamicImage::ImageLuma16(i) => Some(of::<1>(i.as_raw(), 1)),
        DynamicImage::ImageLumaA16(i) => Some(of::<2>(i.as_raw(), 1)),
        DynamicImage::ImageRgb16(i) => Some(of::<3>(i.as_raw(), 3)),
        DynamicImage::ImageRgba16(i) => Some(of::<4>(i.as_raw(), 3)),
        _ => None,
    };
    let white = reading.white(image.color());
    let photo = finished(helped::grey_of(image, share), white, turn, reading);
    Ok((photo, levels.map(|levels| DeepLevels { stated, ..levels })))
}

/// The levels of the first `counted` of `CHANNELS` channels: transparency is none.
fn of<const CHANNELS: usize>(values: &[u16], counted: usize) -> DeepLevels {
    let pixels = values.as_chunks::<CHANNELS>().0.iter();
    let (largest, any) =
        pixels.flat_map(|pixel| &pixel[..counted]).fold((0, 0), |(largest, any), level| (largest.max(*level), any | *level));
    DeepLevels { largest, any, stated: None }
}

/// Bits that a file says to be significant.
fn stated(input: &mut dyn Input) -> Option<u8> {
    let start = input.stream_position().ok()?;
    let bits = match reader(input).ok()?.format()? {
        ImageFormat::Png => {
            let head = png::Decoder::new(&mut *input).read_info().ok();
            head.and_then(|reader| reader.info().sbit.as_ref()?.first().copied())
        }
        ImageFormat::Tiff => {
            let most = tiff::decoder::Decoder::new(&mut *input)
                .ok()
                .and_then(|mut file| file.find_tag_unsigned_vec::<u32>(Tag::MaxSampleValue).ok()?);
            most.and_then(|most| most.first()?.checked_add(1))
                .filter(|levels| levels.is_power_of_two())
                .map(|levels| levels.trailing_zeros() as u8)
        }
        _ => None,
    };
    input.seek(SeekFrom::Start(start)).ok()?;
    bits
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(all: &[u16]) -> DeepLevels {
        of::<1>(all, 1)
    }

    #[test]
    fn bits_are_told_from_levels() {
        for (what, all, expected) in [
            ("all bits", &[3, 40_000][..], Depth::Whole),
            ("12 bits", &[3, 3665], Depth::Bits(12)),
            ("10 bits", &[3, 915], Depth::Bits(10)),
            ("12 bits, their largest level", &[3, 4095], Depth::Bits(12)),
            ("14 bits, their largest level", &[3, 16_383], Depth::Bits(14)),
            ("14 bits or dark", &[3, 14_661], Depth::Unsure(14)),
            ("dark", &[3, 20_000], Depth::Whole),
            ("12 bits at the upper end, dark", &[16, 3200], Depth::Whole),
        ] {
            assert_eq!(levels(all).depth(), expected, "{what}");
        }
        assert_eq!(levels(&[3, 900]).with(levels(&[2000, 3])).depth(), Depth::Bits(12));
        assert!(levels(&[3, 16_384]).is_whole() && !levels(&[3, 16_383]).is_whole());
    }

    #[test]
    fn what_a_file_states_is_believed_where_its_levels_allow_it() {
        let stated = |bits, largest| DeepLevels { stated: Some(bits), ..levels(&[3, largest]) };
        assert_eq!(stated(14, 9001).depth(), Depth::Bits(14));
        assert_eq!(stated(12, 901).depth(), Depth::Bits(12));
        // Spread over all bits, as PNG has it.
        assert_eq!(stated(12, 9001).depth(), Depth::Unsure(14));
        assert_eq!(stated(12, 60_001).depth(), Depth::Whole);
    }

    /// A PNG of two levels with an `sBIT` chunk, or a PNM with a white.
    #[test]
    fn one_white_is_read_from_every_format() {
        let read = |bytes: &[u8], bits: u8| {
            let file = tempfile::NamedTempFile::new().unwrap();
            std::fs::write(file.path(), bytes).unwrap();
            let reading = Reading { bits, ..Reading::default() };
            let (photo, levels) = read_with_levels(file.path(), reading).unwrap();
            assert_eq!(super::super::read_photo_as(file.path(), reading).unwrap(), photo);
            (photo.image.into_grey(), levels)
        };
        let mut png = Vec::new();
        let mut encoder = png::Encoder::new(&mut png, 2, 1);
        encoder.set_color(png::ColorType::Grayscale);
        encoder.set_depth(png::BitDepth::Sixteen);
        let mut writer = encoder.write_header().unwrap();
        writer.write_chunk(png::chunk::sBIT, &[12]).unwrap();
        writer.write_image_data(&[0x0f, 0xff, 0, 1]).unwrap();
        writer.finish().unwrap();
        let (grey, levels) = read(&png, 16);
        assert_eq!((grey[0], levels), (4095.0 / 65535.0, Some(DeepLevels { largest: 4095, any: 4095, stated: Some(12) })));
        let (grey, _) = read(&png, 12);
        assert!((grey[0] - 1.0).abs() < 1e-6 && (grey[1] * 4095.0 - 1.0).abs() < 1e-5, "{grey:?}");
        // The decoder takes the white of PNM's head.
        for (head, white) in [(&b"P5\n# of a camera\n2 1\n4095\n"[..], 1.0), (b"P5 2 1 65535 ", 4095.0 / 65535.0)] {
            let (grey, _) = read(&[head, &[0x0f, 0xff, 0, 1]].concat(), 16);
            assert!((grey[0] - white).abs() < 1e-6, "{grey:?}");
        }
        let (grey, _) = read(b"P5 2 1 100 \x64\x32", 16);
        assert!(grey[0] == 1.0 && (grey[1] - 0.5).abs() < 1.0 / 255.0, "{grey:?}");
    }
}
