//! Why a sensor cannot be, or cannot write.

use thiserror::Error;

use super::Design;

/// Why a sensor cannot be, or cannot write an image.
#[derive(Debug, Error)]
pub enum SensorError {
    /// A number outside its bounds.
    #[error("{what} is {value}: expected a number from {min} to {max}")]
    OutOfRange {
        /// The parameter.
        what: &'static str,
        /// The number.
        value: f64,
        /// The least that can be.
        min: f64,
        /// The most that can be.
        max: f64,
    },
    /// Bits that no converter or file has.
    #[error("{what} of {bits} bits: expected {expected}")]
    Bits {
        /// Of what.
        what: &'static str,
        /// The bits that were asked for.
        bits: u32,
        /// Which there are.
        expected: &'static str,
    },
    /// Nothing to demosaic.
    #[error("demosaic without a colour filter")]
    NoFilter,
    /// Numbers in DN, and nothing that makes DN.
    #[error("a system gain or black level in DN without the bits of the converter")]
    NoConverter,
    /// JPEG of more than 8 bits.
    #[error("JPEG has 8 bits, the output is to have {0}")]
    JpegBits(u32),
    /// A size that JPEG cannot hold.
    #[error("JPEG holds from 1 x 1 to 65535 x 65535 px, the image has {width} x {height}")]
    JpegSize {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The codec refused.
    #[error("JPEG")]
    Jpeg(#[from] image::ImageError),
}

pub(super) fn check(what: &'static str, value: f64, min: f64, max: f64) -> Result<(), SensorError> {
    let inside = value >= min && value <= max;
    if inside { Ok(()) } else { Err(SensorError::OutOfRange { what, value, min, max }) }
}

pub(super) fn check_bits(what: &'static str, bits: Option<u32>, known: &[u32], expected: &'static str) -> Result<(), SensorError> {
    match bits {
        Some(bits) if !known.contains(&bits) => Err(SensorError::Bits { what, bits, expected }),
        _ => Ok(()),
    }
}

/// A table for JPEG of 8 bits without zeros, and no quality beside it.
pub(super) fn check_tables(design: &Design) -> Result<(), SensorError> {
    let Some(table) = &design.tables else { return Ok(()) };
    if let Some(bits) = design.output.filter(|bits| *bits != 8) {
        return Err(SensorError::JpegBits(bits));
    }
    check("JPEG's quality beside its table", f64::from(design.jpeg.unwrap_or(0)), 0.0, 0.0)?;
    check("a step of JPEG's table", table.iter().copied().min().map_or(1.0, f64::from), 1.0, 255.0)
}
