//! What a picture shows where: its pixels and their rays.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use calibench_model::camera::{Camera, CameraModel, ImageSize, NoCounterpart, OpenCv, Ray, Splined};
use calibench_model::{NamedCamera, PixelPoint};

/// A picture on a sphere around the camera, unrolled: columns are longitudes, rows are latitudes.
///
/// `x = x0 + s longitude`, `y = y0 - s latitude`, with `longitude = atan2(X, -Z)` and `latitude = atan2(Y, hypot(X, Z))` of a ray (X right, Y up, Z backwards).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Equirectangular {
    /// Its size.
    pub size: ImageSize,
    /// Scale, px per radian.
    pub scale: f64,
    /// Image of the axis, px from the centre of the first pixel.
    pub axis: PixelPoint,
}

/// How the pixels of a picture belong to rays.
#[derive(Clone, Debug, PartialEq)]
pub enum View {
    /// As in the pictures of a camera.
    Camera(Camera),
    /// As in those of a camera of splines.
    Splined(Arc<Splined>),
    /// As on a sphere.
    Equirectangular(Equirectangular),
}

impl View {
    /// That of a camera as its file has it.
    pub fn of(named: &NamedCamera) -> Self {
        match &named.splines {
            Some(splines) => Self::Splined(Arc::new(splines.model.clone())),
            None => Self::Camera(named.camera),
        }
    }

    /// That of a camera without distortion: focal lengths along x and y, px; the image of its axis.
    pub fn pinhole(size: ImageSize, [fx, fy]: [f64; 2], axis: PixelPoint) -> Self {
        let camera = OpenCv { size, fx, fy, cx: axis.x, cy: axis.y, distortion: [0.0; 14], coefficients: 5 };
        Self::Camera(camera.into())
    }

    /// Columns and rows.
    pub fn size(&self) -> ImageSize {
        match self {
            Self::Camera(camera) => camera.size(),
            Self::Splined(splines) => splines.size,
            Self::Equirectangular(sphere) => sphere.size,
        }
    }

    /// The ray of a place; `None` where there is none.
    pub fn ray(&self, at: PixelPoint) -> Option<Ray> {
        match self {
            Self::Camera(camera) => camera.unproject(at).ok(),
            Self::Splined(splines) => splines.unproject(at).ok(),
            Self::Equirectangular(sphere) => sphere.ray(at),
        }
    }

    /// The place of a ray; `None` for one that is not pictured, by any size of the frame.
    pub fn image(&self, ray: Ray) -> Option<PixelPoint> {
        match self {
            Self::Camera(camera) => camera.project(ray).ok().filter(|at| at.is_finite()),
            Self::Splined(splines) => splines.project(ray).ok().filter(|at| at.is_finite()),
            Self::Equirectangular(sphere) => sphere.image(ray),
        }
    }

    /// The image of the axis, and how many px to the right and down a radian has there.
    ///
    /// # Errors
    /// The axis is not pictured.
    pub(crate) fn axis(&self) -> Result<(PixelPoint, [f64; 2]), NoCounterpart> {
        let axis = Ray::from_tangent(0.0, 0.0);
        let slopes = match self {
            Self::Camera(camera) => camera.slopes(axis)?,
            Self::Splined(splines) => splines.slopes(axis)?,
            Self::Equirectangular(sphere) => return Ok((sphere.axis, [sphere.scale; 2])),
        };
        // By the ray's components, of which y points up and the image down.
        Ok((slopes.point, [slopes.by_ray[0][0], -slopes.by_ray[1][1]]))
    }

    /// The place in another picture of what is pictured at `at`; `None` for what only one of them can show.
    pub fn place_in(&self, other: &Self, at: PixelPoint) -> Option<PixelPoint> {
        other.image(self.ray(at)?)
    }

    /// Whether a place lies in the frame, to the outer edges of its pixels.
    pub fn holds(&self, at: PixelPoint) -> bool {
        is_inside(self.size(), at)
    }
}

/// Whether a place lies in a frame, to the outer edges of its pixels.
pub(crate) fn is_inside(size: ImageSize, at: PixelPoint) -> bool {
    let corner = at.to_corner();
    (0.0..=f64::from(size.width)).contains(&corner.x) && (0.0..=f64::from(size.height)).contains(&corner.y)
}

impl Equirectangular {
    fn ray(&self, at: PixelPoint) -> Option<Ray> {
        let (longitude, latitude) = ((at.x - self.axis.x) / self.scale, (self.axis.y - at.y) / self.scale);
        if !(longitude.abs() <= PI && latitude.abs() <= FRAC_PI_2) {
            return None;
        }
        let ((right, forward), (up, level)) = (longitude.sin_cos(), latitude.sin_cos());
        Some(Ray { x: level * right, y: up, z: -level * forward })
    }

    fn image(&self, ray: Ray) -> Option<PixelPoint> {
        let (longitude, latitude) = (ray.x.atan2(-ray.z), ray.y.atan2(ray.x.hypot(ray.z)));
        let at = PixelPoint::new(self.axis.x + self.scale * longitude, self.axis.y - self.scale * latitude);
        at.is_finite().then_some(at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere() -> View {
        let size = ImageSize { width: 1257, height: 629 };
        View::Equirectangular(Equirectangular { size, scale: 200.0, axis: PixelPoint::new(628.0, 314.0) })
    }

    #[test]
    fn a_sphere_is_unrolled_by_angles() {
        // 30 degrees up at 45 degrees to the right; straight behind is at the edge; no ray beyond the poles.
        let (sin, cos) = (30.0_f64.to_radians().sin_cos().0, 30.0_f64.to_radians().cos());
        let half = cos * 0.5_f64.sqrt();
        let at = sphere().image(Ray { x: half, y: sin, z: -half }).unwrap();
        assert!(at.distance(PixelPoint::new(628.0 + 200.0 * PI / 4.0, 314.0 - 200.0 * PI / 6.0)) < 1e-10);
        let behind = sphere().image(Ray { x: 0.0, y: 0.0, z: 1.0 }).unwrap();
        assert!((behind.x - (628.0 + 200.0 * PI)).abs() < 1e-10);
        assert!(sphere().ray(PixelPoint::new(628.0, 314.0 - 200.0 * FRAC_PI_2 - 0.01)).is_none());
    }

    #[test]
    fn rays_lead_back_to_their_places() {
        let pinhole = View::pinhole(ImageSize { width: 640, height: 480 }, [500.0, 510.0], PixelPoint::new(300.0, 250.0));
        for view in [sphere(), pinhole.clone()] {
            for (x, y) in [(0.0, 0.0), (10.5, 479.0), (639.0, 3.0), (300.0, 250.0)] {
                let at = PixelPoint::new(x, y);
                let back = view.image(view.ray(at).unwrap()).unwrap();
                assert!(back.distance(at) < 1e-9, "{back:?}");
            }
        }
        // What lies behind is in no plane, and on a sphere.
        let behind = Ray { x: 0.1, y: 0.0, z: 1.0 };
        assert!(pinhole.image(behind).is_none() && sphere().image(behind).is_some());
    }

    #[test]
    fn splines_are_taken_before_the_camera_beside_them() {
        let size = ImageSize { width: 640, height: 480 };
        let splined = Splined::flat(size, [300.0, 300.0, 320.0, 240.0], 3, [12, 10], 120.0);
        let named = NamedCamera::splined("", splined.clone());
        assert_eq!(View::of(&named), View::Splined(Arc::new(splined)));
        assert_eq!(View::of(&NamedCamera { splines: None, ..named.clone() }), View::Camera(named.camera));
    }
}
