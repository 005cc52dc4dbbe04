//! Pictures in formats that are not read, told by their first bytes, and what converts each of them.

use std::fmt;
use std::path::Path;

/// So many bytes of a file tell what it is.
pub const TELLING: usize = 64;

/// Endings of raw files that are TIFFs inside.
const RAW_TIFFS: [&str; 8] = ["nef", "nrw", "arw", "sr2", "dng", "pef", "srw", "3fr"];

/// A picture in a format that is not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foreign {
    /// High efficiency, as telephones write it.
    Heic,
    /// AV1.
    Avif,
    /// JPEG XL.
    JpegXl,
    /// JPEG 2000.
    Jpeg2000,
    /// GIF.
    Gif,
    /// What the sensor saw, in the format of a camera's maker.
    Raw,
    /// Moving pictures.
    Video,
    /// A page.
    Pdf,
}

impl Foreign {
    /// What a file is, by its first bytes; `None` where they are of no such format.
    pub fn of(head: &[u8]) -> Option<Self> {
        let at = |place: usize, bytes: &[u8]| head.get(place..).is_some_and(|rest| rest.starts_with(bytes));
        if at(4, b"ftyp") {
            let brands = &head[8..];
            let has = |brand: &[u8]| brands.windows(brand.len()).any(|window| window == brand);
            return Some(match () {
                () if has(b"avif") || has(b"avis") => Self::Avif,
                () if has(b"heic") || has(b"heix") || has(b"hevc") || has(b"mif1") => Self::Heic,
                () if brands.starts_with(b"crx ") => Self::Raw,
                () => Self::Video,
            });
        }
        let known: [(Self, usize, &[u8]); 15] = [
            (Self::JpegXl, 4, b"JXL \r\n"),
            (Self::JpegXl, 0, b"\xff\x0a"),
            (Self::Jpeg2000, 4, b"jP  \r\n"),
            (Self::Jpeg2000, 0, b"\xff\x4f\xff\x51"),
            (Self::Gif, 0, b"GIF8"),
            (Self::Raw, 0, b"FUJIFILMCCD-RAW"),
            (Self::Raw, 0, b"IIRO"),
            (Self::Raw, 0, b"IIRS"),
            (Self::Raw, 0, b"IIU\0"),
            (Self::Raw, 6, b"HEAPCCDR"),
            (Self::Raw, 8, b"CR\x02"),
            (Self::Raw, 0, b"FOVb"),
            (Self::Video, 8, b"AVI "),
            (Self::Video, 0, b"\x1a\x45\xdf\xa3"),
            (Self::Pdf, 0, b"%PDF"),
        ];
        known.into_iter().find(|(_, place, bytes)| at(*place, bytes)).map(|(kind, ..)| kind)
    }

    /// What a file is, by its ending alone: raw files that begin as a TIFF does.
    pub fn by_ending(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_ascii_lowercase();
        RAW_TIFFS.iter().any(|raw| ending == *raw).then_some(Self::Raw)
    }

    /// The line of a shell that makes a file that is read of the file at `path`.
    pub fn conversion(self, path: &Path) -> String {
        let (from, stem) = (path.display(), path.with_extension(""));
        let to = stem.display();
        match self {
            Self::Heic => format!("heif-convert {from} {to}.png"),
            Self::Avif => format!("avifdec {from} {to}.png"),
            Self::JpegXl => format!("djxl {from} {to}.png"),
            Self::Jpeg2000 => format!("opj_decompress -i {from} -o {to}.png"),
            Self::Gif => format!("magick {from} {to}.png"),
            Self::Raw => format!("dcraw_emu -T {from}"),
            Self::Video => format!("ffmpeg -i {from} -vf fps=2 {to}-%04d.png"),
            Self::Pdf => format!("pdftoppm -r 300 -png {from} {to}"),
        }
    }

    /// The package of Debian and Ubuntu that has the program of [`Self::conversion`].
    const fn package(self) -> &'static str {
        match self {
            Self::Heic => "libheif-examples",
            Self::Avif => "libavif-bin",
            Self::JpegXl => "libjxl-tools",
            Self::Jpeg2000 => "libopenjp2-tools",
            Self::Gif => "imagemagick",
            Self::Raw => "libraw-bin",
            Self::Video => "ffmpeg",
            Self::Pdf => "poppler-utils",
        }
    }

    /// What is to be done with the file at `path`, in words.
    pub fn advice(self, path: &Path) -> String {
        format!("`{}` converts it (package {})", self.conversion(path), self.package())
    }
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Heic => "a HEIC picture",
            Self::Avif => "an AVIF picture",
            Self::JpegXl => "a JPEG XL picture",
            Self::Jpeg2000 => "a JPEG 2000 picture",
            Self::Gif => "a GIF picture",
            Self::Raw => "a camera's raw file",
            Self::Video => "a video",
            Self::Pdf => "a PDF",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_read_is_told_by_its_first_bytes() {
        for (head, expected) in [
            (&b"\0\0\0\x18ftypheic\0\0\0\0mif1heic"[..], Some(Foreign::Heic)),
            (b"\0\0\0\x18ftypmif1\0\0\0\0mif1avif", Some(Foreign::Avif)),
            (b"\0\0\0\x1cftypavif\0\0\0\0avifmif1", Some(Foreign::Avif)),
            (b"\0\0\0\x18ftypcrx \0\0\0\x01crx isom", Some(Foreign::Raw)),
            (b"\0\0\0\x20ftypisom\0\0\x02\0isomiso2", Some(Foreign::Video)),
            (b"\0\0\0\x0cJXL \r\n\x87\n", Some(Foreign::JpegXl)),
            (b"\xff\x0a\xfa\x7f", Some(Foreign::JpegXl)),
            (b"\0\0\0\x0cjP  \r\n\x87\n", Some(Foreign::Jpeg2000)),
            (b"GIF89a", Some(Foreign::Gif)),
            (b"II*\0\x10\0\0\0CR\x02\0", Some(Foreign::Raw)),
            (b"RIFF\0\0\0\0AVI LIST", Some(Foreign::Video)),
            (b"%PDF-1.7", Some(Foreign::Pdf)),
            // These are read.
            (b"RIFF\0\0\0\0WEBPVP8 ", None),
            (b"\x89PNG\r\n\x1a\n", None),
            (b"\xff\xd8\xff\xe0", None),
            (b"II*\0\x08\0\0\0", None),
            (b"BM", None),
            (b"", None),
            (b"\0\0\0\x18ftyp", Some(Foreign::Video)),
        ] {
            assert_eq!(Foreign::of(head), expected, "{}", String::from_utf8_lossy(head));
        }
        assert_eq!(Foreign::by_ending(Path::new("a/DSC.NEF")), Some(Foreign::Raw));
        assert_eq!(Foreign::by_ending(Path::new("a.tif")), None);
    }

    #[test]
    fn each_has_a_line_that_names_the_file() {
        let path = Path::new("photos/IMG_1.HEIC");
        assert_eq!(Foreign::Heic.conversion(path), "heif-convert photos/IMG_1.HEIC photos/IMG_1.png");
        assert_eq!(Foreign::Heic.advice(path), "`heif-convert photos/IMG_1.HEIC photos/IMG_1.png` converts it (package libheif-examples)");
        for kind in [Foreign::Avif, Foreign::JpegXl, Foreign::Jpeg2000, Foreign::Gif, Foreign::Raw, Foreign::Video, Foreign::Pdf] {
            assert!(kind.conversion(path).contains("photos/IMG_1.HEIC"), "{kind}");
        }
    }
}
