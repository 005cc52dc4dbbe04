//! The tilt of the sensor against the lens.

use nalgebra::{Matrix3, Vector3};

use crate::camera::newton::ValueAndDerivatives;

/// The projective map of a tilted sensor: `P R`, `R = R_y(ty) R_x(tx)`, `P = [R33 0 -R13; 0 R33 -R23; 0 0 1]`.
pub(super) struct Tilt {
    matrix: Matrix3<f64>,
    by_x: Matrix3<f64>,
    by_y: Matrix3<f64>,
}

/// P of a rotation, or its derivative of the rotation's; `one` is the last element.
fn projection(r: &Matrix3<f64>, one: f64) -> Matrix3<f64> {
    Matrix3::new(r[(2, 2)], 0.0, -r[(0, 2)], 0.0, r[(2, 2)], -r[(1, 2)], 0.0, 0.0, one)
}

impl Tilt {
    /// The tilt by `x` and `y`, radians.
    pub(super) fn new(x: f64, y: f64) -> Self {
        let ((sx, cx), (sy, cy)) = (x.sin_cos(), y.sin_cos());
        let about_x = Matrix3::new(1.0, 0.0, 0.0, 0.0, cx, sx, 0.0, -sx, cx);
        let about_y = Matrix3::new(cy, 0.0, -sy, 0.0, 1.0, 0.0, sy, 0.0, cy);
        let slope_x = Matrix3::new(0.0, 0.0, 0.0, 0.0, -sx, cx, 0.0, -cx, -sx);
        let slope_y = Matrix3::new(-sy, 0.0, -cy, 0.0, 0.0, 0.0, cy, 0.0, -sy);
        let rotation = about_y * about_x;
        let projected = projection(&rotation, 1.0);
        let by = |slope: Matrix3<f64>| projection(&slope, 0.0) * rotation + projected * slope;
        Self { matrix: projected * rotation, by_x: by(about_y * slope_x), by_y: by(slope_y * about_x) }
    }

    /// The tilted coordinates, with their derivatives; not numbers behind the sensor.
    pub(super) fn apply(&self, [x, y]: [f64; 2]) -> ValueAndDerivatives {
        let m = &self.matrix;
        let v = m * Vector3::new(x, y, 1.0);
        let inverse = if v.z > 0.0 { 1.0 / v.z } else { f64::NAN };
        let value = [v.x * inverse, v.y * inverse];
        let by = std::array::from_fn(|row| std::array::from_fn(|column| (m[(row, column)] - value[row] * m[(2, column)]) * inverse));
        (value, by)
    }

    /// d(tilted) / d(tx, ty).
    pub(super) fn by_angles(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        let at = Vector3::new(x, y, 1.0);
        let v = self.matrix * at;
        let of = |by: &Matrix3<f64>| {
            let d = by * at;
            [(d.x - v.x / v.z * d.z) / v.z, (d.y - v.y / v.z * d.z) / v.z]
        };
        [of(&self.by_x), of(&self.by_y)]
    }

    /// The matrix and its derivatives by x and y, each row by row.
    pub(super) fn all_rows(&self) -> [[[f64; 3]; 3]; 3] {
        [rows(&self.matrix), rows(&self.by_x), rows(&self.by_y)]
    }

    /// What undoes it, row by row; not numbers if nothing does.
    pub(super) fn inverse_rows(&self) -> [[f64; 3]; 3] {
        self.matrix.try_inverse().map_or([[f64::NAN; 3]; 3], |inverse| rows(&inverse))
    }
}

fn rows(m: &Matrix3<f64>) -> [[f64; 3]; 3] {
    std::array::from_fn(|row| std::array::from_fn(|column| m[(row, column)]))
}
