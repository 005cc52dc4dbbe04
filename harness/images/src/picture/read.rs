//! Photographs, row by row.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use calibench_model::camera::ImageSize;
use image::error::{DecodingError, ImageFormatHint};
use image::{ColorType, DynamicImage, ImageDecoder, ImageError, ImageFormat};

use super::exif::{Directories, PROFILE};
use super::tiff_rows::TiffRows;
use super::{About, PictureForm, PictureKind, PictureLevels};
use crate::photo::{self, PhotoError, Turn, budget, jpeg, of_png, open, reader};

/// A photograph whose rows come one after the other.
pub struct Opened {
    path: PathBuf,
    form: PictureForm,
    turn: Option<Turn>,
    kind: PictureKind,
    about: About,
    rows: Rows,
    /// Rows that were given away.
    given: usize,
}

enum Rows {
    /// A PNG that is not interlaced.
    Png(Box<png::Reader<BufReader<File>>>),
    /// A TIFF of strips or tiles.
    Tiff(Box<TiffRows>),
    /// All of it, with the memory that it may take.
    Whole(DynamicImage, #[expect(dead_code, reason = "given back when dropped")] budget::Share),
}

impl Opened {
    /// Opens a photograph; `as_stored`: whatever orientation it asks for. A PNG that is not interlaced, and a TIFF of plain strips or tiles, are not read
    /// beyond their head, unless they are to be turned.
    ///
    /// # Errors
    /// As [`photo::read_photo`].
    pub fn new(path: &Path, as_stored: bool) -> Result<Self, PhotoError> {
        let content = |source| PhotoError::Content { path: path.to_owned(), source };
        let in_file = |source| PhotoError::File { path: path.to_owned(), source };
        let mut input = BufReader::new(open(path)?);
        let format = reader(&mut input).map_err(in_file)?.format();
        if format == Some(ImageFormat::Jpeg) && !jpeg::is_whole(&mut input).map_err(in_file)? {
            return Err(PhotoError::Truncated { path: path.to_owned() });
        }
        photo::is_no_thumbnail(path, &mut input)?;
        let mut reader = reader(&mut input).map_err(in_file)?;
        reader.limits(budget::limits(budget::MOST_BYTES));
        let mut decoder = reader.into_decoder().map_err(content)?;
        let turn = Turn::of(decoder.orientation().map_err(content)?).filter(|_| !as_stored);
        let mut about = About {
            exif: decoder.exif_metadata().ok().flatten().filter(|block| !block.is_empty()),
            profile: decoder.icc_profile().ok().flatten().filter(|profile| !profile.is_empty()),
        };
        let kind = PictureKind::of(format);
        if turn.is_none() {
            drop(decoder);
            let rows = match format {
                Some(ImageFormat::Png) => png_rows(path)?,
                Some(ImageFormat::Tiff) => TiffRows::open(path)?.map(|(form, rows)| (form, Rows::Tiff(Box::new(rows)))),
                _ => None,
            };
            if format == Some(ImageFormat::Tiff) {
                about = about_tiff(path)?;
            }
            if let Some((form, rows)) = rows {
                return Ok(Self { path: path.to_owned(), form, turn, kind, about, rows, given: 0 });
            }
        } else if format == Some(ImageFormat::Tiff) {
            drop(decoder);
            about = about_tiff(path)?;
        } else {
            drop(decoder);
        }
        Self::whole(path, turn, kind, about)
    }

    fn whole(path: &Path, turn: Option<Turn>, kind: PictureKind, about: About) -> Result<Self, PhotoError> {
        let (mut image, _, share) = photo::decoded(path, &mut BufReader::new(open(path)?))?;
        if let Some(turn) = turn {
            turn.apply_to_levels(&mut image);
        }
        let image = match image.color() {
            ColorType::L8
            | ColorType::La8
            | ColorType::Rgb8
            | ColorType::Rgba8
            | ColorType::L16
            | ColorType::La16
            | ColorType::Rgb16
            | ColorType::Rgba16 => image,
            other if other.has_alpha() => DynamicImage::ImageRgba16(image.to_rgba16()),
            _ => DynamicImage::ImageRgb16(image.to_rgb16()),
        };
        let form = form_of((image.width(), image.height()), image.color());
        Ok(Self { path: path.to_owned(), form, turn, kind, about, rows: Rows::Whole(image, share), given: 0 })
    }

    /// Size, channels and depth, upright.
    pub fn form(&self) -> PictureForm {
        self.form
    }

    /// How it was turned to be upright.
    pub fn turn(&self) -> Option<Turn> {
        self.turn
    }

    /// The kind of file.
    pub fn kind(&self) -> PictureKind {
        self.kind
    }

    /// What it says of itself.
    pub fn about(&self) -> &About {
        &self.about
    }

    /// Whether its rows are read when they are asked for.
    pub fn is_in_rows(&self) -> bool {
        !matches!(self.rows, Rows::Whole(..))
    }

    /// Appends the next `count` rows, or those that are left.
    ///
    /// # Errors
    /// What the decoder says.
    pub fn read(&mut self, count: usize, into: &mut PictureLevels) -> Result<(), PhotoError> {
        let count = count.min(self.form.size.height as usize - self.given);
        let content = |source| PhotoError::Content { path: self.path.clone(), source };
        match &mut self.rows {
            Rows::Png(reader) => {
                let stride = self.form.stride() * if self.form.is_deep { 2 } else { 1 };
                let mut line = vec![0; stride];
                for row in 0..count {
                    reader.read_row(&mut line).map_err(of_png).map_err(content)?;
                    match into {
                        PictureLevels::Bytes(levels) => levels.extend(&line),
                        PictureLevels::Words(levels) => {
                            levels.extend(line.as_chunks::<2>().0.iter().map(|level| u16::from_be_bytes(*level)));
                        }
                    }
                    if self.given + row + 1 == self.form.size.height as usize {
                        // To the end of the data, whose checksum comes last.
                        reader.read_row(&mut []).map_err(of_png).map_err(content)?;
                    }
                }
            }
            Rows::Tiff(rows) => rows.read(count, into).map_err(|error| content(of_tiff(error)))?,
            Rows::Whole(image, _) => {
                let part = self.given * self.form.stride()..(self.given + count) * self.form.stride();
                match (into, image) {
                    (PictureLevels::Bytes(levels), image) => levels.extend(image.as_bytes().get(part).unwrap_or_default()),
                    (PictureLevels::Words(levels), DynamicImage::ImageLuma16(image)) => levels.extend(&image.as_raw()[part]),
                    (PictureLevels::Words(levels), DynamicImage::ImageLumaA16(image)) => levels.extend(&image.as_raw()[part]),
                    (PictureLevels::Words(levels), DynamicImage::ImageRgb16(image)) => levels.extend(&image.as_raw()[part]),
                    (PictureLevels::Words(levels), DynamicImage::ImageRgba16(image)) => levels.extend(&image.as_raw()[part]),
                    (PictureLevels::Words(_), _) => {}
                }
            }
        }
        self.given += count;
        Ok(())
    }
}

fn form_of((width, height): (u32, u32), colour: ColorType) -> PictureForm {
    let channels = usize::from(colour.channel_count());
    PictureForm { size: ImageSize { width, height }, channels, is_deep: usize::from(colour.bytes_per_pixel()) > channels }
}

/// A PNG whose rows come one after the other: of what has less than 8 bits, and of palettes, in 8.
fn png_rows(path: &Path) -> Result<Option<(PictureForm, Rows)>, PhotoError> {
    let content = |error| PhotoError::Content { path: path.to_owned(), source: of_png(error) };
    let limits = png::Limits { bytes: usize::try_from(budget::MOST_BYTES).unwrap_or(usize::MAX) };
    let mut decoder = png::Decoder::new_with_limits(BufReader::new(open(path)?), limits);
    decoder.set_transformations(png::Transformations::EXPAND);
    let reader = decoder.read_info().map_err(content)?;
    if reader.info().interlaced {
        return Ok(None);
    }
    let (width, height) = (reader.info().width, reader.info().height);
    let (colour, depth) = reader.output_color_type();
    let form = PictureForm { size: ImageSize { width, height }, channels: colour.samples(), is_deep: depth == png::BitDepth::Sixteen };
    Ok(Some((form, Rows::Png(Box::new(reader)))))
}

/// What a TIFF says of itself; nothing where that is damaged.
fn about_tiff(path: &Path) -> Result<About, PhotoError> {
    let Ok(mut found) = Directories::read(&mut BufReader::new(open(path)?)) else { return Ok(About::default()) };
    let place = found.main.iter().position(|entry| entry.tag == PROFILE);
    let profile = place.map(|place| found.main.remove(place).value);
    let exif = (found != Directories::default()).then(|| found.file(Vec::new()));
    Ok(About { exif, profile })
}

fn of_tiff(error: tiff::TiffError) -> ImageError {
    match error {
        tiff::TiffError::IoError(source) => ImageError::IoError(source),
        other => ImageError::Decoding(DecodingError::new(ImageFormatHint::Exact(ImageFormat::Tiff), other)),
    }
}
