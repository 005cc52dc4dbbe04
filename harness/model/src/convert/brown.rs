//! Brown's polynomial on normalised coordinates, without the signs, origins and units of any tool.

use super::{ConvertError, Target};
use crate::camera::{Agisoft, AgisoftVersion, Camera, CameraModel, ImageSize, MicMac, OpenCv, Ray, TangentialOrder};
use crate::{CornerPoint, Frame, PixelPoint, SensorPoint};

/// What OpenCV's camera up to five coefficients, Agisoft's, Pix4D's and MicMac's have in common: ideal to distorted, y down, pixels from the centre of the first one,
/// `u = a x' + b y' + centre.x`, `v = d y' + centre.y`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BrownForm {
    pub(super) size: ImageSize,
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) d: f64,
    pub(super) centre: PixelPoint,
    /// Coefficients of r^2, r^4, r^6, r^8.
    pub(super) k: [f64; 4],
    /// In Brown's order, then Metashape's p3, p4.
    pub(super) p: [f64; 4],
}

/// The two coefficients in the other order.
fn ordered(order: TangentialOrder, [first, second]: [f64; 2]) -> [f64; 2] {
    if order == TangentialOrder::OpenCv { [second, first] } else { [first, second] }
}

/// Agisoft's order, and whether its principal point counts from the centre of the frame.
fn agisoft(version: AgisoftVersion) -> (TangentialOrder, bool) {
    match version {
        AgisoftVersion::Metashape => (TangentialOrder::Brown, true),
        AgisoftVersion::PhotoScan | AgisoftVersion::Lens => (TangentialOrder::OpenCv, false),
    }
}

/// The middle of the frame from the corner of the first pixel.
fn middle(size: ImageSize) -> (f64, f64) {
    (f64::from(size.width) / 2.0, f64::from(size.height) / 2.0)
}

/// A frame whose pitch was checked.
pub(super) fn frame(size: ImageSize, pitch_um: f64) -> Result<Frame, ConvertError> {
    Frame::new(size.width, size.height, pitch_um).map_err(|_| ConvertError::Target { fault: "a frame of no size" })
}

impl BrownForm {
    /// The form of a camera, `None` where the model has no such terms at all. What the form cannot hold is left out: see [`Self::holds`].
    pub(super) fn of(camera: &Camera) -> Option<Self> {
        match camera {
            Camera::OpenCv(camera) => Some(Self::of_opencv(camera)),
            Camera::Agisoft(camera) => Some(Self::of_agisoft(camera)),
            Camera::Pix4d(camera) => {
                let [r1, r2, r3] = camera.r;
                let [p1, p2] = ordered(camera.order, camera.t);
                let centre = CornerPoint { x: camera.px, y: camera.py }.to_pixel();
                let (k, p) = ([r1, r2, r3, 0.0], [p1, p2, 0.0, 0.0]);
                Some(Self { size: camera.size, a: camera.f_px, b: 0.0, d: camera.f_px, centre, k, p })
            }
            Camera::MicMac(camera) => Some(Self::of_micmac(camera)),
            _ => None,
        }
    }

    /// px^-2 and px^-1 become numbers by the focal length; what is around another centre, k5, b1 and b2 are left out.
    fn of_micmac(camera: &MicMac) -> Self {
        let f = camera.f;
        let k = std::array::from_fn(|i| camera.k[i] * f.powi(2 * i as i32 + 2));
        let (centre, p) = (PixelPoint::new(camera.pp[0], camera.pp[1]), [camera.p[0] * f, camera.p[1] * f, 0.0, 0.0]);
        Self { size: camera.size, a: f, b: 0.0, d: f, centre, k, p }
    }

    fn of_opencv(camera: &OpenCv) -> Self {
        let [k1, k2, p1, p2, k3, ..] = camera.distortion;
        let [p1, p2] = ordered(TangentialOrder::OpenCv, [p1, p2]);
        let centre = PixelPoint::new(camera.cx, camera.cy);
        Self { size: camera.size, a: camera.fx, b: 0.0, d: camera.fy, centre, k: [k1, k2, k3, 0.0], p: [p1, p2, 0.0, 0.0] }
    }

    fn of_agisoft(camera: &Agisoft) -> Self {
        let (order, from_middle) = agisoft(camera.version);
        let [first, second, p3, p4] = camera.p;
        let [p1, p2] = ordered(order, [first, second]);
        let (x, y) = if from_middle { middle(camera.size) } else { (0.0, 0.0) };
        let centre = CornerPoint { x: x + camera.cx, y: y + camera.cy }.to_pixel();
        Self { size: camera.size, a: camera.f + camera.b1, b: camera.b2, d: camera.f, centre, k: camera.k, p: [p1, p2, p3, p4] }
    }

    /// The linear part of any camera at its axis.
    pub(super) fn at_axis(camera: &dyn CameraModel) -> Result<Self, ConvertError> {
        let [[a, by_y, _], [_, d, _]] = camera.derivatives(Ray::from_tangent(0.0, 0.0))?.by_ray;
        let centre = super::grid::axis(camera)?;
        Ok(Self { size: camera.size(), a, b: -by_y, d: -d, centre, k: [0.0; 4], p: [0.0; 4] })
    }

    /// Whether the form holds every term of `camera`.
    pub(super) fn holds(camera: &Camera) -> bool {
        match camera {
            Camera::OpenCv(camera) => camera.distortion[5..].iter().all(|&value| value == 0.0),
            Camera::Agisoft(_) | Camera::Pix4d(_) => true,
            Camera::MicMac(camera) => camera.offset == [0.0; 2] && camera.b == [0.0; 2] && camera.k[4] == 0.0,
            _ => false,
        }
    }

    pub(super) fn is_without_distortion(&self) -> bool {
        self.k == [0.0; 4] && self.p == [0.0; 4]
    }

    /// The camera of the target's convention, without what that cannot hold: of pairs of equal things the mean, of missing terms nothing. `None`
    /// where the convention holds no Brown polynomial of this direction, but for a camera without distortion.
    pub(super) fn to_target(self, target: &Target) -> Option<Camera> {
        let mut camera = target.blank(self.size);
        match &mut camera {
            Camera::OpenCv(camera) => {
                let [p1, p2] = ordered(TangentialOrder::OpenCv, [self.p[0], self.p[1]]);
                camera.distortion[..5].copy_from_slice(&[self.k[0], self.k[1], p1, p2, self.k[2]]);
                camera.distortion[camera.coefficients..].fill(0.0);
                (camera.fx, camera.fy, camera.cx, camera.cy) = (self.a, self.d, self.centre.x, self.centre.y);
            }
            Camera::Agisoft(camera) => self.to_agisoft(camera),
            Camera::Pix4d(camera) => {
                let corner = self.centre.to_corner();
                (camera.px, camera.py) = (corner.x, corner.y);
                camera.f_px = if self.a == self.d { self.a } else { 0.5 * (self.a + self.d) };
                camera.r.copy_from_slice(&self.k[..3]);
                camera.t = ordered(camera.order, [self.p[0], self.p[1]]);
            }
            Camera::Photogrammetric(camera) if self.is_without_distortion() => self.to_pinhole(camera)?,
            Camera::Ebner(camera) if self.is_without_distortion() => {
                self.to_pinhole(&mut camera.base)?;
                camera.base.b = [0.0; 2];
            }
            Camera::OpenCvFisheye(camera) if self.is_without_distortion() => {
                (camera.fx, camera.fy, camera.cx, camera.cy) = (self.a, self.d, self.centre.x, self.centre.y);
            }
            Camera::MicMac(camera) => self.to_micmac(camera),
            Camera::Omni(camera) => {
                (camera.fx, camera.fy, camera.cx, camera.cy) = (self.a, self.d, self.centre.x, self.centre.y);
                (camera.k, camera.p) = ([self.k[0], self.k[1]], [self.p[1], self.p[0]]);
            }
            _ => return None,
        }
        Some(without_left_out(camera, target))
    }

    fn to_micmac(self, camera: &mut MicMac) {
        let f = if self.a == self.d { self.a } else { 0.5 * (self.a + self.d) };
        (camera.f, camera.pp) = (f, [self.centre.x, self.centre.y]);
        for (i, k) in self.k.iter().enumerate() {
            camera.k[i] = k / f.powi(2 * i as i32 + 2);
        }
        camera.p = [self.p[0] / f, self.p[1] / f];
    }

    fn to_agisoft(self, camera: &mut Agisoft) {
        let (order, from_middle) = agisoft(camera.version);
        let (corner, (x, y)) = (self.centre.to_corner(), if from_middle { middle(self.size) } else { (0.0, 0.0) });
        (camera.cx, camera.cy) = (corner.x - x, corner.y - y);
        (camera.f, camera.b1, camera.b2) = (self.d, self.a - self.d, self.b);
        let [first, second] = ordered(order, [self.p[0], self.p[1]]);
        (camera.k, camera.p) = (self.k, [first, second, self.p[2], self.p[3]]);
    }

    /// Without distortion `xb (1 - b1) - b2 yb = c x`, `yb = c y`: linear, so that it can be turned round.
    fn to_pinhole(self, camera: &mut crate::camera::Photogrammetric) -> Option<()> {
        let at = frame(self.size, camera.pitch_um).ok()?.to_sensor(self.centre);
        (camera.x0, camera.y0) = (at.x, at.y);
        camera.c = self.d * camera.pitch_um * 1e-3;
        camera.b = [1.0 - self.d / self.a, -self.b / self.a];
        Some(())
    }

    /// The form of a photogrammetric camera without distortion but for b1 and b2.
    pub(super) fn of_pinhole(camera: &crate::camera::Photogrammetric) -> Option<Self> {
        let centre = frame(camera.size, camera.pitch_um).ok()?.to_pixel(SensorPoint { x: camera.x0, y: camera.y0 });
        let d = camera.c * 1e3 / camera.pitch_um;
        let a = d / (1.0 - camera.b[0]);
        Some(Self { size: camera.size, a, b: -camera.b[1] * a, d, centre, k: [0.0; 4], p: [0.0; 4] })
    }
}

/// `camera` with zeros for what the target's shape leaves out.
pub(super) fn without_left_out(camera: Camera, target: &Target) -> Camera {
    let free = target.free(&camera);
    let values: Vec<f64> = camera.parameters().iter().enumerate().map(|(i, p)| if free.contains(&i) { p.value } else { 0.0 }).collect();
    camera.with_parameters(&values)
}
