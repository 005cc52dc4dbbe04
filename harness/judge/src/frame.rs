//! What the unknown parameters of a camera do over the frame, after the best rotation.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, DerivativeBuffer};
use nalgebra::{DMatrix, DVector};

/// Modes of a difference whose predicted share of the variance is smaller are not tested: there the linear prediction is not what decides.
const SMALLEST: f64 = 1e-3;

/// Places of the frame, and how they move with the parameters.
pub struct Frame {
    /// d(x, y) / d(parameter), what a rotation makes up for taken off: rows x and y of each place.
    left: DMatrix<f64>,
    /// An orthonormal basis of what a rotation does.
    turns: DMatrix<f64>,
}

impl Frame {
    /// The places `at` of a camera with the unknowns `names`; `None` if one of them has no ray.
    pub fn new(camera: &Camera, names: &[&str], at: &[PixelPoint]) -> Option<Self> {
        let all = camera.parameters();
        let places: Vec<usize> = names.iter().filter_map(|name| all.iter().position(|parameter| parameter.name == *name)).collect();
        let mut slopes = DMatrix::zeros(2 * at.len(), places.len());
        let mut turns = DMatrix::zeros(2 * at.len(), 3);
        let mut buffer = DerivativeBuffer::default();
        for (k, at) in at.iter().enumerate() {
            let ray = camera.unproject(*at).ok()?;
            camera.derivatives_into(ray, &mut buffer).ok()?;
            for axis in 0..2 {
                let row = 2 * k + axis;
                places.iter().enumerate().for_each(|(j, &place)| slopes[(row, j)] = buffer.by_parameters()[place][axis]);
                let [gx, gy, gz] = buffer.by_ray[axis];
                let turn = [ray.y * gz - ray.z * gy, ray.z * gx - ray.x * gz, ray.x * gy - ray.y * gx];
                (0..3).for_each(|j| turns[(row, j)] = turn[j]);
            }
        }
        let turns = turns.svd(true, false).u?;
        let left = &slopes - &turns * turns.tr_mul(&slopes);
        Some(Self { left, turns })
    }

    /// The variance (2D, px^2) of each place for a covariance of the parameters, in the order of their `names` and in their units.
    pub fn variances(&self, covariance: &DMatrix<f64>) -> Vec<f64> {
        let of = |k: usize| {
            let rows = self.left.rows(2 * k, 2);
            (rows * covariance * rows.transpose()).trace().max(0.0)
        };
        (0..self.left.nrows() / 2).map(of).collect()
    }

    /// The mean variance (2D, px^2) over the places, and in how many modes it varies: `(sum l)^2 / sum l^2` of the variances l of all.
    pub fn spread(&self, covariance: &DMatrix<f64>) -> (f64, f64) {
        let places = self.left.nrows() as f64 / 2.0;
        let modes = covariance * self.left.tr_mul(&self.left);
        let (sum, squares) = (modes.trace(), (&modes * &modes).trace());
        (sum.max(0.0) / places, if squares > 0.0 { sum * sum / squares } else { 1.0 })
    }

    /// What a change of the parameters, in the order of their `names` and in their units, does over the frame: x and y of each place, px.
    pub fn moved(&self, change: &DVector<f64>) -> DVector<f64> {
        &self.left * change
    }

    /// A difference over the frame (x and y of each place, px) without what a rotation makes up for, px.
    pub fn without_rotation(&self, difference: &DVector<f64>) -> DVector<f64> {
        difference - &self.turns * self.turns.tr_mul(difference)
    }

    /// How a difference compares with a covariance of the parameters: the sum of the squares of its modes, each over its predicted standard deviation,
    /// and how many modes there are. Chi-square with so many degrees of freedom if the covariance is right. The difference is x and y of each place,
    /// px.
    pub fn chi_square(&self, difference: &DVector<f64>, covariance: &DMatrix<f64>) -> Option<(f64, usize)> {
        let root = nalgebra::Cholesky::new(covariance.clone())?;
        let svd = (&self.left * root.l()).svd(true, false);
        let (u, values) = (svd.u?, svd.singular_values);
        let total: f64 = values.iter().map(|value| value * value).sum();
        let tested = values.iter().enumerate().filter(|(_, value)| **value * **value > SMALLEST * total);
        let squares = tested.map(|(mode, value)| (u.column(mode).dot(difference) / value).powi(2));
        Some(squares.fold((0.0, 0), |(sum, count), square| (sum + square, count + 1)))
    }
}
