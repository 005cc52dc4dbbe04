//! OpenCV's fisheye camera: four coefficients of the angle from the axis.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::fold::corners;
use super::plane_map::{first_fold, stays_above};
use super::{CameraModel, CameraParameter, DerivativeBuffer, ImageSize, NoCounterpart, Ray, Reframe, Resampling, Turn, named};
use crate::PixelPoint;

/// OpenCV's fisheye camera, of Kannala and Brandt. Direction: **ideal to distorted**; y points down; the centre of the first pixel is (0, 0).
///
/// With `r = sqrt(X^2 + Y^2)`, the angle from the axis `theta = atan2(r, Z)` (x right, y down, z forward) and
/// `theta_d = theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)`: `x' = theta_d X / r`, `y' = theta_d Y / r`,
/// `u = fx (x' + skew y') + cx`, `v = fy y' + cy`. Rays beyond 90 degrees are pictured, where OpenCV's own functions divide by Z.
///
/// Source: OpenCV 4.6, module calib3d, "Fisheye camera model"; Kannala and Brandt 2006.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
    /// k1 to k4, numbers: coefficients of theta^3, theta^5, theta^7, theta^9 with theta in radians.
    pub k: [f64; 4],
}

/// The convention of [`OpenCvFisheye`].
pub const CONVENTION: Convention = Convention {
    name: "opencv-fisheye",
    about: "OpenCV's fisheye camera: fx, fy, cx, cy, skew, k1 to k4 of the angle",
    version: "OpenCV 3 and later",
    direction: Direction::IdealToDistorted,
    pixel_origin: PixelOrigin::PixelCentre,
    principal_point_from: PixelOrigin::PixelCentre,
    y: Vertical::Down,
    order: TangentialOrder::Without,
    normalisation: "divided by fx, fy, px; a polynomial of the angle from the axis",
    source: "OpenCV, module calib3d, Fisheye camera model; Kannala and Brandt 2006",
    verification: Verification::Verified("fisheye::projectPoints, to 1e-9"),
};

const NAMES: [(&str, &str); 9] =
    [("fx", "px"), ("fy", "px"), ("cx", "px"), ("cy", "px"), ("skew", ""), ("k1", ""), ("k2", ""), ("k3", ""), ("k4", "")];
/// Places between 0 and 180 degrees where a fold is looked for.
const PLACES: usize = 360;
/// Angles that are looked at for one that is pictured farther out than a distance, times that distance.
const AHEAD: [f64; 4] = [1.1, 1.25, 1.5, 2.0];
/// Halvings that find an angle; Newton's steps end them sooner.
const MOST_STEPS: usize = 100;

impl OpenCvFisheye {
    /// theta_d of theta, and its derivative.
    fn distort(&self, theta: f64) -> (f64, f64) {
        let [k1, k2, k3, k4] = self.k;
        let t2 = theta * theta;
        let value = theta * (1.0 + t2 * (k1 + t2 * (k2 + t2 * (k3 + t2 * k4))));
        (value, 1.0 + t2 * (3.0 * k1 + t2 * (5.0 * k2 + t2 * (7.0 * k3 + t2 * 9.0 * k4))))
    }

    /// The angle at which the polynomial first turns round.
    fn turning(&self) -> Option<f64> {
        first_fold(|theta| self.distort(theta).1, std::f64::consts::PI, PLACES)
    }

    /// The angle of `distorted`, by Newton's method kept between bounds.
    fn angle(&self, distorted: f64) -> Result<f64, NoCounterpart> {
        if !distorted.is_finite() {
            return Err(NoCounterpart::NoSolution);
        }
        let end = self.reaching(distorted).or_else(|| self.turning()).unwrap_or(std::f64::consts::PI);
        if distorted > self.distort(end).0 {
            return Err(if end < std::f64::consts::PI { NoCounterpart::Fold } else { NoCounterpart::NoSolution });
        }
        let (mut low, mut high, mut theta) = (0.0, end, distorted.min(end));
        for _ in 0..MOST_STEPS {
            let (value, slope) = self.distort(theta);
            if value > distorted {
                high = theta;
            } else {
                low = theta;
            }
            let newton = theta - (value - distorted) / slope;
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - theta).abs() <= 1e-16 * theta {
                return Ok(next);
            }
            theta = next;
        }
        Ok(theta)
    }

    fn pixel(&self, [x, y]: [f64; 2]) -> PixelPoint {
        PixelPoint::new(self.fx * (x + self.skew * y) + self.cx, self.fy * y + self.cy)
    }

    /// X, Y, Z of OpenCV, distance from the axis, angle from it.
    fn polar(&self, ray: Ray) -> Result<([f64; 3], f64, f64), NoCounterpart> {
        let [x, y, z] = [ray.x, -ray.y, -ray.z];
        let r = x.hypot(y);
        if !(r.is_finite() && z.is_finite()) || (r == 0.0 && z <= 0.0) {
            return Err(NoCounterpart::Behind);
        }
        let theta = r.atan2(z);
        if !self.is_surely_rising(theta) && self.turning().is_some_and(|end| theta > end) {
            return Err(NoCounterpart::Fold);
        }
        Ok(([x, y, z], r, theta))
    }

    /// An angle up to which the polynomial surely rises, and to no less than `distorted`, if one of [`AHEAD`] is: it spares the search for the turning point.
    fn reaching(&self, distorted: f64) -> Option<f64> {
        let angles = AHEAD.map(|ahead| ahead * distorted).into_iter().filter(|theta| *theta <= std::f64::consts::PI);
        angles.into_iter().find(|theta| self.distort(*theta).0 >= distorted).filter(|theta| self.is_surely_rising(*theta))
    }

    /// Whether the polynomial surely rises up to an angle.
    fn is_surely_rising(&self, theta: f64) -> bool {
        stays_above(0.0, theta * theta, &self.k, |i| (2 * i + 3) as f64)
    }
}

impl CameraModel for OpenCvFisheye {
    fn size(&self) -> ImageSize {
        self.size
    }

    fn parameters(&self) -> Vec<CameraParameter> {
        let [k1, k2, k3, k4] = self.k;
        named(&NAMES, &[self.fx, self.fy, self.cx, self.cy, self.skew, k1, k2, k3, k4])
    }

    fn with_parameters(&self, v: &[f64]) -> Self {
        Self { fx: v[0], fy: v[1], cx: v[2], cy: v[3], skew: v[4], k: [v[5], v[6], v[7], v[8]], ..*self }
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        let ([x, y, _], r, theta) = self.polar(ray)?;
        let scale = if r > 0.0 { self.distort(theta).0 / r } else { 0.0 };
        Ok(self.pixel([x * scale, y * scale]))
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        let y = (point.y - self.cy) / self.fy;
        let x = (point.x - self.cx) / self.fx - self.skew * y;
        let distorted = x.hypot(y);
        let (sin, cos) = self.angle(distorted)?.sin_cos();
        let scale = if distorted > 0.0 { sin / distorted } else { 0.0 };
        Ok(Ray { x: x * scale, y: -y * scale, z: -cos })
    }

    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
        let ([x, y, z], r, theta) = self.polar(ray)?;
        let (distorted, slope) = self.distort(theta);
        let length2 = r * r + z * z;
        // On the axis theta_d / r tends to 1 / Z, and its change to nothing.
        let (scale, cos, sin) = if r > 0.0 { (distorted / r, x / r, y / r) } else { (1.0 / z, 0.0, 0.0) };
        // d(theta)/dr = Z / (r^2 + Z^2), d(theta)/dZ = -r / (r^2 + Z^2)
        let (radial, back) = (slope * z / length2, -slope * r / length2);
        let change = radial - scale;
        let at =
            [[scale + change * cos * cos, change * cos * sin, back * cos], [change * cos * sin, scale + change * sin * sin, back * sin]];
        let signs = [1.0, -1.0, -1.0];
        into.by_ray = [
            std::array::from_fn(|i| self.fx * (at[0][i] + self.skew * at[1][i]) * signs[i]),
            std::array::from_fn(|i| self.fy * at[1][i] * signs[i]),
        ];
        let [dx, dy] = [x * scale, y * scale];
        into.point = self.pixel([dx, dy]);
        into.clear();
        into.extend([[dx + self.skew * dy, 0.0], [0.0, dy], [1.0, 0.0], [0.0, 1.0], [self.fx * dy, 0.0]]);
        into.extend((1..=4).map(|power| {
            let d = theta.powi(2 * power + 1);
            [self.fx * d * (cos + self.skew * sin), self.fy * d * sin]
        }));
        Ok(())
    }

    fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
        let distorted = self.distort(self.turning()?).0;
        let (sin, cos) = angle.sin_cos();
        Some(self.pixel([distorted * cos, distorted * sin]))
    }

    fn has_surely_no_fold(&self) -> bool {
        let distorted = |corner: PixelPoint| {
            let y = (corner.y - self.cy) / self.fy;
            ((corner.x - self.cx) / self.fx - self.skew * y).hypot(y)
        };
        let farthest = corners(self.size).map(distorted).into_iter().fold(0.0, f64::max);
        self.reaching(farthest).is_some()
    }
}

impl Reframe for OpenCvFisheye {
    fn resampled(&self, by: &Resampling) -> Self {
        let (at, [fx, fy]) = (by.point(PixelPoint::new(self.cx, self.cy)), by.lengths([self.fx, self.fy]));
        Self { size: by.size, fx, fy, cx: at.x, cy: at.y, ..*self }
    }

    fn without_place(&self, turn: Turn) -> Option<&'static str> {
        (turn.swaps_axes() && self.skew != 0.0).then_some("skew")
    }

    fn turned(&self, turn: Turn) -> Self {
        let (at, [fx, fy]) = (turn.point(self.size, PixelPoint::new(self.cx, self.cy)), turn.along([self.fx, self.fy]));
        Self { size: turn.size(self.size), fx, fy, cx: at.x, cy: at.y, ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::fold;

    fn camera() -> OpenCvFisheye {
        let size = ImageSize { width: 1600, height: 1200 };
        OpenCvFisheye { size, fx: 520.0, fy: 521.0, cx: 803.2, cy: 598.7, skew: 0.001, k: [-0.02, 0.006, -0.004, 0.0005] }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
    }

    #[test]
    fn rays_beyond_ninety_degrees_come_back() {
        let ray = Ray { x: 1.0, y: -0.4, z: 0.3 };
        let camera = OpenCvFisheye { k: [0.01, 0.0, 0.0, 0.0], ..camera() };
        let pixel = camera.project(ray).unwrap();
        assert!(camera.unproject(pixel).unwrap().angle_to(ray) < 1e-14);
        assert_eq!(camera.project(Ray { x: 0.0, y: 0.0, z: 1.0 }), Err(NoCounterpart::Behind));
    }

    /// What spares the search for the turning point never leads beyond it.
    #[test]
    fn what_surely_rises_does_not_turn_before() {
        let (mut spared, steps) = (0, [-0.4, -0.1, 0.0, 0.05, 0.3]);
        for place in 0..625 {
            let k = [place % 5, place / 5 % 5, place / 25 % 5, place / 125].map(|step: usize| steps[step]);
            let camera = OpenCvFisheye { k, ..camera() };
            let end = camera.turning().unwrap_or(std::f64::consts::PI);
            for distorted in [0.05, 0.3, 0.6, 0.9, 1.4] {
                let Some(reached) = camera.reaching(distorted) else { continue };
                spared += 1;
                assert!(reached <= end, "{k:?} turns at {end}, not at {reached}");
                assert!(camera.distort(end).0 >= distorted, "{k:?} turns at {end}");
                let theta = camera.angle(distorted).unwrap();
                assert!(theta <= end && (camera.distort(theta).0 - distorted).abs() < 1e-15, "{k:?} {distorted}: {theta}");
            }
        }
        assert!(spared > 2000, "{spared} of 3125");
    }

    #[test]
    fn folds_are_located() {
        // theta (1 - 0.3 theta^2) turns round at theta = 1.054, theta_d = 0.703.
        let camera = OpenCvFisheye { k: [-0.3, 0.0, 0.0, 0.0], fy: 520.0, skew: 0.0, ..camera() };
        let theta = 1.0 / 0.9_f64.sqrt();
        let found = fold(&camera).unwrap();
        assert!((found.radius_px - 520.0 * theta * 2.0 / 3.0).abs() < 1e-9, "{found:?}");
        assert_eq!(camera.project(Ray { x: 1.1_f64.sin(), y: 0.0, z: -1.1_f64.cos() }), Err(NoCounterpart::Fold));
    }
}
