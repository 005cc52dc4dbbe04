//! OpenCV's pinhole camera with up to fourteen distortion coefficients.

use super::ImageSize;

/// OpenCV's camera. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0); normalised by the focal length.
///
/// With `x = X/Z`, `y = Y/Z` (x right, y down, z forward), `r2 = x^2 + y^2` and
/// `q = (1 + k1 r2 + k2 r2^2 + k3 r2^3) / (1 + k4 r2 + k5 r2^2 + k6 r2^3)`:
/// `x'' = x q + 2 p1 x y + p2 (r2 + 2 x^2) + s1 r2 + s2 r2^2`, `y'' = y q + p1 (r2 + 2 y^2) + 2 p2 x y + s3 r2 + s4 r2^2`, then the tilt of the sensor
/// by `tx`, `ty`, then `u = fx x'' + cx`, `v = fy y'' + cy`.
///
/// Note the order of p1 and p2: p2 multiplies r^2 + 2 x^2, unlike Brown's.
///
/// Source: OpenCV 4.6, module calib3d, "Camera Calibration and 3D Reconstruction".
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenCv {
    /// Size of its images.
    pub size: ImageSize,
    /// Focal length along x, px.
    pub fx: f64,
    /// Focal length along y, px.
    pub fy: f64,
    /// Principal point, x, px.
    pub cx: f64,
    /// Principal point, y, px.
    pub cy: f64,
    /// k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4, tx, ty (radians): OpenCV's order. Unused ones are zero.
    pub distortion: [f64; 14],
    /// How many of them the model has: 4, 5, 8, 12 or 14.
    pub coefficients: usize,
}

#[expect(dead_code, reason = "used by the projection that follows")]
const NAMES: [(&str, &str); 18] = [
    ("fx", "px"),
    ("fy", "px"),
    ("cx", "px"),
    ("cy", "px"),
    ("k1", ""),
    ("k2", ""),
    ("p1", ""),
    ("p2", ""),
    ("k3", ""),
    ("k4", ""),
    ("k5", ""),
    ("k6", ""),
    ("s1", ""),
    ("s2", ""),
    ("s3", ""),
    ("s4", ""),
    ("tx", "rad"),
    ("ty", "rad"),
];
