mod closed_form;
mod covariance;
mod differences;
mod fitted;
mod mistakes;
mod other_tools;
mod published;

use crate::camera::{Camera, CameraModel, ImageSize, OpenCv, Photogrammetric};

const SIZE: ImageSize = ImageSize { width: 1362, height: 1021 };

fn opencv(coefficients: usize, values: &[f64]) -> OpenCv {
    let mut distortion = [0.0; 14];
    distortion[..values.len()].copy_from_slice(values);
    OpenCv { size: SIZE, fx: 1500.0, fy: 1500.0, cx: 690.0, cy: 500.0, distortion, coefficients }
}

/// A lens of little distortion, p1 far from p2.
fn mild() -> Camera {
    opencv(5, &[-0.06, 0.02, 4e-4, -1.5e-3, -0.004]).into()
}

fn photogrammetric() -> Photogrammetric {
    let (k, p) = ([-1.2e-3, 1.5e-5, -1e-8], [2e-4, -3e-5]);
    Photogrammetric { size: SIZE, pitch_um: 4.7, c: 6.6, x0: 0.0411, y0: -0.03, k, p, b: [1e-4, -2e-4] }
}

fn values(camera: &Camera) -> Vec<f64> {
    camera.parameters().iter().map(|p| p.value).collect()
}
