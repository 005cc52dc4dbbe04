//! TIFF files whose first image is a thumbnail: raw files of cameras (DNG, NEF, ARW) are TIFFs, too.

use std::collections::BTreeSet;
use std::io::SeekFrom;

use image::ImageFormat;
use tiff::decoder::{Decoder, Limits};
use tiff::tags::{IfdPointer, Tag};

use super::{Input, reader};

/// So many images of a file are looked at.
const MOST: usize = 64;

/// The first image of a TIFF, which is the one that is read, and the largest, columns and rows, where that is another. What cannot be understood is left to the
/// decoder to refuse. Leaves the input where it was.
pub(super) fn thumbnail(mut input: &mut dyn Input) -> Option<[(u32, u32); 2]> {
    let start = input.stream_position().ok()?;
    let found = reader(input).is_ok_and(|reader| reader.format() == Some(ImageFormat::Tiff)).then(|| sizes(&mut input)).flatten();
    input.seek(SeekFrom::Start(start)).ok()?;
    let sizes = found?;
    let pixels = |(width, height): &(u32, u32)| u64::from(*width) * u64::from(*height);
    let (first, largest) = (*sizes.first()?, *sizes.iter().max_by_key(|size| pixels(size))?);
    (pixels(&largest) > pixels(&first)).then_some([first, largest])
}

/// The sizes of all images, those within others behind them; the first is that of the file's first directory.
fn sizes(input: &mut dyn Input) -> Option<Vec<(u32, u32)>> {
    let mut decoder = Decoder::new(input).ok()?.with_limits(Limits::default());
    let mut waiting: Vec<IfdPointer> = decoder.ifd_pointer().into_iter().collect();
    let (mut seen, mut sizes) = (BTreeSet::new(), Vec::new());
    while let Some(pointer) = waiting.pop().filter(|_| seen.len() < MOST) {
        if !seen.insert(pointer.0) {
            continue;
        }
        let Ok(directory) = decoder.read_directory(pointer) else { continue };
        waiting.extend(directory.next());
        let mut tags = decoder.read_directory_tags(&directory);
        let mut side = |tag| tags.find_tag_unsigned::<u32>(tag).ok().flatten();
        sizes.extend(side(Tag::ImageWidth).zip(side(Tag::ImageLength)));
        let within = tags.find_tag(Tag::SubIfd).ok().flatten().and_then(|value| value.into_ifd_vec().ok());
        waiting.extend(within.into_iter().flatten());
    }
    Some(sizes)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;
    use std::path::Path;

    use tiff::encoder::{TiffEncoder, colortype::Gray8};

    use super::super::{PhotoError, parse_photo};

    /// A TIFF of images of these widths, one behind the other.
    fn several(widths: &[u32]) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut file).unwrap();
        for width in widths {
            encoder.write_image::<Gray8>(*width, 3, &vec![7; *width as usize * 3]).unwrap();
        }
        file.into_inner()
    }

    /// The same with the second image within the first, as raw files have it: the link to the next directory becomes an entry of the first.
    fn nested() -> Vec<u8> {
        let entry = |tag: u16, kind: u16, value: u32| {
            let mut bytes = [tag.to_le_bytes(), kind.to_le_bytes()].concat();
            bytes.extend(1_u32.to_le_bytes());
            bytes.extend(value.to_le_bytes());
            bytes
        };
        let directory = |width: u32, pixels: u32, within: Option<u32>| {
            let mut entries = vec![
                entry(254, 4, u32::from(within.is_some())),
                entry(256, 4, width),
                entry(257, 4, 3),
                entry(258, 3, 8),
                entry(259, 3, 1),
                entry(262, 3, 1),
                entry(273, 4, pixels),
                entry(277, 3, 1),
                entry(278, 4, 3),
                entry(279, 4, width * 3),
            ];
            entries.extend(within.map(|place| entry(330, 13, place)));
            let count = (entries.len() as u16).to_le_bytes().to_vec();
            [count, entries.concat(), vec![0; 4]].concat()
        };
        let (first, pixels) = (2 + 11 * 12 + 4, 8 + 2 + 11 * 12 + 4 + 2 + 10 * 12 + 4);
        let head = b"II*\0\x08\0\0\0".to_vec();
        [head, directory(2, pixels, Some(8 + first)), directory(5, pixels + 6, None), vec![9; 21]].concat()
    }

    #[test]
    fn a_thumbnail_is_not_read_in_place_of_the_image() {
        for (file, refused) in [
            (several(&[4]), None),
            (several(&[9, 4, 2]), None),
            (several(&[4, 4]), None),
            (several(&[4, 9]), Some([4, 9])),
            (several(&[4, 2, 12, 6]), Some([4, 12])),
            (nested(), Some([2, 5])),
        ] {
            let found = match parse_photo(Path::new("a.dng"), &file) {
                Err(PhotoError::Thumbnail { size, of, .. }) => Some([size.0, of.0]),
                found => found.map(|_| None).unwrap(),
            };
            assert_eq!(found, refused);
        }
    }
}
