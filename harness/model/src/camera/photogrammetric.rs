//! The canonical interior orientation: photogrammetric, a correction of measured coordinates.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::measured_to_ideal::{Correction, measured_camera};
use super::newton::ValueAndDerivatives;
use super::plane_map::{PlaneMap, is_one_to_one, radial_start};
use super::{CameraParameter, DerivativeBuffer, ImageSize, Reframe, Resampling, Turn, named};
use crate::{Frame, SensorPoint};

/// Interior orientation in mm, y up, from the centre of the frame. Direction: **measured to ideal**.
///
/// With `xb = x' - x0`, `yb = y' - y0`, `r2 = xb^2 + yb^2` the ideal coordinates are
/// `x = xb - [xb (k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 xb^2) + 2 p2 xb yb + b1 xb + b2 yb]`,
/// `y = yb - [yb (k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 xb yb + p2 (r2 + 2 yb^2)]`.
///
/// Source: Brown 1971; Fraser 1997 for `b1`, `b2`; Galo et al. 2011, Eq. 8 and 9.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Photogrammetric {
    /// Size of its images.
    pub size: ImageSize,
    /// Pixel pitch, um.
    pub pitch_um: f64,
    /// Principal distance, mm.
    pub c: f64,
    /// Principal point, x, mm from the centre of the frame.
    pub x0: f64,
    /// Principal point, y, mm upwards from the centre of the frame.
    pub y0: f64,
    /// Radial distortion k1 (mm^-2), k2 (mm^-4), k3 (mm^-6).
    pub k: [f64; 3],
    /// Decentring distortion p1, p2 (mm^-1), in Brown's order: p1 multiplies r^2 + 2 x^2.
    pub p: [f64; 2],
    /// Difference of scale b1 and shear b2, numbers.
    pub b: [f64; 2],
}

const NAMES: [(&str, &str); 10] = [
    ("c", "mm"),
    ("x0", "mm"),
    ("y0", "mm"),
    ("k1", "mm^-2"),
    ("k2", "mm^-4"),
    ("k3", "mm^-6"),
    ("p1", "mm^-1"),
    ("p2", "mm^-1"),
    ("b1", ""),
    ("b2", ""),
];

/// The convention of [`Photogrammetric`].
pub const CONVENTION: Convention = Convention {
    name: "photogrammetric",
    about: "canonical: correction of measured coordinates, mm, k1 to k3, p1, p2, b1, b2",
    version: "",
    direction: Direction::MeasuredToIdeal,
    pixel_origin: PixelOrigin::PixelCentre,
    principal_point_from: PixelOrigin::FrameCentre,
    y: Vertical::Up,
    order: TangentialOrder::Brown,
    normalisation: "none: mm from the principal point",
    source: "Brown 1971; Fraser 1997; Galo et al. 2011, Eq. 8 and 9",
    verification: Verification::Definition,
};

impl Photogrammetric {
    /// The ideal place of a measured one, both mm from the principal point: by formula alone, where the camera folds over too.
    ///
    /// Source: Brown 1971.
    pub fn corrected(&self, measured: [f64; 2]) -> [f64; 2] {
        self.map(measured).0
    }
}

impl PlaneMap for Photogrammetric {
    fn map(&self, [x, y]: [f64; 2]) -> ValueAndDerivatives {
        let [k1, k2, k3] = self.k;
        let [p1, p2] = self.p;
        let [b1, b2] = self.b;
        let r2 = x * x + y * y;
        let radial = r2 * (k1 + r2 * (k2 + r2 * k3));
        // d(radial)/d(r2)
        let slope = k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3);
        let value = [
            x - (x * radial + p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y + b1 * x + b2 * y),
            y - (y * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * y * y)),
        ];
        let cross = 2.0 * x * y * slope + 2.0 * p1 * y + 2.0 * p2 * x;
        let by = [
            [1.0 - (radial + 2.0 * x * x * slope + 6.0 * p1 * x + 2.0 * p2 * y + b1), -(cross + b2)],
            [-cross, 1.0 - (radial + 2.0 * y * y * slope + 2.0 * p1 * x + 6.0 * p2 * y)],
        ];
        (value, by)
    }

    fn start(&self, goal: [f64; 2]) -> Option<[f64; 2]> {
        radial_start(&self.k.map(|k| -k), goal)
    }

    fn is_surely_one_to_one(&self, radius: f64) -> bool {
        is_one_to_one(radius, &self.k.map(|k| -k), &self.p, self.b[0].abs() + self.b[1].abs())
    }
}

impl Correction for Photogrammetric {
    fn base(&self) -> &Photogrammetric {
        self
    }

    fn by_coefficients(&self, [x, y]: [f64; 2], into: &mut DerivativeBuffer) {
        let r2 = x * x + y * y;
        let radial = |power: f64| [-x * power, -y * power];
        into.extend([
            radial(r2),
            radial(r2 * r2),
            radial(r2 * r2 * r2),
            [-(r2 + 2.0 * x * x), -2.0 * x * y],
            [-2.0 * x * y, -(r2 + 2.0 * y * y)],
            [-x, 0.0],
            [-y, 0.0],
        ]);
    }
}

impl Photogrammetric {
    fn named_parameters(&self) -> Vec<CameraParameter> {
        let [k1, k2, k3] = self.k;
        let values = [self.c, self.x0, self.y0, k1, k2, k3, self.p[0], self.p[1], self.b[0], self.b[1]];
        named(&NAMES, &values)
    }

    fn with_values(&self, values: &[f64]) -> Self {
        let v = |i: usize| values[i];
        Self { c: v(0), x0: v(1), y0: v(2), k: [v(3), v(4), v(5)], p: [v(6), v(7)], b: [v(8), v(9)], ..*self }
    }
}

measured_camera!(Photogrammetric);

impl Reframe for Photogrammetric {
    fn has_two_scales(&self) -> bool {
        false
    }

    /// The pixels become larger or smaller, and mm stay what they are; the principal point is counted from the middle of the new frame.
    fn resampled(&self, by: &Resampling) -> Self {
        let pitch_um = self.pitch_um / by.scale[0];
        let frame = |size: ImageSize, pitch_um| Frame::new(size.width, size.height, pitch_um);
        // A camera whose pixels have no size pictures nothing, in any images.
        let (Ok(before), Ok(after)) = (frame(self.size, self.pitch_um), frame(by.size, pitch_um)) else {
            return Self { size: by.size, pitch_um, ..*self };
        };
        let at = after.to_sensor(by.point(before.to_pixel(SensorPoint { x: self.x0, y: self.y0 })));
        Self { size: by.size, pitch_um, x0: at.x, y0: at.y, ..*self }
    }

    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        (turn.swaps_axes() && self.b[1] != 0.0).then_some("b2")
    }

    /// b1 corrects x: where y becomes x, all ideal coordinates are divided by 1 - b1 instead, which are the same rays.
    fn turned(&self, turn: Turn) -> Self {
        let ([x0, y0], p) = (turn.vector_up([self.x0, self.y0]), turn.vector_up(self.p));
        let s = if turn.swaps_axes() { 1.0 / (1.0 - self.b[0]) } else { 1.0 };
        let b1 = if turn.swaps_axes() { 1.0 - s } else { self.b[0] };
        let (k, p) = (self.k.map(|k| s * k), p.map(|p| s * p));
        Self { size: turn.size(self.size), c: s * self.c, x0, y0, k, p, b: [b1, self.b[1]], ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PixelPoint;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::fold;
    use crate::camera::{CameraModel, NoCounterpart, Ray};

    fn camera() -> Photogrammetric {
        let size = ImageSize { width: 4272, height: 2848 };
        let (k, p, b) = ([-4.61e-4, 1.2e-6, -4e-10], [0.86e-4, -0.3e-4], [1e-4, -2e-4]);
        Photogrammetric { size, pitch_um: 5.15, c: 19.213, x0: 0.042, y0: -0.134, k, p, b }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
    }

    #[test]
    fn the_inverse_starts_nearer_than_where_it_goes() {
        for goal in [[9.0, 6.0], [-3.0, 5.0], [0.0, -7.0]] {
            let away = |at: [f64; 2]| {
                let [x, y] = camera().corrected(at);
                (x - goal[0]).hypot(y - goal[1])
            };
            let start = camera().start(goal).unwrap();
            assert!(away(start) < 0.1 * away(goal), "{goal:?}: {start:?}");
        }
    }

    #[test]
    fn a_correction_is_subtracted_from_what_was_measured() {
        // 1000 px right of the centre: x' = 5.15 mm, corrected by -k1 r^3 outwards.
        let camera = Photogrammetric { k: [-4.61e-4, 0.0, 0.0], p: [0.0; 2], b: [0.0; 2], x0: 0.0, y0: 0.0, ..camera() };
        let ray = camera.unproject(PixelPoint::new(2135.5 + 1000.0, 1423.5)).unwrap();
        let expected = (5.15 + 4.61e-4 * 5.15_f64.powi(3)) / 19.213;
        assert!((ray.tangent().unwrap().0 - expected).abs() < 1e-15);
    }

    #[test]
    fn a_fold_is_not_crossed() {
        // r (1 - k1 r^2) turns round at r = 1 / sqrt(3 k1) = 5.8 mm.
        let camera = Photogrammetric { k: [0.01, 0.0, 0.0], p: [0.0; 2], b: [0.0; 2], x0: 0.0, y0: 0.0, ..camera() };
        assert_eq!(camera.unproject(PixelPoint::new(0.0, 1423.5)), Err(NoCounterpart::Fold));
        assert_eq!(camera.project(Ray::from_tangent(0.5, 0.0)), Err(NoCounterpart::Fold));
        assert_eq!(camera.slopes(Ray::from_tangent(0.5, 0.0)), Err(NoCounterpart::Fold));
        assert!(camera.project(Ray::from_tangent(0.1, 0.0)).is_ok());
        assert_eq!(camera.project(Ray { x: 0.0, y: 0.0, z: 1.0 }), Err(NoCounterpart::Behind));
    }

    #[test]
    fn folds_are_located() {
        let camera = Photogrammetric { k: [0.01, 0.0, 0.0], p: [0.0; 2], b: [0.0; 2], x0: 0.0, y0: 0.0, ..camera() };
        let found = fold(&camera).unwrap();
        let radius = 1.0 / 0.03_f64.sqrt() / 5.15e-3;
        assert!((found.radius_px - radius).abs() < 1e-6, "{found:?} {radius}");
        let share = 1.0 - std::f64::consts::PI * radius * radius / (4272.0 * 2848.0);
        assert!((found.share - share).abs() < 0.01, "{found:?} {share}");
        assert_eq!(fold(&self::camera()), None);
    }
}
