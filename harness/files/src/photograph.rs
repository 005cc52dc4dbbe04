//! Files that are photographs, by how they begin.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// So many bytes decide.
const HEAD: u64 = 2048;
/// What files that are marked name as their software.
pub const WRITER: &str = "calibench";
/// Its place in the head of an EXR: name, type and length of the attribute come before.
const IN_EXR: &[u8] = b"software\0string\0\x09\0\0\0calibench";
/// Bytes of a TIFF's head in which the software's name stands where it is the first of the texts.
const TIFF_HEAD: usize = 128;
/// A PNG text chunk, behind the header of every picture that is written as a file of its own: length, type, `Software\0calibench`, CRC.
const MARK: &[u8; 30] = b"\x00\x00\x00\x12tEXtSoftware\0calibench\x9d\x9d\xe2\x79";
/// Where the first chunk behind a PNG's header begins.
const BEHIND_HEADER: usize = 33;
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// How images begin: place and bytes.
const BEGINNINGS: [(usize, &[u8]); 26] = [
    (0, PNG),
    (0, b"\xff\xd8\xff"),
    // TIFF and BigTIFF, and with them most raw formats.
    (0, b"II*\0"),
    (0, b"MM\0*"),
    (0, b"II+\0"),
    (0, b"MM\0+"),
    (0, b"IIRO"),
    (0, b"IIRS"),
    (0, b"MMOR"),
    (0, b"IIU\0"),
    (0, b"FUJIFILM"),
    (0, b"FOVb"),
    (0, b"\0MRM"),
    (0, b"GIF8"),
    (0, b"8BPS"),
    (0, b"\x76\x2f\x31\x01"),
    (0, b"#?RADIANCE"),
    (0, b"SIMPLE  ="),
    (0, b"\xff\x0a"),
    (0, b"\xff\x4f\xff\x51"),
    (4, b"JXL \r\n"),
    (4, b"jP  \r\n"),
    // HEIF, AVIF, CR3.
    (4, b"ftyp"),
    (8, b"WEBP"),
    // BMP: what it reserves, before the place of the pixels.
    (6, b"\0\0\0\0\x36\0\0\0"),
    (6, b"\0\0\0\0\x8a\0\0\0"),
];

/// The first bytes of a file.
fn head(path: &Path) -> io::Result<Vec<u8>> {
    let mut head = Vec::new();
    File::open(path)?.take(HEAD).read_to_end(&mut head)?;
    Ok(head)
}

/// Whether a file is an image that this program did not draw, by its content: any camera's format counts, whether it can be read or not.
///
/// # Errors
/// A file that cannot be opened.
pub fn is_photograph(path: &Path) -> io::Result<bool> {
    let head = head(path)?;
    let has = |(place, bytes): &(usize, &[u8])| head.get(*place..*place + bytes.len()) == Some(*bytes);
    Ok(!is_ours(&head) && (BEGINNINGS.iter().any(has) || is_pnm(&head)))
}

/// P1 to P7, white space, then a number, a comment, or the header of P7.
fn is_pnm(head: &[u8]) -> bool {
    match head {
        [b'P', b'7', b'\n', ..] => true,
        [b'P', b'1'..=b'6', space, next, ..] => space.is_ascii_whitespace() && (next.is_ascii_digit() || *next == b'#'),
        [b'P', b'F' | b'f', b'\n', next, ..] => next.is_ascii_digit(),
        _ => false,
    }
}

fn is_ours(head: &[u8]) -> bool {
    let holds = |part: &[u8], text: &[u8]| part.windows(text.len()).any(|window| window == text);
    let is_tiff = [&b"II*\0"[..], b"MM\0*"].iter().any(|magic| head.starts_with(magic));
    head.starts_with(PNG) && head.get(BEHIND_HEADER..BEHIND_HEADER + MARK.len()) == Some(MARK)
        || head.starts_with(b"\x76\x2f\x31\x01") && holds(head, IN_EXR)
        || is_tiff && holds(&head[..head.len().min(TIFF_HEAD)], b"calibench\0")
}

/// The same PNG, marked as drawn by this program: what is drawn again replaces it.
#[must_use]
pub fn marked(mut png: Vec<u8>) -> Vec<u8> {
    if png.starts_with(PNG) && png.len() > BEHIND_HEADER {
        png.splice(BEHIND_HEADER..BEHIND_HEADER, *MARK);
    }
    png
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::{DynamicImage, ImageFormat};

    fn encoded(format: ImageFormat) -> Vec<u8> {
        let mut bytes = io::Cursor::new(Vec::new());
        DynamicImage::new_rgb8(3, 2).write_to(&mut bytes, format).unwrap();
        bytes.into_inner()
    }

    fn is_one(bytes: &[u8]) -> bool {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        is_photograph(file.path()).unwrap()
    }

    #[test]
    fn images_are_known_by_their_content() {
        for format in [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Tiff, ImageFormat::Pnm] {
            assert!(is_one(&encoded(format)), "{format:?}");
        }
        for head in
            [&b"RIFF\x10\0\0\0WEBPVP8 "[..], b"\0\0\0\x18ftypheic", b"BM\x46\0\0\0\0\0\0\0\x36\0\0\0", b"P5 # comment", b"FUJIFILMCCD-RAW"]
        {
            assert!(is_one(head), "{head:?}");
        }
        for text in [&b""[..], b"image,target,x,y\n", b"P1,0,0\n", b"P5 north\n", b"%YAML:1.0\n", b"{\"a\": 1}", b"<?xml", b"II,1,2"] {
            assert!(!is_one(text), "{text:?}");
        }
    }

    #[test]
    fn a_marked_picture_is_ours_and_still_a_picture() {
        let (plain, ours) = (encoded(ImageFormat::Png), marked(encoded(ImageFormat::Png)));
        assert!(is_one(&plain) && !is_one(&ours));
        // The decoder checks the chunk's CRC.
        assert_eq!(image::load_from_memory(&ours).unwrap(), image::load_from_memory(&plain).unwrap());
        assert_eq!(ours.len(), plain.len() + MARK.len());
    }
}
