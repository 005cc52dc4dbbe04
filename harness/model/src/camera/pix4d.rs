//! Pix4D's perspective camera.

use super::{ImageSize, TangentialOrder};

/// Pix4D's perspective camera. Direction: **ideal to distorted**; y points down as in its camera matrix; the outer corner of the first pixel is
/// (0, 0); normalised by the focal length.
///
/// With `x = X/Z`, `y = Y/Z` (x right, y down, z forward), `r2 = x^2 + y^2` and `q = 1 + r1 r2 + r2' r2^2 + r3 r2^3`, with the assumed order
/// [`TangentialOrder::OpenCv`]: `x' = x q + 2 t1 x y + t2 (r2 + 2 x^2)`, `y' = y q + 2 t2 x y + t1 (r2 + 2 y^2)`, `u = f x' + px`, `v = f y' + py`.
///
/// Source: Pix4D, "How are the Internal and External Camera Parameters defined?" (text; its formulas are pictures). Camera matrix, .cam file and
/// P-matrices of one project agree; the order and the signs of T1 and T2 are not confirmed by numbers, so the order is a field.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pix4d {
    /// Size of its images.
    pub size: ImageSize,
    /// Width of the sensor, mm: what makes mm of its files px.
    pub sensor_width_mm: f64,
    /// Focal length, px.
    pub f_px: f64,
    /// Principal point, x, px from the outer corner of the first pixel.
    pub px: f64,
    /// Principal point, y, px downwards from the outer corner of the first pixel.
    pub py: f64,
    /// R1, R2, R3.
    pub r: [f64; 3],
    /// T1, T2.
    pub t: [f64; 2],
    /// Order of T1 and T2: OpenCV's is assumed, not confirmed.
    pub order: TangentialOrder,
}
