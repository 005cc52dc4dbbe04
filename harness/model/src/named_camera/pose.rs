//! Where a camera of a file stood.

use serde::{Deserialize, Serialize};

/// A camera's position and rotation, with the camera's axes of these tools: x right, y down, z forward.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Rotation from the world's axes to the camera's, 3 x 3, row by row.
    pub camera_from_world: [[f64; 3]; 3],
    /// Projection centre in the world, in its unit.
    pub position: [f64; 3],
}

/// What the world of a [`Pose`] is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum PoseFrame {
    /// That of the object.
    #[default]
    World,
    /// The first camera of a rig.
    FirstCamera,
    /// A rig's own frame, in which its first camera has a pose too.
    Rig,
    /// The inertial sensor of a rig.
    Imu,
}

/// 3 x 3, row by row.
type Matrix = [[f64; 3]; 3];

fn transposed(m: Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| m[column][row]))
}

fn product(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|row| std::array::from_fn(|column| (0..3).map(|k| a[row][k] * b[k][column]).sum()))
}

fn applied(m: Matrix, v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|row| (0..3).map(|k| m[row][k] * v[k]).sum())
}

/// `m` with y and z reversed in its rows: from axes x right, y up, z backwards to x right, y down, z forward, and back.
fn turned([x, y, z]: Matrix) -> Matrix {
    [x, y.map(|v| -v), z.map(|v| -v)]
}

impl Pose {
    /// No rotation, at the origin.
    pub const IDENTITY: Self = Self { camera_from_world: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], position: [0.0; 3] };

    /// Of `X_camera = R X_world + t`, R a rotation.
    pub fn of_rt(r: Matrix, t: [f64; 3]) -> Self {
        Self { camera_from_world: r, position: applied(transposed(r), t).map(|v| 0.0 - v) }
    }

    /// t of `X_camera = R X_world + t`.
    pub fn t(&self) -> [f64; 3] {
        applied(self.camera_from_world, self.position).map(|v| 0.0 - v)
    }

    /// Of `X_world = R X_camera + position`, R a rotation.
    pub fn of_camera_to_world(r: Matrix, position: [f64; 3]) -> Self {
        Self { camera_from_world: transposed(r), position }
    }

    /// Rotation from the camera's axes to the world's.
    pub fn world_from_camera(&self) -> Matrix {
        transposed(self.camera_from_world)
    }

    /// The same pose, of a camera whose file has y up and z backwards; its own inverse.
    #[must_use]
    pub fn with_y_and_z_reversed(self) -> Self {
        Self { camera_from_world: turned(self.camera_from_world), ..self }
    }

    /// This camera's pose as another camera sees it.
    #[must_use]
    pub fn seen_from(&self, other: &Self) -> Self {
        let camera_from_world = product(self.camera_from_world, other.world_from_camera());
        let between = std::array::from_fn(|i| self.position[i] - other.position[i]);
        Self { camera_from_world, position: applied(other.camera_from_world, between) }
    }

    /// The pose in the world of `other`, of a camera whose pose is given as `other` sees it: undoes [`Self::seen_from`].
    #[must_use]
    pub fn out_of(&self, other: &Self) -> Self {
        let shift = applied(other.world_from_camera(), self.position);
        let position = std::array::from_fn(|i| other.position[i] + shift[i]);
        Self { camera_from_world: product(self.camera_from_world, other.camera_from_world), position }
    }

    /// The pose of the camera after its own axes were turned: `X' = R X`, R 3 x 3, row by row.
    #[must_use]
    pub fn turned_by(&self, r: [[f64; 3]; 3]) -> Self {
        Self { camera_from_world: product(r, self.camera_from_world), ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Matrix, b: Matrix) -> bool {
        a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-14)
    }

    /// The rotation about z by an angle, then about x by another, radians.
    fn turn(z: f64, x: f64) -> Matrix {
        let ((sz, cz), (sx, cx)) = (z.sin_cos(), x.sin_cos());
        product([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]], [[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]])
    }

    #[test]
    fn relative_poses_come_back() {
        let pose = |[z, x]: [f64; 2], position| Pose { camera_from_world: turn(z, x), position };
        let (a, b) = (pose([0.3, 0.9], [1.0, 2.0, 3.0]), pose([-1.0, 0.2], [-4.0, 0.5, 2.0]));
        let back = b.seen_from(&a).out_of(&a);
        assert!(near(back.camera_from_world, b.camera_from_world));
        assert!(back.position.iter().zip(b.position).all(|(a, b)| (a - b).abs() < 1e-14));
        let rt = Pose::of_rt(b.camera_from_world, b.t());
        assert!(rt.position.iter().zip(b.position).all(|(a, b)| (a - b).abs() < 1e-14));
        assert_eq!(b.with_y_and_z_reversed().with_y_and_z_reversed(), b);
    }
}
