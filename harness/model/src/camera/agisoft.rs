//! The frame cameras of Agisoft: Metashape, PhotoScan, Lens.

use super::ImageSize;

/// Whose formulas and origins an [`Agisoft`] camera follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AgisoftVersion {
    /// PhotoScan from 1.2 and Metashape: f, b1, b2, cx and cy from the centre of the frame, Brown's order of p1 and p2.
    Metashape,
    /// PhotoScan before 1.2: fx, fy, skew, cx and cy from the corner of the first pixel, OpenCV's order of p1 and p2.
    PhotoScan,
    /// Lens 0.4: fx, fy, skew, cx and cy from the corner of the first pixel, OpenCV's order of p1 and p2.
    Lens,
}

/// Agisoft's frame camera. Direction: **ideal to distorted**; y points down; the outer corner of the first pixel is (0, 0); normalised by the focal
/// length.
///
/// With `x = X/Z`, `y = Y/Z` (x right, y down, z forward), `r2 = x^2 + y^2` and `q = 1 + k1 r2 + k2 r2^2 + k3 r2^3 + k4 r2^4`:
///
/// - [`AgisoftVersion::Metashape`]: `x' = x q + (p1 (r2 + 2 x^2) + 2 p2 x y) (1 + p3 r2 + p4 r2^2)`,
///   `y' = y q + (p2 (r2 + 2 y^2) + 2 p1 x y) (1 + p3 r2 + p4 r2^2)`, `u = W/2 + cx + f x' + b1 x' + b2 y'`, `v = H/2 + cy + f y'`;
/// - the older ones: `x' = x q + p2 (r2 + 2 x^2) + 2 p1 x y`, `y' = y q + p1 (r2 + 2 y^2) + 2 p2 x y`, `u = cx + fx x' + skew y'`, `v = cy + fy y'`,
///   kept here as `f = fy`, `b1 = fx - fy`, `b2 = skew`; their k4, p3 and p4 are zero.
///
/// Source: Agisoft Metashape and PhotoScan 1.2 user manuals, appendix "Camera models"; Lens 0.4 user manual; Agisoft's answer in its forum, topic
/// 6437, for `f = fy`, `b1 = fx - fy`, `b2 = skew`. What is confirmed by numbers: [`super::Convention::verification`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Agisoft {
    /// Size of its images.
    pub size: ImageSize,
    /// Whose formulas hold.
    pub version: AgisoftVersion,
    /// Focal length, px; that along y of the older versions.
    pub f: f64,
    /// Principal point, x, px: from the centre of the frame (`Metashape`) or from the corner of the first pixel.
    pub cx: f64,
    /// Principal point, y, px downwards: from the centre of the frame (`Metashape`) or from the corner of the first pixel.
    pub cy: f64,
    /// Affinity, px: fx - fy.
    pub b1: f64,
    /// Shear, px: the older versions' skew.
    pub b2: f64,
    /// k1 to k4.
    pub k: [f64; 4],
    /// p1 to p4, in the version's order.
    pub p: [f64; 4],
}
