//! Pictures, row by row.

use std::borrow::Cow;
use std::io::{self, Cursor, Write};

use image::codecs::jpeg::JpegEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageFormat};

use super::exif::{self, Directories, Entry, PROFILE};
use super::{About, PictureForm, PictureLevels};

/// Bytes of a strip of a TIFF, about.
const STRIP: usize = 1 << 18;
/// The most that a TIFF holds, bytes.
const MOST_TIFF: u64 = u32::MAX as u64;
/// Bytes of a segment of a JPEG at most, and how that of EXIF begins.
const SEGMENT: usize = 65_533;
const EXIF_HEAD: &[u8; 6] = b"Exif\0\0";

/// A kind of file that pictures are written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureKind {
    /// PNG, compressed fast.
    Png,
    /// TIFF, not compressed.
    Tiff,
    /// JPEG.
    Jpeg,
}

impl PictureKind {
    /// The kind in which a photograph of a format is written again: PNG for those that are not written.
    pub(super) fn of(format: Option<ImageFormat>) -> Self {
        match format {
            Some(ImageFormat::Jpeg) => Self::Jpeg,
            Some(ImageFormat::Tiff) => Self::Tiff,
            _ => Self::Png,
        }
    }

    /// The ending of its files.
    pub const fn ending(self) -> &'static str {
        match self {
            Self::Png => "png",
            Self::Tiff => "tif",
            Self::Jpeg => "jpg",
        }
    }

    /// Why it cannot hold a picture, if so.
    pub fn refuses(self, form: PictureForm) -> Option<&'static str> {
        match self {
            Self::Jpeg if form.is_deep => Some("a JPEG holds 8 bits and the photograph has 16: expected png or tiff"),
            Self::Jpeg if form.channels.is_multiple_of(2) => Some("a JPEG holds no alpha, which the photograph has: expected png or tiff"),
            Self::Jpeg if form.size.width > 65_535 || form.size.height > 65_535 => {
                Some("a JPEG has at most 65535 px a side: expected png or tiff")
            }
            Self::Tiff if tiff_bytes(form) > MOST_TIFF - (1 << 24) => Some("the picture is larger than the 4 GB of a TIFF: expected png"),
            _ => None,
        }
    }
}

fn tiff_bytes(form: PictureForm) -> u64 {
    form.stride() as u64 * u64::from(form.size.height) * if form.is_deep { 2 } else { 1 }
}

/// How a picture is written.
#[derive(Clone, Copy, Debug)]
pub struct WriteOptions {
    /// The kind of file.
    pub kind: PictureKind,
    /// Quality of a JPEG, 1 to 100.
    pub quality: u8,
}

/// Writes a picture, upright, that says of itself what `about` does, but for its size. `fill` is handed what takes its rows, one part after the other.
///
/// # Errors
/// A picture that the kind of file refuses, rows that are missing, what the output refuses and what `fill` returns.
pub fn write_picture<E: From<io::Error>>(
    output: &mut dyn Write,
    form: PictureForm,
    about: &About,
    options: WriteOptions,
    fill: impl FnOnce(&mut dyn FnMut(&PictureLevels) -> io::Result<()>) -> Result<(), E>,
) -> Result<(), E> {
    if let Some(why) = options.kind.refuses(form) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, why).into());
    }
    let size = [form.size.width, form.size.height];
    let about = About {
        exif: about.exif.as_deref().and_then(|block| exif::of_picture(block, size)),
        profile: about.profile.clone().filter(|profile| is_profile_of(profile, form.channels)),
    };
    let stride = form.stride().max(1);
    match options.kind {
        PictureKind::Png => {
            let mut writer = begun_png(output, form, &about)?;
            let mut stream = writer.stream_writer_with_size(STRIP).map_err(io::Error::other)?;
            fill(&mut |levels| match levels {
                PictureLevels::Bytes(levels) => stream.write_all(levels),
                PictureLevels::Words(levels) => levels.chunks(stride).try_for_each(|line| stream.write_all(&bytes(line, u16::to_be_bytes))),
            })?;
            stream.finish().map_err(io::Error::other)?;
            Ok(writer.finish().map_err(io::Error::other)?)
        }
        PictureKind::Tiff => {
            output.write_all(&tiff_head(form, &about))?;
            fill(&mut |levels| match levels {
                PictureLevels::Bytes(levels) => output.write_all(levels),
                PictureLevels::Words(levels) => levels.chunks(stride).try_for_each(|line| output.write_all(&bytes(line, u16::to_le_bytes))),
            })
        }
        PictureKind::Jpeg => {
            let mut all = Vec::new();
            fill(&mut |levels| match levels {
                PictureLevels::Bytes(levels) => {
                    all.extend(levels);
                    Ok(())
                }
                PictureLevels::Words(_) => Err(io::ErrorKind::InvalidInput.into()),
            })?;
            Ok(write_jpeg(output, form, about, options.quality, &all)?)
        }
    }
}

fn write_jpeg(output: &mut dyn Write, form: PictureForm, about: About, quality: u8, levels: &[u8]) -> io::Result<()> {
    let colour = if form.channels == 1 { ExtendedColorType::L8 } else { ExtendedColorType::Rgb8 };
    let mut file = Vec::new();
    let mut encoder = JpegEncoder::new_with_quality(Cursor::new(&mut file), quality);
    if let Some(profile) = about.profile {
        encoder.set_icc_profile(profile).map_err(io::Error::other)?;
    }
    encoder.write_image(levels, form.size.width, form.size.height, colour).map_err(io::Error::other)?;
    // Behind the mark of the beginning.
    let (mark, rest) = file.split_at(2.min(file.len()));
    output.write_all(mark)?;
    if let Some(exif) = about.exif.filter(|block| block.len() + EXIF_HEAD.len() + 2 <= SEGMENT) {
        output.write_all(&[0xff, 0xe1])?;
        output.write_all(&((exif.len() + EXIF_HEAD.len() + 2) as u16).to_be_bytes())?;
        output.write_all(EXIF_HEAD)?;
        output.write_all(&exif)?;
    }
    output.write_all(rest)
}

fn bytes(levels: &[u16], of: fn(u16) -> [u8; 2]) -> Vec<u8> {
    levels.iter().flat_map(|level| of(*level)).collect()
}

/// Whether a profile is for so many channels: that of a file in CMYK is not for what became of it.
fn is_profile_of(profile: &[u8], channels: usize) -> bool {
    matches!((profile.get(16..20), channels), (Some(b"GRAY"), 1 | 2) | (Some(b"RGB "), 3 | 4))
}

fn begun_png<'w>(output: &'w mut dyn Write, form: PictureForm, about: &About) -> io::Result<png::Writer<&'w mut dyn Write>> {
    let mut info = png::Info::with_size(form.size.width, form.size.height);
    info.color_type = match form.channels {
        1 => png::ColorType::Grayscale,
        2 => png::ColorType::GrayscaleAlpha,
        3 => png::ColorType::Rgb,
        _ => png::ColorType::Rgba,
    };
    info.bit_depth = if form.is_deep { png::BitDepth::Sixteen } else { png::BitDepth::Eight };
    info.exif_metadata = about.exif.clone().map(Cow::Owned);
    info.icc_profile = about.profile.clone().map(Cow::Owned);
    let mut encoder = png::Encoder::with_info(output, info).map_err(io::Error::other)?;
    encoder.set_compression(png::Compression::Fast);
    encoder.write_header().map_err(io::Error::other)
}

/// All of a TIFF but its pixels, which follow.
fn tiff_head(form: PictureForm, about: &About) -> Vec<u8> {
    let mut own = about.exif.as_deref().and_then(|block| Directories::read(&mut Cursor::new(block)).ok()).unwrap_or_default();
    own.resize([form.size.width, form.size.height]);
    own.main.retain(|entry| entry.tag != PROFILE);
    let row = form.stride() * if form.is_deep { 2 } else { 1 };
    let rows = (STRIP / row.max(1)).clamp(1, form.size.height.max(1) as usize);
    let strips = (form.size.height as usize).div_ceil(rows);
    let bits = if form.is_deep { 16 } else { 8 };
    let count = |i: usize| (rows.min(form.size.height as usize - i * rows) * row) as u32;
    let more = |first: u32| {
        let mut more = vec![
            Entry::long(256, &[form.size.width]),
            Entry::long(257, &[form.size.height]),
            Entry::short(258, &vec![bits; form.channels]),
            Entry::short(259, &[1]),
            Entry::short(262, &[if form.channels < 3 { 1 } else { 2 }]),
            Entry::long(273, &(0..strips).map(|i| first.wrapping_add((i * rows * row) as u32)).collect::<Vec<u32>>()),
            Entry::short(274, &[1]),
            Entry::short(277, &[form.channels as u16]),
            Entry::long(278, &[rows as u32]),
            Entry::long(279, &(0..strips).map(count).collect::<Vec<u32>>()),
            Entry::short(284, &[1]),
        ];
        if form.channels.is_multiple_of(2) {
            // Alpha by which colours are not multiplied.
            more.push(Entry::short(338, &[2]));
        }
        more.extend(about.profile.clone().map(|value| Entry { tag: PROFILE, kind: 7, value }));
        more
    };
    // The length does not depend on the places of the strips.
    let first = own.file(more(0)).len() as u32;
    own.file(more(first))
}
