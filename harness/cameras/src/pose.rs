//! Where a camera stood, and the many ways in which files say it.

use calibench_model::named_camera::Pose;

use super::CameraFileError;

/// How far rows may be from perpendicular and of length one: files print six digits and fewer.
const ORTHONORMAL: f64 = 1e-3;

type Matrix = [[f64; 3]; 3];

/// The pose of `X_camera = R X_world + t`.
pub(super) fn of_rt(r: Matrix, t: [f64; 3]) -> Result<Pose, CameraFileError> {
    Ok(Pose::of_rt(rotation(r)?, t))
}

/// The pose of `X_world = R X_camera + position`.
pub(super) fn of_camera_to_world(r: Matrix, position: [f64; 3]) -> Result<Pose, CameraFileError> {
    Ok(Pose::of_camera_to_world(rotation(r)?, position))
}

/// Checked: a rotation.
pub(super) fn rotation(r: Matrix) -> Result<Matrix, CameraFileError> {
    let unit = |row: usize, column: usize| (0..3).map(|k| r[row][k] * r[column][k]).sum::<f64>();
    let off = |row: usize, column: usize| (unit(row, column) - f64::from(u8::from(row == column))).abs();
    let determinant = r[0][0] * (r[1][1] * r[2][2] - r[1][2] * r[2][1]) - r[0][1] * (r[1][0] * r[2][2] - r[1][2] * r[2][0])
        + r[0][2] * (r[1][0] * r[2][1] - r[1][1] * r[2][0]);
    let good = (0..9).all(|i| off(i / 3, i % 3) <= ORTHONORMAL) && determinant > 0.0;
    if good { Ok(r) } else { Err(CameraFileError::new("expected a rotation, found a matrix that is none")) }
}

/// Rotation and translation of a 4 x 4 or 3 x 4 matrix, row by row.
pub(super) fn rigid(rows: &[Vec<f64>]) -> Result<(Matrix, [f64; 3]), CameraFileError> {
    let shape = matches!(rows.len(), 3 | 4) && rows.iter().all(|row| row.len() == 4);
    if !shape || rows.get(3).is_some_and(|last| last[..] != [0.0, 0.0, 0.0, 1.0]) {
        return Err(CameraFileError::new("expected 4 x 4 numbers with 0 0 0 1 as the last row"));
    }
    Ok((std::array::from_fn(|row| std::array::from_fn(|column| rows[row][column])), std::array::from_fn(|row| rows[row][3])))
}

/// The rotation of a quaternion (x, y, z, w), of any length but none.
pub(super) fn of_quaternion(q: [f64; 4]) -> Result<Matrix, CameraFileError> {
    let length = q.iter().map(|v| v * v).sum::<f64>().sqrt();
    if !(length > 1e-6 && length.is_finite()) {
        return Err(CameraFileError::new("expected a quaternion, found one of no length"));
    }
    let [x, y, z, w] = q.map(|v| v / length);
    Ok([
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ])
}

/// The quaternion (x, y, z, w) of a rotation, w zero or more.
pub(super) fn quaternion(r: Matrix) -> [f64; 4] {
    let trace = r[0][0] + r[1][1] + r[2][2];
    let mut q = if trace > 0.0 {
        let s = 2.0 * (trace + 1.0).sqrt();
        [(r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s, 0.25 * s]
    } else {
        // The largest of x, y, z; its two followers in the cycle.
        let i = (0..3).max_by(|&a, &b| r[a][a].total_cmp(&r[b][b])).unwrap_or(0);
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let s = 2.0 * (1.0 + r[i][i] - r[j][j] - r[k][k]).max(0.0).sqrt();
        let mut q = [0.0; 4];
        (q[i], q[j], q[k], q[3]) = (0.25 * s, (r[j][i] + r[i][j]) / s, (r[k][i] + r[i][k]) / s, (r[k][j] - r[j][k]) / s);
        q
    };
    if q[3] < 0.0 {
        q = q.map(|v| -v);
    }
    q
}

/// The rotation of a vector along its axis, as long as its angle, radians.
pub(super) fn of_rotation_vector(v: [f64; 3]) -> Matrix {
    let angle = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (half_sin, half_cos) = (0.5 * angle).sin_cos();
    // sin(a/2) / a, which tends to 1/2.
    let s = if angle > 1e-8 { half_sin / angle } else { 0.5 };
    let q = [v[0] * s, v[1] * s, v[2] * s, half_cos];
    of_quaternion(q).unwrap_or(Pose::IDENTITY.camera_from_world)
}

/// The vector of a rotation.
pub(super) fn rotation_vector(r: Matrix) -> [f64; 3] {
    let [x, y, z, w] = quaternion(r);
    let sin = (x * x + y * y + z * z).sqrt();
    let scale = if sin > 1e-8 { 2.0 * sin.atan2(w) / sin } else { 2.0 };
    [x * scale, y * scale, z * scale]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Matrix, b: Matrix) -> bool {
        a.as_flattened().iter().zip(b.as_flattened()).all(|(a, b)| (a - b).abs() < 1e-14)
    }

    #[test]
    fn rotations_come_back() {
        for v in [[0.0; 3], [1e-10, 0.0, 0.0], [0.3, -0.2, 0.9], [3.1, 0.0, 0.1], [0.0, -3.1, 0.05], [2.0, 2.0, -1.0]] {
            let r = of_rotation_vector(v);
            assert!(near(of_rotation_vector(rotation_vector(r)), r), "{v:?}");
            assert!(near(of_quaternion(quaternion(r)).unwrap(), r), "{v:?}");
            assert_eq!(rotation(r), Ok(r));
        }
        // A quarter turn around z takes x to y.
        assert!(near(of_rotation_vector([0.0, 0.0, std::f64::consts::FRAC_PI_2]), [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]));
    }

    #[test]
    fn what_is_no_rotation_is_refused() {
        assert!(rotation([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]).is_err());
        assert!(rotation([[1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 1.0]]).is_err());
        assert!(rotation([[f64::NAN; 3]; 3]).is_err());
        assert!(of_quaternion([0.0; 4]).is_err());
        assert!(rigid(&[vec![1.0; 4], vec![1.0; 4]]).is_err());
    }
}
