//! Pictures in memory, or rows of them.

use calibench_model::camera::ImageSize;
use thiserror::Error;

/// A level of a picture's channel.
pub trait Sample: Copy + Default + Send + Sync + 'static {
    /// The largest level: no light passes where alpha has it. 1 for floating point.
    const TOP: f32;
    /// As a number.
    fn to_f32(self) -> f32;
    /// The nearest level, halves to the even one; what lies outside is clipped, not-a-number is 0. Floating point stays as it is.
    fn of_f32(value: f32) -> Self;
}

/// From it on numbers of single precision are whole.
const WHOLE: f32 = 8_388_608.0;

macro_rules! whole {
    ($level:ty) => {
        impl Sample for $level {
            const TOP: f32 = <$level>::MAX as f32;

            #[inline(always)]
            fn to_f32(self) -> f32 {
                f32::from(self)
            }

            #[inline(always)]
            fn of_f32(value: f32) -> Self {
                // Written so that not-a-number is 0. The lowest bits of the sum are the nearest whole number.
                let inside = if value > 0.0 { value.min(Self::TOP) } else { 0.0 };
                (inside + WHOLE).to_bits() as $level
            }
        }
    };
}

whole!(u8);
whole!(u16);

impl Sample for f32 {
    const TOP: f32 = 1.0;

    #[inline(always)]
    fn to_f32(self) -> f32 {
        self
    }

    #[inline(always)]
    fn of_f32(value: f32) -> Self {
        value
    }
}

/// A picture, or some of its rows: levels row by row, the channels of a pixel beside each other.
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a, T> {
    pub(crate) size: ImageSize,
    pub(crate) channels: usize,
    pub(crate) first: usize,
    pub(crate) samples: &'a [T],
}

/// What is no picture.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum PictureError {
    /// Channels.
    #[error("{0} channels; expected 1 (grey), 2 (grey, alpha), 3 (red, green, blue) or 4 (with alpha)")]
    Channels(usize),
    /// A number of levels that makes no rows.
    #[error("{found} levels are no rows of {width} px with {channels} channels within {height} rows")]
    Rows {
        /// How many there are.
        found: usize,
        /// Columns.
        width: u32,
        /// Rows at most.
        height: u32,
        /// Channels.
        channels: usize,
    },
    /// Another size than the map's.
    #[error("the picture has {found}, the map is for {expected} px")]
    Size {
        /// Columns x rows, or rows.
        found: String,
        /// Columns x rows of the map's source.
        expected: String,
    },
}

impl<'a, T> Picture<'a, T> {
    /// All rows of a picture of `size`, or those from row `first` on.
    ///
    /// # Errors
    /// A number of channels that is not 1 to 4; levels that are not whole rows, or more rows than there are.
    pub fn new(size: ImageSize, channels: usize, first: usize, samples: &'a [T]) -> Result<Self, PictureError> {
        if !(1..=4).contains(&channels) {
            return Err(PictureError::Channels(channels));
        }
        let stride = size.width as usize * channels;
        let rows = samples.len().checked_div(stride).unwrap_or(0);
        if rows * stride != samples.len() || rows == 0 || rows + first > size.height as usize {
            return Err(PictureError::Rows { found: samples.len(), width: size.width, height: size.height, channels });
        }
        Ok(Self { size, channels, first, samples })
    }

    /// Rows that are there.
    pub(crate) fn rows(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.samples.len() / self.stride()
    }

    /// Levels of a row.
    pub(crate) fn stride(&self) -> usize {
        self.size.width as usize * self.channels
    }

    /// Whether the last channel is alpha.
    pub(crate) fn has_alpha(&self) -> bool {
        self.channels.is_multiple_of(2)
    }
}
