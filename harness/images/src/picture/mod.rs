//! Photographs with all their channels and what they say of themselves: read and written row by row, where their format allows it.

mod exif;
mod read;
mod said;
mod tiff_rows;
mod write;

use calibench_model::camera::ImageSize;

pub use read::Opened;
pub use said::{Said, said};
pub use write::{PictureKind, WriteOptions, write_picture};

/// Levels of a picture, row by row, the channels of a pixel beside each other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureLevels {
    /// Of 8 bits.
    Bytes(Vec<u8>),
    /// Of 16 bits.
    Words(Vec<u16>),
}

impl PictureLevels {
    /// None, of 16 bits or of 8.
    pub fn new(is_deep: bool) -> Self {
        if is_deep { Self::Words(Vec::new()) } else { Self::Bytes(Vec::new()) }
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Bytes(levels) => levels.len(),
            Self::Words(levels) => levels.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Forgets the first `count`.
    pub fn forget(&mut self, count: usize) {
        match self {
            Self::Bytes(levels) => drop(levels.drain(..count.min(levels.len()))),
            Self::Words(levels) => drop(levels.drain(..count.min(levels.len()))),
        }
    }
}

/// What rows of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureForm {
    /// Columns and rows.
    pub size: ImageSize,
    /// 1 grey, 2 with alpha, 3 red, green and blue, 4 with alpha.
    pub channels: usize,
    /// Whether levels have 16 bits, not 8.
    pub is_deep: bool,
}

impl PictureForm {
    /// Levels of a row.
    pub fn stride(&self) -> usize {
        self.size.width as usize * self.channels
    }
}

/// What a photograph says of itself.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct About {
    /// Its EXIF block, a TIFF without pixels.
    pub exif: Option<Vec<u8>>,
    /// Its colour profile (ICC).
    pub profile: Option<Vec<u8>>,
}

#[cfg(test)]
mod tests;
