//! Rotations of rays.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::grid::Sight;
use crate::camera::{CameraModel, Ray};

/// A rotation of rays, in the axes of [`Ray`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotation(Rotation3<f64>);

impl Rotation {
    /// None.
    pub fn identity() -> Self {
        Self(Rotation3::identity())
    }

    /// About `vector` by its length, radians.
    pub fn from_vector(vector: [f64; 3]) -> Self {
        Self(Rotation3::new(Vector3::from(vector)))
    }

    /// The axis times the angle, radians.
    pub fn vector(&self) -> [f64; 3] {
        self.0.scaled_axis().into()
    }

    /// The angle, radians, 0 to pi.
    pub fn angle(&self) -> f64 {
        // From the antisymmetric part as well: the trace alone loses small angles.
        let m = self.0.matrix();
        let sine = Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]).norm();
        sine.atan2(m.trace() - 1.0)
    }

    /// The rotated ray.
    pub fn apply(&self, ray: Ray) -> Ray {
        let [x, y, z] = (self.0 * vector(ray)).into();
        Ray { x, y, z }
    }

    /// This rotation followed by a small one.
    #[must_use]
    pub(super) fn then(&self, small: [f64; 3]) -> Self {
        let mut product = Rotation3::new(Vector3::from(small)) * self.0;
        product.renormalize();
        Self(product)
    }
}

fn vector(ray: Ray) -> Vector3<f64> {
    Vector3::new(ray.x, ray.y, ray.z)
}

/// d(x, y) / d(small rotation) of a rotated ray, from d(x, y) / d(ray).
pub(super) fn by_rotation(by_ray: &[[f64; 3]; 2], rotated: Ray) -> [[f64; 3]; 2] {
    // d(ray) = omega x ray; g . (omega x ray) = omega . (ray x g).
    by_ray.map(|g| vector(rotated).cross(&Vector3::from(g)).into())
}

/// The rotation that brings the rays of the sights closest to those by which `other` sees the same pixels: a start for the fit in the image.
///
/// Source: Arun, Huang and Blostein 1987.
pub(super) fn between(sights: &[Sight], other: &dyn CameraModel) -> Rotation {
    let mut products = Matrix3::zeros();
    for sight in sights {
        if let Ok(ray) = other.unproject(sight.node.point) {
            products += vector(ray).normalize() * vector(sight.ray).normalize().transpose() * sight.node.weight;
        }
    }
    let svd = products.svd(true, true);
    let (Some(u), Some(v_t)) = (svd.u, svd.v_t) else { return Rotation::identity() };
    let handed = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, (u * v_t).determinant().signum()));
    let matrix = u * handed * v_t;
    if matrix.iter().all(|value| value.is_finite()) { Rotation(Rotation3::from_matrix_unchecked(matrix)) } else { Rotation::identity() }
}
