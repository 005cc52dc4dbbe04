//! The canonical interior orientation: photogrammetric, a correction of measured coordinates.

use super::newton::{self, ValueAndDerivatives};
use super::{CameraModel, CameraParameter, Derivatives, ImageSize, NoCounterpart, Ray};
use crate::{Frame, PixelPoint, SensorPoint};

/// Interior orientation in mm, y up, from the centre of the frame. Direction: **measured to ideal**.
///
/// With `xb = x' - x0`, `yb = y' - y0`, `r2 = xb^2 + yb^2` the ideal coordinates are
/// `x = xb - [xb (k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 xb^2) + 2 p2 xb yb + b1 xb + b2 yb]`,
/// `y = yb - [yb (k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 xb yb + p2 (r2 + 2 yb^2)]`.
///
/// Source: Brown 1971; Fraser 1997 for `b1`, `b2`; Galo et al. 2011, Eq. 8 and 9.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Difference of scale b1 and shear b2.
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

impl Photogrammetric {
    fn frame(&self) -> Result<Frame, NoCounterpart> {
        Frame::new(self.size.width, self.size.height, self.pitch_um).map_err(|_| NoCounterpart::NoSolution)
    }

    /// Ideal coordinates (mm) of measured ones from the principal point, with their derivatives by these.
    fn correct(&self, [x, y]: [f64; 2]) -> ValueAndDerivatives {
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

    /// Measured coordinates from the principal point, mm, of a ray.
    fn measured(&self, ray: Ray) -> Result<[f64; 2], NoCounterpart> {
        let (u, v) = ray.tangent().ok_or(NoCounterpart::Behind)?;
        let goal = [self.c * u, self.c * v];
        newton::solve(goal, [0.0, 0.0], |at| self.correct(at))
    }
}

impl CameraModel for Photogrammetric {
    fn size(&self) -> ImageSize {
        self.size
    }

    fn parameters(&self) -> Vec<CameraParameter> {
        let [k1, k2, k3] = self.k;
        let values = [self.c, self.x0, self.y0, k1, k2, k3, self.p[0], self.p[1], self.b[0], self.b[1]];
        NAMES.iter().zip(values).map(|(&(name, unit), value)| CameraParameter { name, unit, value }).collect()
    }

    fn with_parameters(&self, values: &[f64]) -> Self {
        let v = |i: usize| values[i];
        Self { c: v(0), x0: v(1), y0: v(2), k: [v(3), v(4), v(5)], p: [v(6), v(7)], b: [v(8), v(9)], ..*self }
    }

    fn project(&self, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
        let [x, y] = self.measured(ray)?;
        Ok(self.frame()?.to_pixel(SensorPoint { x: x + self.x0, y: y + self.y0 }))
    }

    fn unproject(&self, point: PixelPoint) -> Result<Ray, NoCounterpart> {
        let measured = self.frame()?.to_sensor(point);
        let at = [measured.x - self.x0, measured.y - self.y0];
        let ([x, y], _) = self.correct(at);
        // The correction is explicit; beyond a fold it leads to a ray that belongs to another pixel.
        let back = newton::solve([x, y], [0.0, 0.0], |at| self.correct(at))?;
        if (back[0] - at[0]).hypot(back[1] - at[1]) > 1e-9 * self.c.abs() {
            return Err(NoCounterpart::Fold);
        }
        Ok(Ray::from_tangent(x / self.c, y / self.c))
    }

    fn derivatives(&self, ray: Ray) -> Result<Derivatives, NoCounterpart> {
        let (u, v) = ray.tangent().ok_or(NoCounterpart::Behind)?;
        let at @ [x, y] = self.measured(ray)?;
        let (_, by) = self.correct(at);
        let determinant = by[0][0] * by[1][1] - by[0][1] * by[1][0];
        let per_mm = 1e3 / self.pitch_um;
        // F(measured, parameters) = c tangent: d(measured) = F_m^-1 (d(c tangent) - F_parameters), then mm upwards to px downwards.
        let pixel = |g: [f64; 2]| {
            [per_mm * (by[1][1] * g[0] - by[0][1] * g[1]) / determinant, -per_mm * (by[0][0] * g[1] - by[1][0] * g[0]) / determinant]
        };
        let r2 = x * x + y * y;
        let radial = |power: f64| pixel([x * power, y * power]);
        let by_parameters = vec![
            pixel([u, v]),
            [per_mm, 0.0],
            [0.0, -per_mm],
            radial(r2),
            radial(r2 * r2),
            radial(r2 * r2 * r2),
            pixel([r2 + 2.0 * x * x, 2.0 * x * y]),
            pixel([2.0 * x * y, r2 + 2.0 * y * y]),
            pixel([x, 0.0]),
            pixel([y, 0.0]),
        ];
        let (by_u, by_v) = (pixel([self.c, 0.0]), pixel([0.0, self.c]));
        let tangent = ray.tangent_derivatives();
        let by_ray = std::array::from_fn(|row| std::array::from_fn(|axis| by_u[row] * tangent[0][axis] + by_v[row] * tangent[1][axis]));
        let point = self.frame()?.to_pixel(SensorPoint { x: x + self.x0, y: y + self.y0 });
        Ok(Derivatives { point, by_ray, by_parameters })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Photogrammetric {
        let size = ImageSize { width: 4272, height: 2848 };
        let (k, p, b) = ([-4.61e-4, 1.2e-6, -4e-10], [0.86e-4, -0.3e-4], [1e-4, -2e-4]);
        Photogrammetric { size, pitch_um: 5.15, c: 19.213, x0: 0.042, y0: -0.134, k, p, b }
    }

    #[test]
    fn pixels_come_back() {
        for (x, y) in [(0.0, 0.0), (4271.0, 2847.0), (2100.3, 1400.9), (100.0, 2800.0)] {
            let point = PixelPoint::new(x, y);
            let ray = camera().unproject(point).unwrap();
            assert!(camera().project(ray).unwrap().distance(point) < 1e-9);
        }
    }

    #[test]
    fn derivatives_are_differences() {
        let camera = camera();
        let ray = Ray { x: 0.41, y: -0.27, z: -1.13 };
        let analytic = camera.derivatives(ray).unwrap();
        let values: Vec<f64> = camera.parameters().iter().map(|p| p.value).collect();
        for (i, by) in analytic.by_parameters.iter().enumerate() {
            let h = [1e-5, 1e-5, 1e-5, 1e-8, 1e-10, 1e-12, 1e-7, 1e-7, 1e-6, 1e-6][i];
            let at = |step: f64| {
                let mut changed = values.clone();
                changed[i] += step;
                camera.with_parameters(&changed).project(ray).unwrap()
            };
            let (high, low) = (at(h), at(-h));
            let found = [(high.x - low.x) / (2.0 * h), (high.y - low.y) / (2.0 * h)];
            let scale = by[0].hypot(by[1]).max(1.0);
            assert!((found[0] - by[0]).abs() < 1e-5 * scale && (found[1] - by[1]).abs() < 1e-5 * scale, "{i}: {found:?} {by:?}");
        }
        for axis in 0..3 {
            let at = |h: f64| {
                let step = |i: usize| if i == axis { h } else { 0.0 };
                camera.project(Ray { x: ray.x + step(0), y: ray.y + step(1), z: ray.z + step(2) }).unwrap()
            };
            let (high, low) = (at(1e-6), at(-1e-6));
            assert!(((high.x - low.x) / 2e-6 - analytic.by_ray[0][axis]).abs() < 1e-3, "{axis}");
            assert!(((high.y - low.y) / 2e-6 - analytic.by_ray[1][axis]).abs() < 1e-3, "{axis}");
        }
    }

    #[test]
    fn a_fold_is_not_crossed() {
        // r (1 - k1 r^2) turns round at r = 1 / sqrt(3 k1) = 5.8 mm.
        let camera = Photogrammetric { k: [0.01, 0.0, 0.0], p: [0.0; 2], b: [0.0; 2], x0: 0.0, y0: 0.0, ..camera() };
        assert_eq!(camera.unproject(PixelPoint::new(0.0, 1423.5)), Err(NoCounterpart::Fold));
        assert_eq!(camera.project(Ray::from_tangent(0.5, 0.0)), Err(NoCounterpart::Fold));
        assert!(camera.project(Ray::from_tangent(0.1, 0.0)).is_ok());
        assert_eq!(camera.project(Ray { x: 0.0, y: 0.0, z: 1.0 }), Err(NoCounterpart::Behind));
    }
}
