//! TIFF files of plain strips or tiles, whose rows come one after the other.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use calibench_model::camera::ImageSize;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

use super::{PictureForm, PictureLevels};
use crate::photo::{PhotoError, open};

/// Photometric interpretations that are levels as they are: black is zero, and red, green, blue.
const PLAIN: [u32; 2] = [1, 2];

pub(super) struct TiffRows {
    decoder: Decoder<BufReader<File>>,
    form: PictureForm,
    /// Strips or tiles side by side.
    across: u32,
    /// The next row of strips or tiles.
    next: u32,
    /// Rows that were decoded and not yet given away.
    ready: PictureLevels,
}

impl TiffRows {
    /// `None` for what is left to other readers: other levels, channels that lie apart, what cannot be read.
    pub(super) fn open(path: &Path) -> Result<Option<(PictureForm, Self)>, PhotoError> {
        let file = BufReader::new(open(path)?);
        Ok(Self::of(file).ok().flatten())
    }

    fn of(file: BufReader<File>) -> Result<Option<(PictureForm, Self)>, TiffError> {
        let mut decoder = Decoder::new(file)?.with_limits(Limits::default());
        let (width, height) = decoder.dimensions()?;
        let mut number = |tag| decoder.find_tag_unsigned::<u32>(tag);
        let plain = number(Tag::PhotometricInterpretation)?.is_some_and(|found| PLAIN.contains(&found));
        let together = number(Tag::PlanarConfiguration)?.unwrap_or(1) == 1;
        // Of whole numbers; a chunk may be as large as the limits of the decoder, which are its own.
        let whole =
            decoder.find_tag_unsigned_vec::<u16>(Tag::SampleFormat)?.is_none_or(|formats| formats.iter().all(|format| *format == 1));
        let (channels, is_deep) = match decoder.colortype()? {
            ColorType::Gray(8) => (1, false),
            ColorType::Gray(16) => (1, true),
            ColorType::GrayA(8) => (2, false),
            ColorType::GrayA(16) => (2, true),
            ColorType::RGB(8) => (3, false),
            ColorType::RGB(16) => (3, true),
            ColorType::RGBA(8) => (4, false),
            ColorType::RGBA(16) => (4, true),
            _ => return Ok(None),
        };
        if !(plain && together && whole) {
            return Ok(None);
        }
        let form = PictureForm { size: ImageSize { width, height }, channels, is_deep };
        let across = width.div_ceil(decoder.chunk_dimensions().0.max(1));
        Ok(Some((form, Self { decoder, form, across, next: 0, ready: PictureLevels::new(is_deep) })))
    }

    /// Appends the next `count` rows.
    pub(super) fn read(&mut self, count: usize, into: &mut PictureLevels) -> Result<(), TiffError> {
        let wanted = count * self.form.stride();
        while self.ready.len() < wanted {
            let before = self.ready.len();
            self.decode()?;
            if self.ready.len() == before {
                return Err(TiffError::FormatError(tiff::TiffFormatError::InconsistentSizesEncountered));
            }
        }
        match (&mut *into, &self.ready) {
            (PictureLevels::Bytes(into), PictureLevels::Bytes(ready)) => into.extend(&ready[..wanted]),
            (PictureLevels::Words(into), PictureLevels::Words(ready)) => into.extend(&ready[..wanted]),
            _ => {}
        }
        self.ready.forget(wanted);
        Ok(())
    }

    /// Decodes the next row of strips or tiles.
    fn decode(&mut self) -> Result<(), TiffError> {
        let (stride, begin) = (self.form.stride(), self.ready.len());
        let mut left = 0;
        for column in 0..self.across {
            let chunk = self.next * self.across + column;
            let (width, height) = self.decoder.chunk_data_dimensions(chunk);
            let part = width as usize * self.form.channels;
            let decoded = self.decoder.read_chunk(chunk)?;
            let end = begin + height as usize * stride;
            match (&mut self.ready, decoded) {
                (PictureLevels::Bytes(ready), DecodingResult::U8(levels)) => place(ready, &levels, (begin, end), (left, part, stride)),
                (PictureLevels::Words(ready), DecodingResult::U16(levels)) => place(ready, &levels, (begin, end), (left, part, stride)),
                _ => return Err(TiffError::FormatError(tiff::TiffFormatError::InconsistentSizesEncountered)),
            }
            left += part;
        }
        self.next += 1;
        Ok(())
    }
}

/// Puts the rows of a strip or tile where they belong.
fn place<T: Copy + Default>(ready: &mut Vec<T>, levels: &[T], (begin, end): (usize, usize), (left, part, stride): (usize, usize, usize)) {
    ready.resize(end.max(ready.len()), T::default());
    for (line, levels) in ready[begin..end].chunks_exact_mut(stride).zip(levels.chunks_exact(part.max(1))) {
        line[left..left + part].copy_from_slice(levels);
    }
}
