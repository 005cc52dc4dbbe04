//! Brown's camera as most tools have it: ideal to distorted, y down, from the centre of the first pixel, OpenCV's order of p1 and p2.

use calibench_model::camera::{Agisoft, AgisoftVersion, Camera, ImageSize, OpenCv, Pix4d, TangentialOrder};
use calibench_model::{CornerPoint, PixelPoint};

use super::CameraFileError;

/// `u = fx x' + skew y' + cx`, `v = fy y' + cy`: fx, fy, skew, cx, cy in px, k1 to k4, p1, p2 numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Brown {
    pub size: ImageSize,
    pub fx: f64,
    pub fy: f64,
    pub skew: f64,
    pub cx: f64,
    pub cy: f64,
    /// k1 to k4, numbers.
    pub k: [f64; 4],
    pub p1: f64,
    pub p2: f64,
}

impl Brown {
    /// One without distortion; fx, fy, cx, cy in px.
    pub fn plain(size: ImageSize, [fx, fy, cx, cy]: [f64; 4]) -> Self {
        Self { size, fx, fy, skew: 0.0, cx, cy, k: [0.0; 4], p1: 0.0, p2: 0.0 }
    }

    /// OpenCV's camera with 4 or 5 coefficients, or Metashape's, which has a place for a shear and for k4.
    pub fn camera(&self) -> Camera {
        let Self { size, fx, fy, skew, cx, cy, k, p1, p2 } = *self;
        if skew == 0.0 && k[3] == 0.0 {
            let mut distortion = [0.0; 14];
            distortion[..5].copy_from_slice(&[k[0], k[1], p1, p2, k[2]]);
            return OpenCv { size, fx, fy, cx, cy, distortion, coefficients: if k[2] == 0.0 { 4 } else { 5 } }.into();
        }
        let corner = PixelPoint::new(cx, cy).to_corner();
        let (cx, cy) = (corner.x - f64::from(size.width) / 2.0, corner.y - f64::from(size.height) / 2.0);
        Agisoft { size, version: AgisoftVersion::Metashape, f: fy, cx, cy, b1: fx - fy, b2: skew, k, p: [p2, p1, 0.0, 0.0] }.into()
    }

    /// The parts of a camera whose model has no others.
    pub fn of(camera: &Camera) -> Option<Self> {
        match *camera {
            Camera::OpenCv(OpenCv { size, fx, fy, cx, cy, distortion, .. }) => {
                let [k1, k2, p1, p2, k3, rest @ ..] = distortion;
                let form = Self { size, fx, fy, skew: 0.0, cx, cy, k: [k1, k2, k3, 0.0], p1, p2 };
                rest.iter().all(|&value| value == 0.0).then_some(form)
            }
            Camera::Agisoft(camera) => {
                let Agisoft { size, version, f, b1, b2, k, p: [first, second, p3, p4], .. } = camera;
                let (from, p1, p2) = match version {
                    AgisoftVersion::Metashape => ((f64::from(size.width) / 2.0, f64::from(size.height) / 2.0), second, first),
                    AgisoftVersion::PhotoScan | AgisoftVersion::Lens => ((0.0, 0.0), first, second),
                };
                let PixelPoint { x: cx, y: cy } = CornerPoint { x: from.0 + camera.cx, y: from.1 + camera.cy }.to_pixel();
                (p3 == 0.0 && p4 == 0.0).then_some(Self { size, fx: f + b1, fy: f, skew: b2, cx, cy, k, p1, p2 })
            }
            Camera::Pix4d(Pix4d { size, f_px, px, py, r: [k1, k2, k3], t, order, .. }) => {
                let PixelPoint { x: cx, y: cy } = CornerPoint { x: px, y: py }.to_pixel();
                let [p1, p2] = if order == TangentialOrder::OpenCv { t } else { [t[1], t[0]] };
                Some(Self { size, fx: f_px, fy: f_px, skew: 0.0, cx, cy, k: [k1, k2, k3, 0.0], p1, p2 })
            }
            _ => None,
        }
    }

    /// How many radial coefficients there are, without zeros at the end.
    pub fn radial(&self) -> usize {
        self.k.iter().rposition(|&k| k != 0.0).map_or(0, |last| last + 1)
    }

    pub fn has_tangential(&self) -> bool {
        self.p1 != 0.0 || self.p2 != 0.0
    }

    pub fn has_one_focal(&self) -> bool {
        self.fx == self.fy
    }

    /// The principal point from the corner of the first pixel.
    pub fn corner(&self) -> CornerPoint {
        PixelPoint::new(self.cx, self.cy).to_corner()
    }
}

/// The middle of the frame.
pub(super) fn middle(size: ImageSize) -> PixelPoint {
    CornerPoint { x: f64::from(size.width) / 2.0, y: f64::from(size.height) / 2.0 }.to_pixel()
}

/// A focal length above zero.
pub(super) fn positive(name: &str, value: f64) -> Result<f64, CameraFileError> {
    if value > 0.0 { Ok(value) } else { Err(CameraFileError::new(format!("expected a number above zero, found {value}")).of(name)) }
}
