//! Exterior orientation: where a camera stands and how it is turned.

use nalgebra::{Matrix3, Point3, Vector3};

use crate::camera::Ray;

/// Exterior orientation, `camera_from_world`: `N = M (X - X0)`, with `M` orthogonal of determinant +1.
///
/// The camera's axes are x right, y up, z backwards: it looks along its -z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// `M`, 3 x 3: from object to camera axes.
    pub rotation: Matrix3<f64>,
    /// `X0`: the projection centre, object units.
    pub centre: Point3<f64>,
}

impl Pose {
    /// The camera at `centre` (object units), turned by `M = M_kappa M_phi M_omega`, radians; elementary rotations are passive.
    ///
    /// Source: Mikhail, Bethel & McGlone 2001, `m31 = sin phi`, `m32 = -sin omega cos phi`, `m33 = cos omega cos phi`.
    pub fn from_angles(centre: Point3<f64>, [omega, phi, kappa]: [f64; 3]) -> Self {
        let (so, co) = omega.sin_cos();
        let (sp, cp) = phi.sin_cos();
        let about_x = Matrix3::new(1.0, 0.0, 0.0, 0.0, co, so, 0.0, -so, co);
        let about_y = Matrix3::new(cp, 0.0, -sp, 0.0, 1.0, 0.0, sp, 0.0, cp);
        Self { rotation: about_z(kappa) * about_y * about_x, centre }
    }

    /// The camera at `centre` whose axis meets `target`, with the image's y axis as near to `up` as can be and then rolled by `roll` radians:
    /// a positive roll turns the camera to the left, its picture to the right (clockwise).
    ///
    /// `centre` and `target` are in object units, `up` is a direction in object axes, of any length.
    ///
    /// `None` if `centre` is `target`, or the line of sight lies along `up`.
    pub fn looking_at(centre: Point3<f64>, target: Point3<f64>, up: Vector3<f64>, roll: f64) -> Option<Self> {
        let back = (centre - target).try_normalize(0.0)?;
        let right = up.cross(&back).try_normalize(1e-9 * up.norm())?;
        let upright = Matrix3::from_rows(&[right.transpose(), back.cross(&right).transpose(), back.transpose()]);
        Some(Self { rotation: about_z(roll) * upright, centre })
    }

    /// omega, phi, kappa, radians; phi from -pi/2 to pi/2. At phi = +-pi/2 only omega + kappa or their difference is determined: omega is 0 there.
    pub fn angles(&self) -> [f64; 3] {
        let m = &self.rotation;
        let cosine = m[(2, 1)].hypot(m[(2, 2)]);
        let phi = m[(2, 0)].atan2(cosine);
        if cosine < 1e-12 {
            return [0.0, phi, m[(0, 1)].atan2(m[(1, 1)])];
        }
        [(-m[(2, 1)]).atan2(m[(2, 2)]), phi, (-m[(1, 0)]).atan2(m[(0, 0)])]
    }

    /// An object point in camera axes, object units.
    pub fn camera_from_world(&self, point: &Point3<f64>) -> Vector3<f64> {
        self.rotation * (point - self.centre)
    }

    /// The ray from the projection centre to an object point (object units), in camera axes.
    pub fn ray(&self, point: &Point3<f64>) -> Ray {
        let n = self.camera_from_world(point);
        Ray { x: n.x, y: n.y, z: n.z }
    }

    /// The direction of a ray in object axes, of the ray's own length.
    pub fn world_from_ray(&self, ray: Ray) -> Vector3<f64> {
        self.rotation.transpose() * Vector3::new(ray.x, ray.y, ray.z)
    }
}

/// The passive rotation about the camera's own z axis.
fn about_z(angle: f64) -> Matrix3<f64> {
    let (s, c) = angle.sin_cos();
    Matrix3::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn the_third_row_is_that_of_the_textbook() {
        let (omega, phi, kappa) = (0.3, -0.2, 1.1);
        let pose = Pose::from_angles(Point3::origin(), [omega, phi, kappa]);
        let expected = [phi.sin(), -omega.sin() * phi.cos(), omega.cos() * phi.cos()];
        for (column, expected) in expected.into_iter().enumerate() {
            assert!((pose.rotation[(2, column)] - expected).abs() < 1e-15);
        }
        assert!((pose.rotation * pose.rotation.transpose() - Matrix3::identity()).norm() < 1e-15);
        assert!((pose.rotation.determinant() - 1.0).abs() < 1e-15);
    }

    #[test]
    fn angles_go_both_ways() {
        for angles in [[0.3, -0.2, 1.1], [-3.0, 1.5, -2.9], [0.0, 0.0, 0.0], [2.0, -1.2, 3.1]] {
            let again = Pose::from_angles(Point3::origin(), angles).angles();
            assert!(angles.iter().zip(again).all(|(a, b)| (a - b).abs() < 1e-12), "{angles:?} {again:?}");
        }
        let steep = Pose::from_angles(Point3::origin(), [0.4, FRAC_PI_2, 0.3]);
        let again = Pose::from_angles(Point3::origin(), steep.angles());
        assert!((steep.rotation - again.rotation).norm() < 1e-12);
    }

    #[test]
    fn a_camera_sees_what_it_looks_at_in_the_middle_and_up_is_up() {
        let (centre, target) = (Point3::new(3.0, -2.0, 10.0), Point3::new(1.0, 1.0, 0.0));
        let pose = Pose::looking_at(centre, target, Vector3::y(), 0.0).unwrap();
        let (x, y) = pose.ray(&target).tangent().unwrap();
        assert!(x.abs() < 1e-15 && y.abs() < 1e-15);
        let (x, y) = pose.ray(&(target + Vector3::y() * 0.1)).tangent().unwrap();
        assert!(x.abs() < 1e-3 && y > 0.005, "{x} {y}");
        let rolled = Pose::looking_at(centre, target, Vector3::y(), FRAC_PI_2).unwrap();
        let (x, y) = rolled.ray(&(target + Vector3::y() * 0.1)).tangent().unwrap();
        assert!(x > 0.005 && y.abs() < 1e-3, "the picture turns clockwise: {x} {y}");
        assert!(Pose::looking_at(centre, centre, Vector3::y(), 0.0).is_none());
        assert!(Pose::looking_at(centre, centre - Vector3::y(), Vector3::y(), 0.0).is_none());
        let back = rolled.world_from_ray(rolled.ray(&target));
        assert!((back - (target - centre)).norm() < 1e-12);
    }
}
