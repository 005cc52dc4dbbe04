//! What the wide-angle cameras have in common: a radius of the angle from the axis, terms of the plane, then focal lengths and principal point.

use super::newton::{ValueAndDerivatives, determinant};
use super::plane_map::{PlaneMap, first_fold, invert, is_on_branch};
use super::{CameraParameter, DerivativeBuffer, ImageSize, NoCounterpart, Ray, Turn, named};
use crate::PixelPoint;

/// Halvings that find an angle; Newton's steps end them sooner.
const MOST_STEPS: usize = 120;
/// Places on a way across the frame where a fold is looked for.
const PLACES: usize = 400;

/// fx, fy, cx, cy: px, from the centre of the first pixel, y down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Focal {
    pub(super) size: ImageSize,
    pub(super) fx: f64,
    pub(super) fy: f64,
    pub(super) cx: f64,
    pub(super) cy: f64,
}

/// A camera around an axis.
pub(super) trait Axial {
    /// Size, focal lengths and principal point.
    fn focal(&self) -> Focal;
    /// The normalised radius of an angle from the axis, and its derivative; not numbers beyond a pole.
    fn radius(&self, theta: f64) -> (f64, f64);
    /// The angle to which the radius rises: a pole, a turning point, or 180 degrees.
    fn end(&self) -> f64;
    /// d(radius) / d(lens parameter).
    fn by_lens(&self, theta: f64) -> Vec<f64>;
    /// Terms of the plane.
    fn plane(&self) -> Option<Plane> {
        None
    }
    /// Which of the plane's coefficients are parameters of the model, in its order: places in [`Plane::by_coefficients`].
    fn plane_parameters(&self) -> &'static [usize] {
        &[]
    }
    /// Whether the radius rises up to `theta`; models whose end is dear to find answer sooner.
    fn pictures(&self, theta: f64) -> bool {
        theta < self.end()
    }
    /// The terms of the plane in turned axes; what depends on the angle alone stays.
    fn with_turned_plane(self, turn: Turn) -> Self
    where
        Self: Sized,
    {
        let _ = turn;
        self
    }
}

/// `x q + 2 p1 x y + p2 (r2 + 2 x^2) + s1 r2 + s3 r2^2`, `y q + p1 (r2 + 2 y^2) + 2 p2 x y + s2 r2 + s4 r2^2` with `q = 1 + k1 r2 + ... + k6 r2^6`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plane {
    pub(super) k: [f64; 6],
    /// In OpenCV's order.
    pub(super) p: [f64; 2],
    /// s1, s2.
    pub(super) s: [f64; 2],
    /// s3, s4.
    pub(super) s4: [f64; 2],
}

impl Plane {
    /// d(value) / d(k1, k2, p1, p2, k3, k4, s1, s2, s3, s4, k5, k6).
    fn by_coefficients([x, y]: [f64; 2]) -> [[f64; 2]; 12] {
        let r2 = x * x + y * y;
        let radial = |power: i32| [x * r2.powi(power), y * r2.powi(power)];
        let tangential = [[2.0 * x * y, r2 + 2.0 * y * y], [r2 + 2.0 * x * x, 2.0 * x * y]];
        let prism = [[r2, 0.0], [0.0, r2], [r2 * r2, 0.0], [0.0, r2 * r2]];
        let [s1, s2, s3, s4] = prism;
        [radial(1), radial(2), tangential[0], tangential[1], radial(3), radial(4), s1, s2, s3, s4, radial(5), radial(6)]
    }
}

impl PlaneMap for Plane {
    fn map(&self, [x, y]: [f64; 2]) -> ValueAndDerivatives {
        let ([k1, k2, k3, k4, k5, k6], [p1, p2]) = (self.k, self.p);
        let r2 = x * x + y * y;
        // The prism's terms and their derivatives by r2.
        let prism: [(f64, f64); 2] = [0, 1].map(|i| (r2 * (self.s[i] + r2 * self.s4[i]), self.s[i] + 2.0 * r2 * self.s4[i]));
        let q = 1.0 + r2 * (k1 + r2 * (k2 + r2 * (k3 + r2 * (k4 + r2 * (k5 + r2 * k6)))));
        let slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * (3.0 * k3 + r2 * (4.0 * k4 + r2 * (5.0 * k5 + r2 * 6.0 * k6)))));
        let cross = x * y * slope + 2.0 * (p1 * x + p2 * y);
        let value = [
            x * q + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x) + prism[0].0,
            y * q + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y + prism[1].0,
        ];
        let by = [
            [q + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x + 2.0 * prism[0].1 * x, cross + 2.0 * prism[0].1 * y],
            [cross + 2.0 * prism[1].1 * x, q + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x + 2.0 * prism[1].1 * y],
        ];
        (value, by)
    }

    fn is_surely_one_to_one(&self, radius: f64) -> bool {
        let prism = 2.0 * radius * self.s[0].hypot(self.s[1]) + 4.0 * radius.powi(3) * self.s4[0].hypot(self.s4[1]);
        super::plane_map::is_one_to_one(radius, &self.k, &self.p, prism)
    }
}

fn pixel(focal: &Focal, [x, y]: [f64; 2]) -> PixelPoint {
    PixelPoint::new(focal.fx * x + focal.cx, focal.fy * y + focal.cy)
}

/// X, Y, Z (x right, y down, z forward), distance from the axis, angle from it, which is pictured.
fn polar(camera: &impl Axial, ray: Ray) -> Result<([f64; 3], f64, f64), NoCounterpart> {
    let [x, y, z] = [ray.x, -ray.y, -ray.z];
    let r = x.hypot(y);
    if !(r.is_finite() && z.is_finite()) || (r == 0.0 && z <= 0.0) {
        return Err(NoCounterpart::Behind);
    }
    let theta = r.atan2(z);
    if !camera.pictures(theta) {
        return Err(NoCounterpart::Behind);
    }
    Ok(([x, y, z], r, theta))
}

/// The terms of the plane at `at`, which is on their branch.
fn in_plane(camera: &impl Axial, at: [f64; 2]) -> Result<ValueAndDerivatives, NoCounterpart> {
    match camera.plane() {
        None => Ok((at, [[1.0, 0.0], [0.0, 1.0]])),
        Some(plane) if is_on_branch(&plane, at) => Ok(plane.map(at)),
        Some(_) => Err(NoCounterpart::Fold),
    }
}

pub(super) fn parameters(camera: &impl Axial, lens: &[(&'static str, &'static str)], values: &[f64]) -> Vec<CameraParameter> {
    let Focal { fx, fy, cx, cy, .. } = camera.focal();
    let mut all = named(&[("fx", "px"), ("fy", "px"), ("cx", "px"), ("cy", "px")], &[fx, fy, cx, cy]);
    all.extend(named(lens, values));
    all
}

pub(super) fn project(camera: &impl Axial, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
    let ([x, y, _], r, theta) = polar(camera, ray)?;
    let scale = if r > 0.0 { camera.radius(theta).0 / r } else { 0.0 };
    let (distorted, _) = in_plane(camera, [x * scale, y * scale])?;
    let found = pixel(&camera.focal(), distorted);
    if found.is_finite() { Ok(found) } else { Err(NoCounterpart::NoSolution) }
}

pub(super) fn unproject(camera: &impl Axial, point: PixelPoint) -> Result<Ray, NoCounterpart> {
    let focal = camera.focal();
    let distorted = [(point.x - focal.cx) / focal.fx, (point.y - focal.cy) / focal.fy];
    let [x, y] = match camera.plane() {
        None => distorted,
        Some(plane) => invert(&plane, distorted)?,
    };
    let radius = x.hypot(y);
    let (sin, cos) = angle(camera, radius)?.sin_cos();
    let scale = if radius > 0.0 { sin / radius } else { 0.0 };
    Ok(Ray { x: x * scale, y: -y * scale, z: -cos })
}

/// The angle of a radius, by Newton's method kept between bounds.
fn angle(camera: &impl Axial, radius: f64) -> Result<f64, NoCounterpart> {
    let end = camera.end();
    if !radius.is_finite() {
        return Err(NoCounterpart::NoSolution);
    }
    let widest = camera.radius(end).0;
    if widest.is_finite() && widest > 0.0 && radius >= widest {
        return Err(NoCounterpart::Fold);
    }
    let (mut low, mut high, mut theta) = (0.0, end, radius.min(0.5 * end));
    for _ in 0..MOST_STEPS {
        let (value, slope) = camera.radius(theta);
        // Beyond a pole the value is negative or none.
        if value <= radius && value >= 0.0 {
            low = theta;
        } else {
            high = theta;
        }
        let newton = theta - (value - radius) / slope;
        let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
        if (next - theta).abs() <= 1e-16 * theta {
            return Ok(next);
        }
        theta = next;
    }
    Ok(theta)
}

pub(super) fn derivatives_into(camera: &impl Axial, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
    let ([x, y, z], r, theta) = polar(camera, ray)?;
    let (radius, slope) = camera.radius(theta);
    let length2 = r * r + z * z;
    // On the axis radius / r tends to its slope / Z, and its change to nothing.
    let (scale, cos, sin) = if r > 0.0 { (radius / r, x / r, y / r) } else { (slope / z, 0.0, 0.0) };
    // d(theta)/dr = Z / (r^2 + Z^2), d(theta)/dZ = -r / (r^2 + Z^2)
    let (radial, back) = (slope * z / length2, -slope * r / length2);
    let change = radial - scale;
    let mixed = change * cos * sin;
    let at = [[scale + change * cos * cos, mixed, back * cos], [mixed, scale + change * sin * sin, back * sin]];
    let flat = [x * scale, y * scale];
    let (distorted, by) = in_plane(camera, flat)?;
    let focal = camera.focal();
    let scaled = |[dx, dy]: [f64; 2]| [focal.fx * dx, focal.fy * dy];
    let after = |[dx, dy]: [f64; 2]| scaled([by[0][0] * dx + by[0][1] * dy, by[1][0] * dx + by[1][1] * dy]);
    let columns: [[f64; 2]; 3] = std::array::from_fn(|i| after([at[0][i], at[1][i]]));
    let signs = [1.0, -1.0, -1.0];
    into.clear();
    into.point = pixel(&focal, distorted);
    into.by_ray = [0, 1].map(|row| std::array::from_fn(|i| signs[i] * columns[i][row]));
    into.extend([[distorted[0], 0.0], [0.0, distorted[1]], [1.0, 0.0], [0.0, 1.0]]);
    into.extend(camera.by_lens(theta).into_iter().map(|d| after([d * cos, d * sin])));
    let by_plane = Plane::by_coefficients(flat);
    into.extend(camera.plane_parameters().iter().map(|&i| scaled(by_plane[i])));
    Ok(())
}

pub(super) fn fold_towards(camera: &impl Axial, angle: f64) -> Option<PixelPoint> {
    let focal = camera.focal();
    let (sin, cos) = angle.sin_cos();
    let widest = Some(camera.radius(camera.end()).0).filter(|widest| widest.is_finite() && *widest > 0.0);
    let Some(plane) = camera.plane() else { return widest.map(|s| pixel(&focal, [s * cos, s * sin])) };
    // Twice as far as the farthest corner may lie.
    let reach = |length: u32, centre: f64, f: f64| (f64::from(length) + centre.abs()) / f.abs();
    let across = 2.0 * reach(focal.size.width, focal.cx, focal.fx).hypot(reach(focal.size.height, focal.cy, focal.fy));
    let limit = widest.unwrap_or(across).min(across);
    let fold = first_fold(|s| determinant(plane.map([s * cos, s * sin]).1), limit, PLACES);
    fold.or(widest).map(|s| pixel(&focal, plane.map([s * cos, s * sin]).0))
}

/// The methods of [`super::CameraModel`] and [`super::Reframe`] for a camera around an axis, whose parameters are `lens` after fx, fy, cx, cy.
macro_rules! axial_camera {
    ($model:ty, $names:expr) => {
        impl $crate::camera::CameraModel for $model {
            fn size(&self) -> $crate::camera::ImageSize {
                self.size
            }

            fn parameters(&self) -> Vec<$crate::camera::CameraParameter> {
                $crate::camera::wide_angle::parameters(self, &$names, &self.lens_values())
            }

            fn with_parameters(&self, values: &[f64]) -> Self {
                let (focal, lens) = values.split_at(4);
                Self { fx: focal[0], fy: focal[1], cx: focal[2], cy: focal[3], ..self.with_lens(lens) }
            }

            fn project(&self, ray: $crate::camera::Ray) -> Result<$crate::PixelPoint, $crate::camera::NoCounterpart> {
                $crate::camera::wide_angle::project(self, ray)
            }

            fn unproject(&self, point: $crate::PixelPoint) -> Result<$crate::camera::Ray, $crate::camera::NoCounterpart> {
                $crate::camera::wide_angle::unproject(self, point)
            }

            fn derivatives_into(
                &self,
                ray: $crate::camera::Ray,
                into: &mut $crate::camera::DerivativeBuffer,
            ) -> Result<(), $crate::camera::NoCounterpart> {
                $crate::camera::wide_angle::derivatives_into(self, ray, into)
            }

            fn fold_towards(&self, angle: f64) -> Option<$crate::PixelPoint> {
                $crate::camera::wide_angle::fold_towards(self, angle)
            }
        }

        impl $crate::camera::Reframe for $model {
            fn resampled(&self, by: &$crate::camera::Resampling) -> Self {
                let (at, [fx, fy]) = (by.point($crate::PixelPoint::new(self.cx, self.cy)), by.lengths([self.fx, self.fy]));
                Self { size: by.size, fx, fy, cx: at.x, cy: at.y, ..*self }
            }

            fn turned(&self, turn: $crate::camera::Turn) -> Self {
                let (at, [fx, fy]) = (turn.point(self.size, $crate::PixelPoint::new(self.cx, self.cy)), turn.along([self.fx, self.fy]));
                Self { size: turn.size(self.size), fx, fy, cx: at.x, cy: at.y, ..self.with_turned_plane(turn) }
            }
        }
    };
}
pub(super) use axial_camera;

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Asserts that the radius rises up to the end and not beyond, and that its derivative is that of differences.
    pub(in super::super) fn rises_to_its_end(camera: &impl Axial) {
        let end = camera.end();
        // Beyond a pole the radius is negative.
        let rises = |theta: f64| if camera.radius(theta).0 < 0.0 { -1.0 } else { camera.radius(theta).1 };
        let found = first_fold(rises, std::f64::consts::PI, 5000).unwrap_or(std::f64::consts::PI);
        assert!((found - end).abs() < 1e-6, "rises to {found}, said {end}");
        for i in 1..40 {
            let theta = end * f64::from(i) / 41.0;
            let h = 1e-5;
            let difference = (camera.radius(theta + h).0 - camera.radius(theta - h).0) / (2.0 * h);
            let slope = camera.radius(theta).1;
            assert!((difference - slope).abs() < 1e-6 * slope.abs().max(1.0), "{theta}: {slope} {difference}");
        }
    }
}
