//! Root mean square errors of points.

use nalgebra::Vector3;

/// Root mean squares of errors, in their unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rmse {
    /// Along X, Y and Z.
    pub axes: [f64; 3],
    /// In the plane of X and Y: `sqrt(mean(dx^2 + dy^2))`.
    pub planimetric: f64,
    /// In space.
    pub spatial: f64,
}

impl Rmse {
    /// Of all `errors`; not a number without any.
    pub fn of(errors: impl Iterator<Item = Vector3<f64>>) -> Self {
        let (sum, count) = errors.fold((Vector3::zeros(), 0_usize), |(sum, n), e| (sum + e.component_mul(&e), n + 1));
        let [x, y, z]: [f64; 3] = (sum / count as f64).into();
        Self { axes: [x, y, z].map(f64::sqrt), planimetric: (x + y).sqrt(), spatial: (x + y + z).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planimetric_is_of_x_and_y() {
        let errors = [Vector3::new(3.0, 4.0, 12.0), Vector3::new(-3.0, 4.0, -12.0), Vector3::zeros()];
        let found = Rmse::of(errors.into_iter());
        let times = (2.0_f64 / 3.0).sqrt();
        let expected = [3.0, 4.0, 12.0, 5.0, 13.0].map(|v| v * times);
        let found = [found.axes[0], found.axes[1], found.axes[2], found.planimetric, found.spatial];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        assert!(Rmse::of(std::iter::empty()).spatial.is_nan());
    }
}
