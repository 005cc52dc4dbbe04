//! The eccentricity of a disc's picture: its centre is not the picture of the disc's centre.

use nalgebra::{Point3, Vector3};

use crate::Pose;
use crate::camera::Ray;

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

/// Where the line of sight to the centre of a disc's picture, as measured, meets the disc's own centre: its ray.
///
/// `measured` is the ray to the centre of the ellipse, `plane` any point of the disc's plane, `normal` its normal of any length, `radius` the disc's,
/// all in camera axes and object units. `None` for a line of sight that does not meet the plane before the camera, or a disc that reaches behind it.
pub fn correct(measured: Ray, plane: &Vector3<f64>, normal: &Vector3<f64>, radius: f64) -> Option<Ray> {
    let (right, up) = measured.tangent()?;
    let normal = normal.try_normalize(0.0)?;
    let mut at = [right, up];
    // Each round gains the ratio of the eccentricity's change to the change of the centre: at least one digit wherever discs are not huge.
    for _ in 0..100 {
        let direction = Vector3::new(at[0], at[1], -1.0);
        let centre = direction * (normal.dot(plane) / normal.dot(&direction));
        let [dx, dy] = Disc { centre, normal, radius }.eccentricity()?;
        let next = [right - dx, up - dy];
        let change = (next[0] - at[0]).abs().max((next[1] - at[1]).abs());
        at = next;
        if change <= 1e-15 * (1.0 + at[0].abs().max(at[1].abs())) {
            break;
        }
    }
    Some(Ray::from_tangent(at[0], at[1]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix5, Vector5};

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

    #[test]
    fn a_corrected_centre_is_the_picture_of_the_centre() {
        for disc in discs() {
            let (x, y) = Ray { x: disc.centre.x, y: disc.centre.y, z: disc.centre.z }.tangent().unwrap();
            let [dx, dy] = by_conic(&disc);
            let in_plane = disc.centre + disc.normal.cross(&Vector3::x()) * 0.2;
            let corrected = correct(Ray::from_tangent(x + dx / C, y + dy / C), &in_plane, &(disc.normal * -2.0), disc.radius).unwrap();
            let (rx, ry) = corrected.tangent().unwrap();
            assert!(((rx - x) * C).hypot((ry - y) * C) < 1e-9, "{disc:?}: {:e}", ((rx - x) * C).hypot((ry - y) * C));
        }
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
