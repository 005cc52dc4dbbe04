//! OpenCV's fisheye camera: four coefficients of the angle from the axis.

use super::ImageSize;

/// OpenCV's fisheye camera, of Kannala and Brandt. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With `r = sqrt(X^2 + Y^2)`, the angle from the axis `theta = atan2(r, Z)` (x right, y down, z forward) and
/// `theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)`: `x' = theta_d X / r`, `y' = theta_d Y / r`,
/// `u = fx (x' + skew y') + cx`, `v = fy y' + cy`. Rays beyond 90 degrees are pictured, where OpenCV's own functions divide by Z.
///
/// Source: OpenCV 4.6, module calib3d, "Fisheye camera model"; Kannala and Brandt 2006.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenCvFisheye {
    /// Size of its images.
    pub size: ImageSize,
    /// Focal length along x, px.
    pub fx: f64,
    /// Focal length along y, px.
    pub fy: f64,
    /// Principal point, x, px from the centre of the first pixel.
    pub cx: f64,
    /// Principal point, y, px downwards from the centre of the first pixel.
    pub cy: f64,
    /// OpenCV's `alpha`: a number; the camera matrix holds `fx alpha`.
    pub skew: f64,
    /// k1 to k4: coefficients of theta^3, theta^5, theta^7, theta^9.
    pub k: [f64; 4],
}
