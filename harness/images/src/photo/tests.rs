//! Photographs that are turned, cut short, deep or large.

use image::codecs::jpeg::JpegEncoder;
use image::codecs::png::PngEncoder;
use image::codecs::pnm::PnmEncoder;
use image::{ExtendedColorType, ImageEncoder};

use super::grey::grey_of;
use super::*;

/// EXIF data that holds an orientation alone.
fn exif(orientation: u8) -> Vec<u8> {
    let mut bytes = b"II*\0\x08\0\0\0\x01\0\x12\x01\x03\0\x01\0\0\0".to_vec();
    bytes.extend([orientation, 0, 0, 0, 0, 0, 0, 0]);
    bytes
}

fn png(values: &[u8], (width, height): (u32, u32), colour: ExtendedColorType, orientation: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = PngEncoder::new(&mut bytes);
    encoder.set_exif_metadata(exif(orientation)).unwrap();
    encoder.write_image(values, width, height, colour).unwrap();
    bytes
}

fn jpeg(values: &[u8], (width, height): (u32, u32), orientation: u8) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(&mut bytes, 100);
    encoder.set_exif_metadata(exif(orientation)).unwrap();
    encoder.write_image(values, width, height, ExtendedColorType::L8).unwrap();
    bytes
}

/// An uncompressed TIFF of grey values or RGB in 8 or 16 bits, in one strip.
fn tiff(values: &[u8], (width, height): (u32, u32), bits: u16, channels: u16, orientation: u16) -> Vec<u8> {
    let entry = |tag: u16, kind: u16, value: u32| {
        [&tag.to_le_bytes()[..], &kind.to_le_bytes(), &1_u32.to_le_bytes(), &value.to_le_bytes()].concat()
    };
    // The bits of three channels take more than the four bytes of an entry: they stand behind the directory.
    let bits_entry = [&258_u16.to_le_bytes()[..], &3_u16.to_le_bytes(), &u32::from(channels).to_le_bytes()].concat();
    let behind = 8 + 2 + 10 * 12 + 4;
    let bits_place = if channels == 1 { u32::from(bits) } else { behind };
    let entries = [
        entry(256, 4, width),
        entry(257, 4, height),
        [bits_entry, bits_place.to_le_bytes().to_vec()].concat(),
        entry(259, 3, 1),
        entry(262, 3, if channels == 1 { 1 } else { 2 }),
        entry(273, 4, behind + 6),
        entry(274, 3, u32::from(orientation)),
        entry(277, 3, u32::from(channels)),
        entry(278, 4, height),
        entry(279, 4, values.len() as u32),
    ];
    [&b"II*\0\x08\0\0\0\x0a\0"[..], &entries.concat(), &[0; 4], &[bits.to_le_bytes(); 3].concat(), values].concat()
}

fn parse(bytes: &[u8]) -> Result<Photo, PhotoError> {
    parse_photo(Path::new("photo"), bytes)
}

/// Levels of 0 to 255, row by row.
fn levels(photo: &Photo) -> Vec<Vec<u8>> {
    photo.image.to_u8().chunks(photo.image.width()).map(<[u8]>::to_vec).collect()
}

/// What `cv2.imread` gives for the rows 1 2 3, 4 5 6 of the file.
const UPRIGHT: [&[&[u8]]; 8] = [
    &[&[1, 2, 3], &[4, 5, 6]],
    &[&[3, 2, 1], &[6, 5, 4]],
    &[&[6, 5, 4], &[3, 2, 1]],
    &[&[4, 5, 6], &[1, 2, 3]],
    &[&[1, 4], &[2, 5], &[3, 6]],
    &[&[4, 1], &[5, 2], &[6, 3]],
    &[&[6, 3], &[5, 2], &[4, 1]],
    &[&[3, 6], &[2, 5], &[1, 4]],
];

#[test]
fn the_orientation_is_applied_and_said() {
    let values = [1, 2, 3, 4, 5, 6];
    for (orientation, expected) in (1..).zip(UPRIGHT) {
        let files = [png(&values, (3, 2), ExtendedColorType::L8, orientation), tiff(&values, (3, 2), 8, 1, orientation.into())];
        for file in files {
            let photo = parse(&file).unwrap();
            assert_eq!(levels(&photo), expected, "{orientation}");
            assert_eq!(photo.turn.map(Turn::exif), (orientation > 1).then_some(orientation));
        }
    }
    // Blocks of 8 x 8 pixels of one level each outlive the compression.
    let blocks: Vec<u8> = (0..24 * 16).map(|i| 20 * values[i / 24 / 8 * 3 + i % 24 / 8]).collect();
    for (orientation, expected) in (1..).zip(UPRIGHT) {
        let photo = parse(&jpeg(&blocks, (24, 16), orientation)).unwrap();
        let found = levels(&photo);
        let middles: Vec<Vec<u8>> = found.chunks(8).map(|rows| rows[4].chunks(8).map(|block| (block[4] + 5) / 20).collect()).collect();
        assert_eq!(middles, expected, "{orientation}");
    }
    assert_eq!(parse(&png(&values, (3, 2), ExtendedColorType::L8, 0)).unwrap().turn, None, "0 and 9 mean nothing");
    assert_eq!(parse(&jpeg(&blocks, (24, 16), 9)).unwrap().turn, None);
    let said = parse(&png(&values, (3, 2), ExtendedColorType::L8, 6)).unwrap().turn.unwrap().to_string();
    assert_eq!(said, "EXIF orientation 6, turned by 90 degrees clockwise");
}

#[test]
fn the_head_tells_the_size_as_it_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("photo");
    for orientation in 1..=8 {
        let values = [1, 2, 3, 4, 5, 6];
        for file in [png(&values, (3, 2), ExtendedColorType::L8, orientation), jpeg(&values, (3, 2), orientation)] {
            std::fs::write(&path, file).unwrap();
            let (size, image) = (size_of(&path).unwrap(), read_photo(&path).unwrap().image);
            assert_eq!((size.width as usize, size.height as usize), (image.width(), image.height()), "{orientation}");
        }
    }
    std::fs::write(&path, "no image").unwrap();
    assert!(matches!(size_of(&path), Err(PhotoError::Content { .. })));
}

#[test]
fn what_is_cut_short_is_an_error() {
    let values: Vec<u8> = (0..40 * 30).map(|i| (i * 7 % 256) as u8).collect();
    let mut pnm = Vec::new();
    PnmEncoder::new(&mut pnm).write_image(&values, 40, 30, ExtendedColorType::L8).unwrap();
    let files = [jpeg(&values, (40, 30), 6), png(&values, (40, 30), ExtendedColorType::L8, 1), tiff(&values, (40, 30), 8, 1, 1), pnm];
    for (format, file) in files.iter().enumerate() {
        let whole = parse(file).unwrap();
        for end in 0..file.len() {
            // What follows the pixels may be missing.
            if let Ok(cut) = parse(&file[..end]) {
                assert!(cut == whole && format == 1 && end + 17 > file.len(), "format {format}, {end} of {} bytes", file.len());
            }
        }
    }
    let error = parse(&files[0][..files[0].len() - 1]).unwrap_err();
    assert!(matches!(error, PhotoError::Truncated { .. }) && error.to_string().starts_with("photo: is cut short"), "{error}");
    // What a camera adds behind the end is no part of the image.
    assert!(parse(&[&files[0][..], b"\xff\xd8 a preview"].concat()).is_ok());
}

#[test]
fn sixteen_bits_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("deep.png");
    let image = Image::from_fn(256, 256, |x, y| (256 * y + x) as f32 / 65535.0);
    write_png(&path, &image, true).unwrap();
    assert_eq!(read_photo(&path).unwrap(), Photo { image: image.clone(), turn: None });
    // An image that it did not draw is not replaced.
    let path = folder.path().join("shallow.png");
    write_png(&path, &image, false).unwrap();
    assert!(read_photo(&path).unwrap().image != image);
}

/// Of more rows than are compressed at once.
#[test]
fn levels_are_the_nearest_all_over_the_image() {
    let image = Image::from_fn(701, 409, |x, y| ((x * 7919 + y * 104_729) % 65_521) as f32 / 64_000.0 - 0.01);
    for (top, sixteen_bits) in [(255.0, false), (65_535.0, true)] {
        let nearest: Vec<f32> = image.grey().iter().map(|grey| (top * grey.clamp(0.0, 1.0)).round() / top).collect();
        for encode in [encode_png as fn(&mut dyn Write, &Image, bool) -> io::Result<()>, encode_png_densely] {
            let mut file = Vec::new();
            encode(&mut file, &image, sixteen_bits).unwrap();
            assert_eq!(parse(&file).unwrap().image.grey(), nearest, "{sixteen_bits}");
        }
    }
}

#[test]
fn colour_is_not_rounded_to_levels() {
    let mut grey = [0.0; 2];
    grey_of::<u8, 3>(&[10, 20, 30, 255, 255, 255], 255.0, &mut grey);
    assert!((f64::from(grey[0]) - (2.99 + 11.74 + 3.42) / 255.0).abs() < 1e-8 && (grey[1] - 1.0).abs() < 1e-7);
    let deep: Vec<u8> = [1000_u16, 2000, 65535].iter().flat_map(|level| level.to_le_bytes()).collect();
    let expected = ((0.299 * 1000.0 + 0.587 * 2000.0 + 0.114 * 65535.0) / 65535.0) as f32;
    assert_eq!(parse(&tiff(&deep, (1, 1), 16, 3, 1)).unwrap().image.at(0, 0), expected);
}

/// RGB with 16 bits takes 6 bytes a pixel: 100 megapixels are beyond the decoders' own limit of 512 MB.
#[test]
fn large_photographs_are_read_or_refused_by_their_size() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("aerial.tif");
    let (width, height) = (11_000_u32, 9_100_u32);
    let length = u64::from(width) * u64::from(height) * 6;
    // Black, and a hole in the file but for its head and its last pixel.
    let mut head = tiff(&[], (width, height), 16, 3, 1);
    let count = head.windows(4).position(|bytes| bytes == [23, 1, 4, 0]).unwrap() + 8;
    head[count..count + 4].copy_from_slice(&(length as u32).to_le_bytes());
    std::fs::write(&path, &head).unwrap();
    let file = std::fs::OpenOptions::new().write(true).open(&path).unwrap();
    std::os::unix::fs::FileExt::write_all_at(&file, &[255; 6], head.len() as u64 + length - 6).unwrap();
    let image = read_photo(&path).unwrap().image;
    assert_eq!((image.width(), image.height()), (11_000, 9_100));
    assert_eq!((image.at(0, 0), image.at(10_998, 9_099), image.at(10_999, 9_099)), (0.0, 0.0, 1.0));
    let hostile = tiff(&[0; 6], (60_000, 60_000), 16, 3, 1);
    let error = parse(&hostile).unwrap_err().to_string();
    assert!(error.starts_with("photo: 60000 x 60000 px take 54931 MB while they are read, more than 4096 MB"), "{error}");
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

#[test]
fn bmp_and_webp_are_read_as_png_is() {
    let levels: Vec<u8> = (0..12 * 7 * 3).map(|i| (i * 37 % 251) as u8).collect();
    let (size, colour) = ((12, 7), ExtendedColorType::Rgb8);
    let plain = parse(&png(&levels, size, colour, 1)).unwrap().image;
    let mut bmp = Vec::new();
    image::codecs::bmp::BmpEncoder::new(&mut bmp).encode(&levels, size.0, size.1, colour).unwrap();
    assert_eq!(parse(&bmp).unwrap().image, plain);
    let mut webp = Vec::new();
    image::codecs::webp::WebPEncoder::new_lossless(&mut webp).encode(&levels, size.0, size.1, colour).unwrap();
    assert_eq!(parse(&webp).unwrap().image, plain);
    // Cut short, they are no images.
    for file in [&bmp, &webp] {
        assert!(parse(&file[..file.len() / 2]).is_err());
    }
}

#[test]
fn a_picture_that_is_not_read_says_what_converts_it() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("IMG_1.png");
    std::fs::write(&path, b"\0\0\0\x18ftypheic\0\0\0\0mif1heic").unwrap();
    for error in [head_of(&path).unwrap_err(), read_photo(&path).unwrap_err()] {
        let said = error.to_string();
        assert!(
            said.contains("IMG_1.png: is a HEIC picture, which is not read; `heif-convert ") && said.contains("libheif-examples"),
            "{said}"
        );
    }
}
