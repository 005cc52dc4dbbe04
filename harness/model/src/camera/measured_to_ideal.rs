//! What the photogrammetric cameras have in common: measured coordinates in mm, corrected to ideal ones.

use super::newton::{self, determinant};
use super::plane_map::{self, PlaneMap};
use super::{DerivativeBuffer, NoCounterpart, Photogrammetric, Ray, Slopes};
use crate::{Frame, PixelPoint, SensorPoint};

/// Places between the principal point and the farthest corner where a fold is looked for.
const PLACES: usize = 200;

/// A correction of measured coordinates around an interior orientation.
pub(super) trait Correction: PlaneMap {
    /// Principal distance, principal point, pitch and size.
    fn base(&self) -> &Photogrammetric;
    /// Adds d(ideal) / d(coefficient) at measured coordinates from the principal point, mm; without those of c, x0, y0.
    fn by_coefficients(&self, at: [f64; 2], into: &mut DerivativeBuffer);
}

fn frame(base: &Photogrammetric) -> Result<Frame, NoCounterpart> {
    Frame::new(base.size.width, base.size.height, base.pitch_um).map_err(|_| NoCounterpart::NoSolution)
}

fn to_pixel(base: &Photogrammetric, [x, y]: [f64; 2]) -> Result<PixelPoint, NoCounterpart> {
    Ok(frame(base)?.to_pixel(SensorPoint { x: x + base.x0, y: y + base.y0 }))
}

/// Measured coordinates from the principal point, mm, of a ray.
fn measured(camera: &impl Correction, ray: Ray) -> Result<[f64; 2], NoCounterpart> {
    let (u, v) = ray.tangent().ok_or(NoCounterpart::Behind)?;
    plane_map::invert(camera, [camera.base().c * u, camera.base().c * v])
}

pub(super) fn project(camera: &impl Correction, ray: Ray) -> Result<PixelPoint, NoCounterpart> {
    to_pixel(camera.base(), measured(camera, ray)?)
}

pub(super) fn project_near(camera: &impl Correction, ray: Ray, near: PixelPoint) -> Result<PixelPoint, NoCounterpart> {
    let base = camera.base();
    let (u, v) = ray.tangent().ok_or(NoCounterpart::Behind)?;
    let start = frame(base)?.to_sensor(near);
    // Newton's steps stay where the determinant is positive: on the branch of `near`.
    match newton::solve([base.c * u, base.c * v], [start.x - base.x0, start.y - base.y0], |at| camera.map(at)) {
        Ok(found) => to_pixel(base, found),
        Err(_) => project(camera, ray),
    }
}

pub(super) fn unproject(camera: &impl Correction, point: PixelPoint) -> Result<Ray, NoCounterpart> {
    let base = camera.base();
    let from_centre = frame(base)?.to_sensor(point);
    let at = [from_centre.x - base.x0, from_centre.y - base.y0];
    if !point.is_finite() {
        return Err(NoCounterpart::NoSolution);
    }
    // The correction is explicit; beyond a fold it leads to a ray that belongs to another pixel.
    if !plane_map::is_on_branch(camera, at) {
        return Err(NoCounterpart::Fold);
    }
    let ([x, y], _) = camera.map(at);
    Ok(Ray::from_tangent(x / base.c, y / base.c))
}

/// A measured place, and what becomes of a change of the ideal one.
struct Place {
    /// Measured coordinates from the principal point, mm.
    at: [f64; 2],
    /// d(ideal) / d(measured).
    by: [[f64; 2]; 2],
    /// Pixels to a mm over the determinant of `by`.
    scale: f64,
}

impl Place {
    fn of(camera: &impl Correction, ray: Ray) -> Result<Self, NoCounterpart> {
        let at = measured(camera, ray)?;
        let (_, by) = camera.map(at);
        Ok(Self { at, by, scale: 1e3 / camera.base().pitch_um / determinant(by) })
    }

    /// The change of the pixel, px, where c times the tangent minus the ideal place changes by `g`, mm.
    ///
    /// F(measured, parameters) = c tangent: d(measured) = F_m^-1 (d(c tangent) - F_parameters), then mm upwards to px downwards.
    fn pixel(&self, g: [f64; 2]) -> [f64; 2] {
        let Self { by, scale, .. } = self;
        [scale * (by[1][1] * g[0] - by[0][1] * g[1]), -scale * (by[0][0] * g[1] - by[1][0] * g[0])]
    }

    fn slopes(&self, base: &Photogrammetric, ray: Ray) -> Result<Slopes, NoCounterpart> {
        let (by_u, by_v) = (self.pixel([base.c, 0.0]), self.pixel([0.0, base.c]));
        let tangent = ray.tangent_derivatives();
        let by = |row: usize, axis: usize| by_u[row] * tangent[0][axis] + by_v[row] * tangent[1][axis];
        let by_ray = std::array::from_fn(|row| std::array::from_fn(|axis| by(row, axis)));
        Ok(Slopes { point: to_pixel(base, self.at)?, by_ray })
    }
}

pub(super) fn slopes(camera: &impl Correction, ray: Ray) -> Result<Slopes, NoCounterpart> {
    Place::of(camera, ray)?.slopes(camera.base(), ray)
}

pub(super) fn derivatives_into(camera: &impl Correction, ray: Ray, into: &mut DerivativeBuffer) -> Result<(), NoCounterpart> {
    let (base, (u, v)) = (camera.base(), ray.tangent().ok_or(NoCounterpart::Behind)?);
    let place = Place::of(camera, ray)?;
    let per_mm = 1e3 / base.pitch_um;
    into.clear();
    into.extend([place.pixel([u, v]), [per_mm, 0.0], [0.0, -per_mm]]);
    camera.by_coefficients(place.at, into);
    into.change_from(3, |[x, y]| place.pixel([-x, -y]));
    Slopes { point: into.point, by_ray: into.by_ray } = place.slopes(base, ray)?;
    Ok(())
}

/// Distance from the principal point beyond which nothing of the frame lies, mm.
fn farthest(base: &Photogrammetric) -> f64 {
    let half = |length: u32, offset: f64| f64::from(length) * base.pitch_um * 5e-4 + offset.abs();
    half(base.size.width, base.x0).hypot(half(base.size.height, base.y0))
}

pub(super) fn has_surely_no_fold(camera: &impl Correction) -> bool {
    camera.is_surely_one_to_one(farthest(camera.base()))
}

pub(super) fn fold_towards(camera: &impl Correction, angle: f64) -> Option<PixelPoint> {
    let base = camera.base();
    // Angles are those of the image, y down.
    let (sin, cos) = angle.sin_cos();
    let s = plane_map::first_fold(|s| determinant(camera.map([s * cos, -s * sin]).1), farthest(base), PLACES)?;
    to_pixel(base, [s * cos, -s * sin]).ok()
}

/// The methods of [`super::CameraModel`] for a [`Correction`] that has `named_parameters` and `with_values`.
macro_rules! measured_camera {
    ($model:ty) => {
        impl $crate::camera::CameraModel for $model {
            fn size(&self) -> $crate::camera::ImageSize {
                $crate::camera::measured_to_ideal::Correction::base(self).size
            }

            fn parameters(&self) -> Vec<$crate::camera::CameraParameter> {
                self.named_parameters()
            }

            fn with_parameters(&self, values: &[f64]) -> Self {
                self.with_values(values)
            }

            fn project(&self, ray: $crate::camera::Ray) -> Result<$crate::PixelPoint, $crate::camera::NoCounterpart> {
                $crate::camera::measured_to_ideal::project(self, ray)
            }

            fn project_near(
                &self,
                ray: $crate::camera::Ray,
                near: $crate::PixelPoint,
            ) -> Result<$crate::PixelPoint, $crate::camera::NoCounterpart> {
                $crate::camera::measured_to_ideal::project_near(self, ray, near)
            }

            fn unproject(&self, point: $crate::PixelPoint) -> Result<$crate::camera::Ray, $crate::camera::NoCounterpart> {
                $crate::camera::measured_to_ideal::unproject(self, point)
            }

            fn derivatives_into(
                &self,
                ray: $crate::camera::Ray,
                into: &mut $crate::camera::DerivativeBuffer,
            ) -> Result<(), $crate::camera::NoCounterpart> {
                $crate::camera::measured_to_ideal::derivatives_into(self, ray, into)
            }

            fn slopes(&self, ray: $crate::camera::Ray) -> Result<$crate::camera::Slopes, $crate::camera::NoCounterpart> {
                $crate::camera::measured_to_ideal::slopes(self, ray)
            }

            fn fold_towards(&self, angle: f64) -> Option<$crate::PixelPoint> {
                $crate::camera::measured_to_ideal::fold_towards(self, angle)
            }

            fn has_surely_no_fold(&self) -> bool {
                $crate::camera::measured_to_ideal::has_surely_no_fold(self)
            }
        }
    };
}
pub(super) use measured_camera;
