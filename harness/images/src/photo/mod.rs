//! Photographs in, images out.

mod bands;
pub(crate) mod budget;
mod container;
mod dense;
mod depth;
mod filters;
mod folder;
mod foreign;
pub mod grey;
mod helped;
pub(crate) mod jpeg;
mod levels;
mod quantisation;
mod rows;
mod turn;

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, Write};
use std::path::{Path, PathBuf};

use calibench_files::atomic::write_atomically;
use calibench_model::Image;
use calibench_model::camera::ImageSize;
use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat, ImageReader};
use thiserror::Error;
use tiff::encoder::{TiffEncoder, colortype};

pub use bands::encode_png;
pub use budget::MOST_BYTES;
pub use dense::encode_png_densely;
pub use depth::{DeepLevels, Depth, read_with_levels};
pub use folder::{PhotoFolder, natural};
pub use foreign::Foreign;
pub use levels::{Levels, read_levels};
pub use quantisation::quantisation;
pub(crate) use rows::of_png;
pub use turn::Turn;

/// Bytes of a file in which its orientation usually stands.
const HEAD: u64 = 1 << 20;

/// A photograph that cannot be read, or an image that cannot be written.
#[derive(Debug, Error)]
pub enum PhotoError {
    /// The file itself.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A file that cannot be written; the message names it.
    #[error(transparent)]
    Output(#[from] io::Error),
    /// Its content.
    #[error("{}: not an image that can be read: {source} (expected PNG, JPEG, TIFF, PNM, BMP or WebP)", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What the decoder says.
        source: ImageError,
    },
    /// A format that is not read.
    #[error("{}: is {what}, which is not read; {}", path.display(), what.advice(path))]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What it is.
        what: Foreign,
    },
    /// A part of the image is missing.
    #[error("{}: is cut short: the end mark of the JPEG is missing; expected a whole image, copy it again", path.display())]
    Truncated {
        /// The file.
        path: PathBuf,
    },
    /// A TIFF, or a camera's raw file, which begins with a reduced copy of what it holds.
    #[error(
        "{}: its first image has {} x {} px and is a thumbnail of another in the file, of {} x {} px; expected one image: develop a raw file (`{}`), or export \
         the page, as PNG or TIFF",
        path.display(), size.0, size.1, of.0, of.1, Foreign::Raw.conversion(path)
    )]
    Thumbnail {
        /// The file.
        path: PathBuf,
        /// Columns and rows of the first image, px.
        size: (u32, u32),
        /// Those of the largest, px.
        of: (u32, u32),
    },
    /// More than the memory that photographs may take while they are read.
    #[error(
        "{}: {width} x {height} px take {} MB while they are read, more than {} MB; cut the image into tiles or save it with 8 bits",
        path.display(), bytes >> 20, MOST_BYTES >> 20
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Columns, px.
        width: u32,
        /// Rows, px.
        height: u32,
        /// Memory, bytes.
        bytes: u64,
    },
}

/// A photograph as it is meant to be seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Photo {
    /// Its grey values, upright.
    pub image: Image<'static>,
    /// How the pixels of the file were turned to be upright; `None` if the file asks for nothing.
    pub turn: Option<Turn>,
}

/// How pixels of files become images: alike for all photographs that one camera took.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Pixels stay where the file has them, which is where the sensor had them, whatever orientation it asks for.
    pub as_stored: bool,
    /// So many of the 16 bits of a level are in use, the lower ones: the largest number of them is white.
    pub bits: u8,
}

impl Default for Reading {
    /// Upright, and all bits.
    fn default() -> Self {
        Self { as_stored: false, bits: 16 }
    }
}

impl Reading {
    /// What is white, a fraction of the largest level that the bytes can hold, if it is another.
    fn white(self, colour: ColorType) -> Option<f32> {
        (is_deep(colour) && self.bits < 16).then(|| f32::from(depth::most(self.bits)) / 65535.0)
    }
}

/// Reads a photograph as grey values. The format is found by content; all bits of 16-bit images are kept.
///
/// Colour becomes luma with the weights .299, .587, .114 of Rec. 601, in floating point; transparency is ignored. White is 1, of a PNM what it calls the largest
/// value. The orientation that EXIF (JPEG, PNG) or
/// the TIFF tag asks for is applied, as OpenCV's `imread` does: columns and rows are those of the image as it is seen.
///
/// Memory: at most [`MOST_BYTES`] for all photographs that are being decoded at a time, others wait; 4 bytes a pixel once read, 8 while it is turned. The file itself is not counted.
/// Of a PNG that is not interlaced the pixels are never there as a whole.
///
/// # Errors
/// A file that is missing, no image, cut short, too large, or that begins with a thumbnail.
pub fn read_photo(path: &Path) -> Result<Photo, PhotoError> {
    read_photo_as(path, Reading::default())
}

/// The same, read as its set is.
///
/// # Errors
/// As [`read_photo`].
pub fn read_photo_as(path: &Path, reading: Reading) -> Result<Photo, PhotoError> {
    decode(path, &mut BufReader::new(open(path)?), reading)
}

/// What images are read from. Decoders are compiled for every type that they read from, and are large: this one is for all.
pub(crate) trait Input: BufRead + Seek {}

impl<T: BufRead + Seek> Input for T {}

/// A reader of the image in `input`, whose format its first bytes tell.
pub(crate) fn reader(input: &mut dyn Input) -> io::Result<ImageReader<&mut dyn Input>> {
    ImageReader::new(input).with_guessed_format()
}

pub(crate) fn open(path: &Path) -> Result<File, PhotoError> {
    let in_file = |source| PhotoError::File { path: path.to_owned(), source };
    let about = path.metadata().map_err(in_file)?;
    if about.is_dir() {
        return Err(in_file(io::Error::other("is a folder, expected an image file")));
    }
    // To open a pipe again would be to wait for ever.
    if !about.is_file() {
        return Err(in_file(io::Error::other("is no regular file; photographs are read more than once: save it as a file first")));
    }
    let mut file = File::open(path).map_err(in_file)?;
    let mut head = Vec::new();
    Read::by_ref(&mut file).take(foreign::TELLING as u64).read_to_end(&mut head).map_err(in_file)?;
    if let Some(what) = Foreign::of(&head) {
        return Err(PhotoError::Foreign { path: path.to_owned(), what });
    }
    file.rewind().map_err(in_file)?;
    Ok(file)
}

/// What the head of a photograph says of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Head {
    /// Columns and rows as the file has them.
    pub stored: ImageSize,
    /// How [`read_photo`] turns it.
    pub turn: Option<Turn>,
    /// Whether it has more than 8 bits a channel.
    pub is_deep: bool,
}

impl Head {
    /// Columns and rows of the photograph as it is read.
    pub fn size(&self, reading: Reading) -> ImageSize {
        let ImageSize { width, height } = self.stored;
        let turned = self.turn.is_some_and(Turn::is_on_its_side) && !reading.as_stored;
        if turned { ImageSize { width: height, height: width } } else { self.stored }
    }
}

/// What the head of a photograph says of it; pixels are not read.
///
/// # Errors
/// A file that is missing or no image, or that begins with a thumbnail.
pub fn head_of(path: &Path) -> Result<Head, PhotoError> {
    let in_file = |source| PhotoError::File { path: path.to_owned(), source };
    let mut head = Vec::new();
    open(path)?.take(HEAD).read_to_end(&mut head).map_err(in_file)?;
    let content = |source| PhotoError::Content { path: path.to_owned(), source };
    let is_tiff = reader(&mut Cursor::new(&head)).is_ok_and(|reader| reader.format() == Some(ImageFormat::Tiff));
    match head_in(&mut Cursor::new(&head)) {
        Ok(head) if !is_tiff => Ok(head),
        // What a TIFF says of itself may stand at its end.
        _ => {
            let mut input = BufReader::new(open(path)?);
            is_no_thumbnail(path, &mut input)?;
            head_in(&mut input).map_err(content)
        }
    }
}

fn head_in(input: &mut dyn Input) -> Result<Head, ImageError> {
    let mut reader = reader(input)?;
    reader.limits(budget::limits(MOST_BYTES));
    let mut decoder = reader.into_decoder()?;
    let (width, height) = decoder.dimensions();
    Ok(Head { stored: ImageSize { width, height }, turn: Turn::of(decoder.orientation()?), is_deep: is_deep(decoder.color_type()) })
}

pub(crate) fn is_no_thumbnail(path: &Path, input: &mut dyn Input) -> Result<(), PhotoError> {
    let found = container::thumbnail(input);
    found.map_or(Ok(()), |[size, of]| Err(PhotoError::Thumbnail { path: path.to_owned(), size, of }))
}

fn is_deep(colour: ColorType) -> bool {
    colour.bytes_per_pixel() > colour.channel_count()
}

/// Columns and rows of a photograph as [`read_photo`] gives it, from its head alone.
///
/// # Errors
/// As [`head_of`].
pub fn size_of(path: &Path) -> Result<ImageSize, PhotoError> {
    Ok(head_of(path)?.size(Reading::default()))
}

/// As [`read_photo`], from bytes; `path` is the name in errors.
///
/// # Errors
/// As [`read_photo`].
pub fn parse_photo(path: &Path, bytes: &[u8]) -> Result<Photo, PhotoError> {
    decode(path, &mut Cursor::new(bytes), Reading::default())
}

fn decode(path: &Path, input: &mut dyn Input, reading: Reading) -> Result<Photo, PhotoError> {
    let in_rows = rows::is_in_rows(input).map_err(|source| PhotoError::File { path: path.to_owned(), source })?;
    if in_rows {
        let (decoder, turn, share) = begun(path, input, budget::needed_in_rows)?;
        let head = (decoder.dimensions(), decoder.color_type());
        drop(decoder);
        let image = rows::grey_of(input, head, share).map_err(|source| PhotoError::Content { path: path.to_owned(), source })?;
        return Ok(finished(image, reading.white(head.1), turn, reading));
    }
    let (image, turn, share) = decoded(path, input)?;
    let white = reading.white(image.color());
    Ok(finished(helped::grey_of(image, share), white, turn, reading))
}

/// Grey values of which `white` is 1, turned if wanted.
fn finished(mut image: Image<'static>, white: Option<f32>, turn: Option<Turn>, reading: Reading) -> Photo {
    if let Some(white) = white {
        image.grey_mut().iter_mut().for_each(|grey| *grey /= white);
    }
    let turn = turn.filter(|_| !reading.as_stored);
    Photo { image: if let Some(turn) = turn { turn.apply(&image) } else { image }, turn }
}

/// The pixels as they stand in the file, how they are to be turned, and the part of the memory that they may take.
pub(crate) fn decoded(path: &Path, input: &mut dyn Input) -> Result<(DynamicImage, Option<Turn>, budget::Share), PhotoError> {
    let (decoder, turn, share) = begun(path, input, budget::needed)?;
    let image = DynamicImage::from_decoder(decoder).map_err(|source| PhotoError::Content { path: path.to_owned(), source })?;
    Ok((image, turn, share))
}

/// A decoder that has read the file's head, how the pixels are to be turned, and the part of the memory that they may take: what is `needed`.
fn begun<'i>(
    path: &Path,
    input: &'i mut dyn Input,
    needed: fn(&dyn ImageDecoder) -> u64,
) -> Result<(impl ImageDecoder + use<'i>, Option<Turn>, budget::Share), PhotoError> {
    let in_file = |source| PhotoError::File { path: path.to_owned(), source };
    let content = |source| PhotoError::Content { path: path.to_owned(), source };
    let format = reader(input).map_err(in_file)?.format();
    if format == Some(ImageFormat::Jpeg) && !jpeg::is_whole(input).map_err(in_file)? {
        // The decoder would fill what is missing with grey.
        return Err(PhotoError::Truncated { path: path.to_owned() });
    }
    is_no_thumbnail(path, input)?;
    let mut reader = reader(input).map_err(in_file)?;
    reader.limits(budget::limits(MOST_BYTES));
    let mut decoder = reader.into_decoder().map_err(content)?;
    let (width, height) = decoder.dimensions();
    let bytes = needed(&decoder);
    let share = budget::share(bytes).ok_or_else(|| PhotoError::TooLarge { path: path.to_owned(), width, height, bytes })?;
    decoder.set_limits(budget::limits(bytes)).map_err(content)?;
    let turn = Turn::of(decoder.orientation().map_err(content)?);
    Ok((decoder, turn, share))
}

/// Writes an image as PNG file: [`encode_png`].
///
/// # Errors
/// What the file system refuses; an older file is then as it was.
pub fn write_png(path: &Path, image: &Image, sixteen_bits: bool) -> Result<(), PhotoError> {
    Ok(write_atomically(path, |file| encode_png(file, image, sixteen_bits))?)
}

/// Begins a PNG of grey levels with 8 or 16 bits.
fn begin<W: Write>(output: W, image: &Image, sixteen_bits: bool) -> io::Result<png::Writer<W>> {
    let mut encoder = png::Encoder::new(output, image.width() as u32, image.height() as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(if sixteen_bits { png::BitDepth::Sixteen } else { png::BitDepth::Eight });
    encoder.write_header().map_err(io::Error::other)
}

/// Encodes the grey values as they are, as TIFF of single precision: 0 is black and 1 is white.
///
/// # Errors
/// An image that is too large for the format.
pub fn encode_float_tiff(image: &Image) -> io::Result<Vec<u8>> {
    let mut file = Cursor::new(Vec::new());
    let (width, height) = (image.width() as u32, image.height() as u32);
    let mut encoder = TiffEncoder::new(&mut file).map_err(io::Error::other)?;
    encoder.write_image::<colortype::Gray32Float>(width, height, image.grey()).map_err(io::Error::other)?;
    Ok(file.into_inner())
}

#[cfg(test)]
mod tests;
