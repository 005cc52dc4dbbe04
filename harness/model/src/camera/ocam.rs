//! Scaramuzza's omnidirectional camera: a polynomial of the distance from the centre says how far a pixel's ray leans.

use serde::{Deserialize, Serialize};

use super::convention::{Convention, Direction, PixelOrigin, TangentialOrder, Verification, Vertical};
use super::plane_map::first_fold;
use super::{CameraModel, CameraParameter, DerivativeBuffer, ImageSize, NoCounterpart, Ray, Reframe, Resampling, Turn, named};
use crate::PixelPoint;

/// Coefficients of the polynomial.
const TERMS: usize = 7;
/// Halvings that find a distance; Newton's steps end them sooner.
const MOST_STEPS: usize = 200;
/// Places on a way over the frame where the angle may stop rising.
const PLACES: usize = 400;
/// How many times the frame's extent the model is followed.
const REACH: f64 = 3.0;

/// Scaramuzza's omnidirectional camera. Direction: **measured to ideal**; the centre of the first pixel is (0, 0).
///
/// With x along the row and y down: `u = cx + x + e y`, `v = cy + d x + c y`, `rho = sqrt(x^2 + y^2)`. The ray of the pixel is `(x, -y, a0 + a1 rho + ... + a6 rho^6)` in
/// the axes of a [`Ray`], which looks along its -z: a0 is below zero. The toolbox counts rows first and its axes are (down, right, backwards), with the same numbers.
///
/// Source: Scaramuzza, Martinelli and Siegwart 2006, "A Toolbox for Easily Calibrating Omnidirectional Cameras", Eqs. 1 to 4.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ocam {
    /// Size of its images.
    pub size: ImageSize,
    /// Centre, x, px; the toolbox's `yc`.
    pub cx: f64,
    /// Centre, y, px downwards; the toolbox's `xc`.
    pub cy: f64,
    /// Rows by columns: a number near 1.
    pub c: f64,
    /// Share of x in the row.
    pub d: f64,
    /// Share of y in the column.
    pub e: f64,
    /// a0 to a6: px, a number, then px^-1 to px^-5; a1 is zero in the toolbox.
    pub a: [f64; TERMS],
}

/// The convention of [`Ocam`].
pub const CONVENTION: Convention = Convention {
    name: "ocam",
    about: "OCamCalib: centre, c, d, e, polynomial a0 to a6 of the distance from the centre",
    version: "OCamCalib toolbox 3",
    direction: Direction::MeasuredToIdeal,
    pixel_origin: PixelOrigin::PixelCentre,
    principal_point_from: PixelOrigin::PixelCentre,
    y: Vertical::Down,
    order: TangentialOrder::Without,
    normalisation: "px",
    source: "Scaramuzza, Martinelli and Siegwart 2006; the toolbox's functions cam2world and world2cam",
    verification: Verification::Unverified("formulas after the paper and the toolbox's functions; no projected point of it was at hand"),
};

const NAMES: [(&str, &str); 5 + TERMS] = [
    ("cx", "px"),
    ("cy", "px"),
    ("c", ""),
    ("d", ""),
    ("e", ""),
    ("a0", "px"),
    ("a1", ""),
    ("a2", "px^-1"),
    ("a3", "px^-2"),
    ("a4", "px^-3"),
    ("a5", "px^-4"),
    ("a6", "px^-5"),
];

impl Ocam {
    /// The camera with square pixels and no shear.
    pub const fn round(size: ImageSize, [cx, cy]: [f64; 2], a: [f64; TERMS]) -> Self {
        Self { size, cx, cy, c: 1.0, d: 0.0, e: 0.0, a }
    }

    /// How far the ray of a distance looks forward, and `g - rho g'`: as long as this is positive, the angle rises.
    fn forward(&self, rho: f64) -> (f64, f64) {
        let (mut g, mut rise) = (0.0, 0.0);
        for (i, a) in self.a.iter().enumerate().rev() {
            g = g * rho - a;
            rise = rise * rho - (1.0 - i as f64) * a;
        }
        (g, rise)
    }

    /// The distance up to which the angle rises, and whether it stops there.
    fn end(&self) -> (f64, bool) {
        let ImageSize { width, height } = self.size;
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let farthest = corners.map(|(x, y)| self.in_plane(PixelPoint::new(x * f64::from(width), y * f64::from(height))));
        let reach = REACH * farthest.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max);
        first_fold(|rho| self.forward(rho).1 / -self.a[0], reach, PLACES).map_or((reach, false), |end| (end, true))
    }

    /// A pixel in the plane of the polynomial.
    fn in_plane(&self, at: PixelPoint) -> [f64; 2] {
        let (u, v, det) = (at.x - self.cx, at.y - self.cy, self.c - self.d * self.e);
        [(self.c * u - self.e * v) / det, (v - self.d * u) / det]
    }

    fn pixel(&self, [x, y]: [f64; 2]) -> PixelPoint {
        PixelPoint::new(self.cx + x + self.e * y, self.cy + self.d * x + self.c * y)
    }

    /// The distance from the centre of an angle from the axis, in radians.
    fn distance(&self, theta: f64) -> Result<f64, NoCounterpart> {
        let (end, folds) = self.end();
        let angle = |rho: f64| {
            let (g, rise) = self.forward(rho);
            (rho.atan2(g), rise / (rho * rho + g * g))
        };
        if theta >= angle(end).0 {
            return Err(if folds { NoCounterpart::Behind } else { NoCounterpart::NoSolution });
        }
        let (mut low, mut high, mut rho) = (0.0, end, (theta * self.forward(0.0).0).min(0.5 * end));
        for _ in 0..MOST_STEPS {
            let (value, slope) = angle(rho);
            if value <= theta {
                low = rho;
            } else {
                high = rho;
            }
            let newton = rho - (value - theta) / slope;
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            if (next - rho).abs() <= 1e-16 * rho {
                return Ok(next);
            }
            rho = next;
        }
        Ok(rho)
    }

    /// x right, y down, z forward, the distance of them from the axis, and that of their image from the centre.
    fn polar(&self, ray: Ray) -> Result<([f64; 3], f64, f64), NoCounterpart> {
        let [x, y, z] = [ray.x, -ray.y, -ray.z];
        let r = x.hypot(y);
        if !(r.is_finite() && z.is_finite()) || (r == 0.0 && z <= 0.0) || self.a[0] >= 0.0 {
            return Err(NoCounterpart::Behind);
        }
        Ok(([x, y, z], r, if r > 0.0 { self.distance(r.atan2(z))? } else { 0.0 }))
    }
}

impl CameraModel for Ocam {
    fn size(&self) -> ImageSize {
        self.size
    }

    fn parameters(&self) -> Vec<CameraParameter> {
        named(&NAMES, &[&[self.cx, self.cy, self.c, self.d, self.e][..], &self.a].concat())
    }

    fn with_parameters(&self, v: &[f64]) -> Self {
        Self { size: self.size, cx: v[0], cy: v[1], c: v[2], d: v[3], e: v[4], a: std::array::from_fn(|i| v[5 + i]) }
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        let ([x, y, _], r, rho) = self.polar(ray)?;
        let scale = if r > 0.0 { rho / r } else { 0.0 };
        let found = self.pixel([x * scale, y * scale]);
        if found.is_finite() { Ok(found) } else { Err(NoCounterpart::NoSolution) }
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        let [x, y] = self.in_plane(point);
        let rho = x.hypot(y);
        if !rho.is_finite() {
            return Err(NoCounterpart::NoSolution);
        }
        let (end, _) = self.end();
        if rho >= end || self.a[0] >= 0.0 {
            return Err(NoCounterpart::Fold);
        }
        let g = self.forward(rho).0;
        let length = rho.hypot(g);
        Ok(Ray { x: x / length, y: -y / length, z: -g / length })
    }

    fn derivatives_into(&self, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
        let ([x, y, z], r, rho) = self.polar(ray)?;
        let (g, rise) = self.forward(rho);
        let slope = (rho * rho + g * g) / rise;
        let length2 = r * r + z * z;
        // On the axis rho / r tends to g / Z.
        let (scale, cos, sin) = if r > 0.0 { (rho / r, x / r, y / r) } else { (g / z, 0.0, 0.0) };
        let (radial, back) = (slope * z / length2, -slope * r / length2);
        let change = radial - scale;
        let mixed = change * cos * sin;
        let columns = [[scale + change * cos * cos, mixed], [mixed, scale + change * sin * sin], [back * cos, back * sin]];
        let after = |[x, y]: [f64; 2]| [x + self.e * y, self.d * x + self.c * y];
        let (flat, signs) = ([x * scale, y * scale], [1.0, -1.0, -1.0]);
        let by_ray = columns.map(after);
        into.clear();
        into.point = self.pixel(flat);
        into.by_ray = [0, 1].map(|row| std::array::from_fn(|i| signs[i] * by_ray[i][row]));
        into.extend([[1.0, 0.0], [0.0, 1.0], [0.0, flat[1]], [0.0, flat[0]], [flat[1], 0.0]]);
        // d(rho)/d(a_i) at the same angle.
        into.extend((0..TERMS as i32).map(|i| {
            let by = -rho.powi(i + 1) / rise;
            after([by * cos, by * sin])
        }));
        Ok(())
    }

    fn fold_towards(&self, angle: f64) -> Option<PixelPoint> {
        let (end, folds) = self.end();
        let [x, y] = self.in_plane(PixelPoint::new(self.cx + angle.cos(), self.cy + angle.sin()));
        let scale = end / x.hypot(y);
        folds.then(|| self.pixel([x * scale, y * scale]))
    }
}

impl Ocam {
    /// The camera whose pixels are `matrix` times those of this one, from the centre; `at` is the new centre.
    fn mapped(&self, size: ImageSize, at: PixelPoint, [[m00, m01], [m10, m11]]: [[f64; 2]; 2]) -> Self {
        // The first of the four numbers is one by another unit of the plane.
        let s = m00;
        let a = std::array::from_fn(|i| self.a[i] * s.powi(1 - i as i32));
        Self { size, cx: at.x, cy: at.y, e: m01 / s, d: m10 / s, c: m11 / s, a }
    }
}

impl Reframe for Ocam {
    fn resampled(&self, by: &Resampling) -> Self {
        let ([along, _], [_, down]) = (by.lengths([1.0, 0.0]), by.lengths([0.0, 1.0]));
        let matrix = [[along, along * self.e], [down * self.d, down * self.c]];
        self.mapped(by.size, by.point(PixelPoint::new(self.cx, self.cy)), matrix)
    }

    fn turned(&self, turn: Turn) -> Self {
        let Self { c, d, e, .. } = *self;
        // The plane turns with the image: T A T^-1.
        let matrix = if turn.swaps_axes() { [[c, -d], [-e, 1.0]] } else { [[1.0, e], [d, c]] };
        self.mapped(turn.size(self.size), turn.point(self.size, PixelPoint::new(self.cx, self.cy)), matrix)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::conformance::{self, Shape};
    use crate::camera::{Eucm, OpenCv};

    const SIZE: ImageSize = ImageSize { width: 752, height: 480 };

    fn camera() -> Ocam {
        let a = [-206.5, 0.0, 2.2e-3, -4.9e-6, 1.87e-8, 0.0, 0.0];
        Ocam { size: SIZE, cx: 394.6, cy: 241.8, c: 1.0003, d: 2.2e-4, e: -2.6e-4, a }
    }

    #[test]
    fn conforms() {
        conformance::check(&camera(), Shape::Barrel);
        // Strongly sheared, with every term.
        let a = [-230.0, 0.01, 2e-3, -1e-6, 2e-9, 1e-12, -1e-15];
        conformance::check(&Ocam { c: 1.02, d: 0.01, e: -0.02, a, ..camera() }, Shape::Barrel);
    }

    /// The toolbox's cam2world, in its axes and its order of rows and columns.
    #[test]
    fn a_pixel_has_the_toolbox_s_ray() {
        let camera = camera();
        for (row, column) in [(10.0, 20.0), (241.8, 700.0), (470.0, 394.0)] {
            let det = camera.c - camera.d * camera.e;
            // [row - xc; column - yc] = [c d; e 1] [xp; yp].
            let (i, j) = (row - camera.cy, column - camera.cx);
            let (xp, yp) = ((i - camera.d * j) / det, (camera.c * j - camera.e * i) / det);
            let rho = f64::hypot(xp, yp);
            let zp: f64 = (0..5).map(|i| camera.a[i] * rho.powi(i as i32)).sum();
            let found = camera.unproject(PixelPoint::new(column, row)).unwrap();
            // Its axes are down, right, backwards.
            let length = rho.hypot(zp);
            assert!((found.x - yp / length).hypot(found.y + xp / length).hypot(found.z - zp / length) < 1e-15);
        }
    }

    #[test]
    fn without_curvature_it_is_a_pinhole_and_with_one_term_the_division_model() {
        let (f, k) = (500.0, -0.2);
        let ray = Ray { x: 0.3, y: -0.2, z: -1.0 };
        let pinhole = Ocam::round(SIZE, [380.0, 240.0], [-f, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let opencv = OpenCv { size: SIZE, fx: f, fy: f, cx: 380.0, cy: 240.0, distortion: [0.0; 14], coefficients: 4 };
        assert!(pinhole.project(ray).unwrap().distance(opencv.project(ray).unwrap()) < 1e-10);
        let division = Ocam { a: [-f, 0.0, -k / f, 0.0, 0.0, 0.0, 0.0], ..pinhole };
        let eucm = Eucm { size: SIZE, fx: f, fy: f, cx: 380.0, cy: 240.0, alpha: 0.5, beta: -4.0 * k };
        for z in [-1.0, -0.1, 0.05] {
            let ray = Ray { z, ..ray };
            assert!(division.project(ray).unwrap().distance(eucm.project(ray).unwrap()) < 1e-9, "{z}");
        }
    }

    #[test]
    fn where_the_angle_stops_rising_the_image_ends() {
        // g = f - b rho^2 with b below zero: g - rho g' = f + b rho^2.
        let camera = Ocam::round(SIZE, [380.0, 240.0], [-300.0, 0.0, -0.01, 0.0, 0.0, 0.0, 0.0]);
        let end = (300.0_f64 / 0.01).sqrt();
        let fold = crate::camera::fold(&camera).unwrap();
        assert!((fold.radius_px - end).abs() < 1e-3, "{fold:?}");
        assert!(
            camera.unproject(PixelPoint::new(380.0 + end + 0.1, 240.0)).is_err()
                && camera.unproject(PixelPoint::new(380.0 + end - 0.1, 240.0)).is_ok()
        );
        assert!(camera.project(Ray { x: 1.0, y: 0.0, z: -3.4 }).is_err() && camera.project(Ray { x: 1.0, y: 0.0, z: -3.5 }).is_ok());
    }
}
