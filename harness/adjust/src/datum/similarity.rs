//! What leaves all image coordinates as they are: shift, rotation and scale of the object and the cameras together.

use calibench_model::Pose;
use nalgebra::{Matrix3, Point3, Rotation3, Vector3};

use crate::network::Network;

/// Shifts along X, Y, Z, rotations about them, scale.
pub(super) const COUNT: usize = 7;

/// How many of them the observations leave to the datum: distances give the scale, the last.
pub(crate) fn free(network: &Network) -> usize {
    COUNT - usize::from(!network.distances.is_empty())
}

/// Names of the generators.
pub(super) const NAMES: [&str; COUNT] =
    ["origin in X", "origin in Y", "origin in Z", "rotation about X", "rotation about Y", "rotation about Z", "scale"];

/// Similarities about a centre. Rotations and scale are per `length`, so that all seven move the object alike.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Similarity {
    centre: Point3<f64>,
    length: f64,
}

impl Similarity {
    /// About the middle of `points`.
    pub(crate) fn about<'p>(points: impl Iterator<Item = &'p Point3<f64>> + Clone) -> Self {
        let count = points.clone().count().max(1) as f64;
        let centre = Point3::from(points.clone().map(|point| point.coords).sum::<Vector3<f64>>() / count);
        let spread = (points.map(|point| (point - centre).norm_squared()).sum::<f64>() / count).sqrt();
        Self { centre, length: if spread > 0.0 { spread } else { 1.0 } }
    }

    /// d(position) / d(generator).
    pub(crate) fn of_point(&self, point: &Point3<f64>) -> [[f64; 3]; COUNT] {
        let from = (point - self.centre) / self.length;
        std::array::from_fn(|k| match k {
            0..3 => Vector3::ith(k, 1.0).into(),
            3..6 => Vector3::ith(k - 3, 1.0).cross(&from).into(),
            _ => from.into(),
        })
    }

    /// d(pose) / d(generator): a small rotation about the camera's axes, a shift along them.
    pub(crate) fn of_pose(&self, pose: &Pose) -> [[f64; 6]; COUNT] {
        let shifts = self.of_point(&pose.centre);
        std::array::from_fn(|k| {
            // M turns with the object: M exp(-w) = exp(-M w) M; N + s with s = -M dX0.
            let turn = if (3..6).contains(&k) { -pose.rotation.column(k - 3) / self.length } else { Vector3::zeros() };
            let shift = -(pose.rotation * Vector3::from(shifts[k]));
            [turn.x, turn.y, turn.z, shift.x, shift.y, shift.z]
        })
    }

    /// The similarity with these amounts, of the first generators or of all.
    pub(crate) fn with(&self, amounts: &[f64]) -> Motion {
        let a = |k: usize| amounts.get(k).copied().unwrap_or_default();
        let turn = Rotation3::new(Vector3::new(a(3), a(4), a(5)) / self.length);
        Motion { centre: self.centre, shift: Vector3::new(a(0), a(1), a(2)), turn: *turn.matrix(), scale: 1.0 + a(6) / self.length }
    }
}

/// A similarity: `X -> centre + shift + scale R (X - centre)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion {
    centre: Point3<f64>,
    shift: Vector3<f64>,
    turn: Matrix3<f64>,
    scale: f64,
}

impl Motion {
    pub(crate) fn point(&self, point: &Point3<f64>) -> Point3<f64> {
        self.centre + self.shift + self.turn * (point - self.centre) * self.scale
    }

    pub(crate) fn pose(&self, pose: &Pose) -> Pose {
        Pose { rotation: pose.rotation * self.turn.transpose(), centre: self.point(&pose.centre) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generators_are_the_slopes_of_motions_and_rays_do_not_change() {
        let points = [Point3::new(1.0, 2.0, 3.0), Point3::new(-2.0, 0.5, 1.0), Point3::new(4.0, -1.0, 0.2)];
        let similarity = Similarity::about(points.iter());
        let pose = Pose::from_angles(Point3::new(3.0, -4.0, 12.0), [0.3, -0.4, 1.2]);
        for k in 0..COUNT {
            let motion = |h: f64| similarity.with(&std::array::from_fn::<f64, COUNT, _>(|i| if i == k { h } else { 0.0 }));
            let (high, low) = (motion(1e-5), motion(-1e-5));
            let slope = (high.point(&points[0]) - low.point(&points[0])) / 2e-5;
            assert!((slope - Vector3::from(similarity.of_point(&points[0])[k])).norm() < 1e-9);
            let found = similarity.of_pose(&pose)[k];
            let shift = -(pose.rotation * (high.pose(&pose).centre - low.pose(&pose).centre)) / 2e-5;
            let turn = crate::state::rotation_vector(&(high.pose(&pose).rotation * low.pose(&pose).rotation.transpose())) / 2e-5;
            assert!((0..3).all(|i| (found[i] - turn[i]).abs() < 1e-9 && (found[i + 3] - shift[i]).abs() < 1e-9), "{k}");
            let (ray, moved) = (pose.ray(&points[1]), motion(0.3).pose(&pose).ray(&motion(0.3).point(&points[1])));
            assert!(ray.angle_to(moved) < 1e-12);
        }
    }
}
