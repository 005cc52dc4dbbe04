//! The eccentricity of a disc's picture: its centre is not the picture of the disc's centre.

use nalgebra::{Point3, Vector3};

use crate::Pose;
use crate::camera::{CameraModel, Ray};

/// A disc in camera axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// The centre, object units, before the camera: z is negative.
    pub centre: Vector3<f64>,
    /// A normal of its plane, of unit length, either way.
    pub normal: Vector3<f64>,
    /// The radius, object units.
    pub radius: f64,
}

impl Disc {
    /// The disc with its centre, a normal of any length but zero, and its radius, all in object space and object units, as `pose` sees it.
    ///
    /// `None` for a normal of no length, or a radius that is no positive number.
    pub fn seen_from(pose: &Pose, centre: &Point3<f64>, normal: &Vector3<f64>, radius: f64) -> Option<Self> {
        let normal = (pose.rotation * normal).try_normalize(0.0)?;
        (radius > 0.0 && radius.is_finite()).then(|| Self { centre: pose.camera_from_world(centre), normal, radius })
    }

    /// Centre of the ellipse minus picture of the disc's centre, both (right, up) by an undistorted pinhole of principal distance one:
    /// times the principal distance in px or mm it is in these. `None` unless all of the disc lies before the camera.
    ///
    /// The ellipse's centre is the pole of the line at infinity. With centre C, unit normal n and radius r it lies on the ray
    /// `C Cz - r^2 (e_z - n nz)`, which gives the offset without a small difference of large numbers.
    ///
    /// Source: derived here from the dual conic; the effect: Lenz & Fritsch 1990, Heikkilä & Silvén 1996.
    pub fn eccentricity(&self) -> Option<[f64; 2]> {
        let Self { centre: c, normal: n, radius } = *self;
        let r2 = radius * radius;
        let sine2 = n.x * n.x + n.y * n.y;
        // The disc's nearest point has depth |Cz| - r sine.
        let depth2 = c.z * c.z - r2 * sine2;
        if c.z.is_nan() || c.z >= 0.0 || depth2.is_nan() || depth2 <= 0.0 {
            return None;
        }
        let offset = |c_axis: f64, n_axis: f64| r2 * (c_axis * sine2 + n_axis * n.z * c.z) / (depth2 * c.z);
        // Right is x / -z.
        Some([-offset(c.x, n.x), -offset(c.y, n.y)])
    }
}

/// Places around the outline: of a smooth closed curve the trapezoid's error falls faster than any power of their number.
const PLACES: u32 = 32;

/// Centroid of a disc's picture minus picture of its centre, px (x right, y down), through the whole camera. `None` where not all of the outline has a place in
/// the image plane.
///
/// The centroid is that of the area inside the distorted outline, by Green's theorem.
pub fn in_image(camera: &impl CameraModel, disc: &Disc) -> Option<[f64; 2]> {
    let at = camera.project(ray(&disc.centre)).ok()?;
    let [a, b] = axes(&disc.normal);
    let (mut area, mut first) = (0.0, [0.0; 2]);
    for place in 0..PLACES {
        let (sine, cosine) = (f64::from(place) * (std::f64::consts::TAU / f64::from(PLACES))).sin_cos();
        let seen = camera.slopes(ray(&(disc.centre + (a * cosine + b * sine) * disc.radius))).ok()?;
        let along = b * cosine - a * sine;
        let [dx, dy] = seen.by_ray.map(|by| by[0] * along.x + by[1] * along.y + by[2] * along.z);
        let (x, y) = (seen.point.x - at.x, seen.point.y - at.y);
        // Twice the area of the triangle to the next place, whose centroid lies at two thirds.
        let swept = x * dy - y * dx;
        area += swept;
        first = [first[0] + swept * x * (2.0 / 3.0), first[1] + swept * y * (2.0 / 3.0)];
    }
    let centroid = first.map(|moment| moment / area);
    centroid.iter().all(|offset| offset.is_finite()).then_some(centroid)
}

fn ray(v: &Vector3<f64>) -> Ray {
    Ray { x: v.x, y: v.y, z: v.z }
}

/// Two axes of unit length in the plane of a normal of unit length.
fn axes(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let a = normal.cross(&Vector3::ith(normal.iamin(), 1.0)).normalize();
    [a, normal.cross(&a)]
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix5, Vector5};

    use super::*;
    use crate::camera::{Camera, ImageSize, OpenCv};

    /// A long lens, px.
    const C: f64 = 5000.0;

    /// The centre of the ellipse through five points of the disc's rim, times `C` from the picture of its centre: no formula of ours.
    fn by_conic(disc: &Disc) -> [f64; 2] {
        let a = disc.normal.cross(&Vector3::new(0.3, 0.9, -0.2)).normalize();
        let b = disc.normal.cross(&a);
        let tangent = |p: Vector3<f64>| Ray { x: p.x, y: p.y, z: p.z }.tangent().unwrap();
        let (x0, y0) = tangent(disc.centre);
        let points = [0.1, 1.3, 2.7, 3.9, 5.2].map(|t: f64| {
            let (x, y) = tangent(disc.centre + (a * t.cos() + b * t.sin()) * disc.radius);
            ((x - x0) * C, (y - y0) * C)
        });
        let size = points.iter().map(|(x, y)| x.hypot(*y)).fold(0.0, f64::max);
        let rows = Matrix5::from_fn(|i, j| {
            let (x, y) = (points[i].0 / size, points[i].1 / size);
            [x * x, x * y, y * y, x, y][j]
        });
        let q = rows.full_piv_lu().solve(&Vector5::repeat(1.0)).unwrap();
        let determinant = 4.0 * q[0] * q[2] - q[1] * q[1];
        [(q[1] * q[4] - 2.0 * q[2] * q[3]) / determinant * size, (q[1] * q[3] - 2.0 * q[0] * q[4]) / determinant * size]
    }

    fn discs() -> impl Iterator<Item = Disc> {
        (0..60).map(|i| {
            let i = f64::from(i);
            let normal = Vector3::new((0.7 * i).sin(), (1.1 * i).cos(), 0.3 + 0.02 * i).normalize();
            Disc { centre: Vector3::new(0.4 * (2.0 * i).cos(), 0.3 * (0.9 * i).sin(), -1.0 - 0.05 * i), normal, radius: 0.01 + 0.001 * i }
        })
    }

    #[test]
    fn the_offset_is_that_of_the_conic() {
        let mut largest: f64 = 0.0;
        for disc in discs() {
            let (ours, exact) = (disc.eccentricity().unwrap(), by_conic(&disc));
            for axis in 0..2 {
                assert!((ours[axis] * C - exact[axis]).abs() < 1e-9, "{disc:?}: {} {}", ours[axis] * C, exact[axis]);
                largest = largest.max(exact[axis].abs());
            }
        }
        assert!(largest > 0.5, "{largest} px");
    }

    /// The outline's centroid by the polygon through `places` of it, less the picture of the centre, px.
    fn by_polygon(camera: &impl CameraModel, disc: &Disc, places: u32) -> [f64; 2] {
        let a = disc.normal.cross(&Vector3::new(0.3, 0.9, -0.2)).normalize();
        let b = disc.normal.cross(&a);
        let at = camera.project(ray(&disc.centre)).unwrap();
        let corner = |place: u32| {
            let (sine, cosine) = (f64::from(place) * std::f64::consts::TAU / f64::from(places)).sin_cos();
            let seen = camera.project(ray(&(disc.centre + (a * cosine + b * sine) * disc.radius))).unwrap();
            [seen.x - at.x, seen.y - at.y]
        };
        let (mut area, mut first) = (0.0, [0.0; 2]);
        for place in 0..places {
            let ([x, y], [u, v]) = (corner(place), corner(place + 1));
            let twice = x * v - u * y;
            area += twice;
            first = [first[0] + twice * (x + u) / 3.0, first[1] + twice * (y + v) / 3.0];
        }
        first.map(|moment| moment / area)
    }

    fn camera(distortion: &[f64]) -> Camera {
        let size = ImageSize { width: 4000, height: 3000 };
        let mut all = [0.0; 14];
        all[..distortion.len()].copy_from_slice(distortion);
        OpenCv { size, fx: C, fy: C, cx: 2000.0, cy: 1500.0, distortion: all, coefficients: 5 }.into()
    }

    #[test]
    fn without_distortion_the_image_has_the_offset_of_the_conic() {
        for disc in discs() {
            let ([x, y], exact) = (in_image(&camera(&[]), &disc).unwrap(), by_conic(&disc));
            assert!((x - exact[0]).hypot(y + exact[1]) < 1e-9, "{disc:?}: {x} {y} for {exact:?}");
        }
    }

    /// Distortion moves the centroid too: by its curvature over the disc.
    #[test]
    fn with_distortion_the_centroid_is_that_of_the_outline() {
        let (lens, plain) = (camera(&[-0.3, 0.12, 2e-3, -1e-3, 0.02]), camera(&[]));
        let mut most: f64 = 0.0;
        for disc in discs().filter(|disc| disc.centre.xy().norm() < 0.5 * disc.centre.z.abs()) {
            let ([x, y], exact) = (in_image(&lens, &disc).unwrap(), by_polygon(&lens, &disc, 20_000));
            assert!((x - exact[0]).hypot(y - exact[1]) < 1e-6, "{disc:?}: {x} {y} for {exact:?}");
            let [px, py] = in_image(&plain, &disc).unwrap();
            most = most.max((x - px).hypot(y - py));
        }
        assert!(most > 0.05, "{most} px");
    }

    #[test]
    fn parallel_to_the_image_there_is_none_and_behind_the_camera_no_answer() {
        let pose = Pose::from_angles(Point3::new(0.0, 0.0, 2.0), [0.0; 3]);
        let disc = Disc::seen_from(&pose, &Point3::new(0.3, 0.2, 0.0), &Vector3::z(), 0.1).unwrap();
        assert_eq!(disc.eccentricity(), Some([0.0, 0.0]));
        assert_eq!(Disc { centre: -disc.centre, ..disc }.eccentricity(), None);
        assert_eq!(Disc { normal: Vector3::x(), radius: 2.5, ..disc }.eccentricity(), None);
        assert!(Disc::seen_from(&pose, &Point3::origin(), &Vector3::zeros(), 0.1).is_none());
        assert!(Disc::seen_from(&pose, &Point3::origin(), &Vector3::z(), f64::NAN).is_none());
    }
}
