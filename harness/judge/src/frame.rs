//! What the unknown parameters of a camera do over the frame, after the best rotation: means over its area.

use calibench_model::PixelPoint;
use calibench_model::camera::{Camera, CameraModel, DerivativeBuffer, ImageSize};
use calibench_model::convert::cell_share;
use nalgebra::{DMatrix, DVector};

/// Modes of a difference whose predicted share of the variance is smaller are not tested: there the linear prediction is not what decides.
const SMALLEST: f64 = 1e-3;

/// The weights of places of a grid from the first pixel to the last for means over the area, their mean 1.
pub fn weights(size: ImageSize, at: &[PixelPoint]) -> Vec<f64> {
    let cells: Vec<f64> = at.iter().map(|at| cell_share(size, *at)).collect();
    let mean = cells.iter().sum::<f64>() / cells.len() as f64;
    cells.into_iter().map(|cell| cell / mean).collect()
}

/// Places of a grid over the frame, and how they move with the parameters.
pub struct Frame {
    /// d(x, y) / d(parameter), what a rotation makes up for taken off: rows x and y of each place, times the root of its weight.
    left: DMatrix<f64>,
    /// An orthonormal basis of what a rotation does, in the same way.
    turns: DMatrix<f64>,
    /// The root of each place's weight, twice.
    roots: DVector<f64>,
}

impl Frame {
    /// The places `at` of a camera with the unknowns `names`; `None` if one of them has no ray.
    pub fn new(camera: &Camera, names: &[&str], at: &[PixelPoint]) -> Option<Self> {
        let all = camera.parameters();
        let places: Vec<usize> = names.iter().filter_map(|name| all.iter().position(|parameter| parameter.name == *name)).collect();
        let mut slopes = DMatrix::zeros(2 * at.len(), places.len());
        let mut turns = DMatrix::zeros(2 * at.len(), 3);
        let weights = weights(camera.size(), at);
        let roots = DVector::from_fn(2 * at.len(), |row, _| weights[row / 2].sqrt());
        let mut buffer = DerivativeBuffer::default();
        for (k, at) in at.iter().enumerate() {
            let ray = camera.unproject(*at).ok()?;
            camera.derivatives_into(ray, &mut buffer).ok()?;
            for axis in 0..2 {
                let row = 2 * k + axis;
                places.iter().enumerate().for_each(|(j, &place)| slopes[(row, j)] = roots[row] * buffer.by_parameters()[place][axis]);
                let [gx, gy, gz] = buffer.by_ray[axis];
                let turn = [ray.y * gz - ray.z * gy, ray.z * gx - ray.x * gz, ray.x * gy - ray.y * gx];
                (0..3).for_each(|j| turns[(row, j)] = roots[row] * turn[j]);
            }
        }
        let turns = turns.svd(true, false).u?;
        let left = &slopes - &turns * turns.tr_mul(&slopes);
        Some(Self { left, turns, roots })
    }

    /// The variance (2D, px^2) of each place for a covariance of the parameters, in the order of their `names` and in their units.
    pub fn variances(&self, covariance: &DMatrix<f64>) -> Vec<f64> {
        let of = |k: usize| {
            let rows = self.left.rows(2 * k, 2);
            (rows * covariance * rows.transpose()).trace().max(0.0) / self.roots[2 * k].powi(2)
        };
        (0..self.left.nrows() / 2).map(of).collect()
    }

    /// The mean variance (2D, px^2) over the area, and in how many modes it varies: `(sum l)^2 / sum l^2` of the variances l of all.
    pub fn spread(&self, covariance: &DMatrix<f64>) -> (f64, f64) {
        let places = self.left.nrows() as f64 / 2.0;
        let modes = covariance * self.left.tr_mul(&self.left);
        let (sum, squares) = (modes.trace(), (&modes * &modes).trace());
        (sum.max(0.0) / places, if squares > 0.0 { sum * sum / squares } else { 1.0 })
    }

    /// What a change of the parameters, in the order of their `names` and in their units, does over the frame: the mean square over the area, px^2 (2D).
    pub fn moved(&self, change: &DVector<f64>) -> f64 {
        (&self.left * change).norm_squared() / (self.roots.len() as f64 / 2.0)
    }

    /// A difference over the frame (x and y of each place, px) without what a rotation makes up for, px.
    pub fn without_rotation(&self, difference: &DVector<f64>) -> DVector<f64> {
        let weighted = difference.component_mul(&self.roots);
        (&weighted - &self.turns * self.turns.tr_mul(&weighted)).component_div(&self.roots)
    }

    /// How a difference compares with a covariance of the parameters: the sum of the squares of its modes, each over its predicted standard deviation,
    /// and how many modes there are. Chi-square with so many degrees of freedom if the covariance is right. The difference is x and y of each place,
    /// px.
    pub fn chi_square(&self, difference: &DVector<f64>, covariance: &DMatrix<f64>) -> Option<(f64, usize)> {
        let difference = difference.component_mul(&self.roots);
        let root = nalgebra::Cholesky::new(covariance.clone())?;
        let svd = (&self.left * root.l()).svd(true, false);
        let (u, values) = (svd.u?, svd.singular_values);
        let total: f64 = values.iter().map(|value| value * value).sum();
        let tested = values.iter().enumerate().filter(|(_, value)| **value * **value > SMALLEST * total);
        let squares = tested.map(|(mode, value)| (u.column(mode).dot(&difference) / value).powi(2));
        Some(squares.fold((0.0, 0), |(sum, count), square| (sum + square, count + 1)))
    }
}

#[cfg(test)]
mod tests {
    use calibench_adjust::{Distance, frame_weight};
    use calibench_model::camera::OpenCv;

    use super::*;

    /// The mean over the area is that of calibrations, whose way to it is another.
    #[test]
    fn the_mean_over_the_frame_is_that_of_calibrations() {
        let (size, mut distortion) = (ImageSize { width: 640, height: 480 }, [0.0; 14]);
        distortion[..2].copy_from_slice(&[-0.2, 0.1]);
        let camera = Camera::from(OpenCv { size, fx: 500.0, fy: 501.0, cx: 322.0, cy: 236.0, distortion, coefficients: 5 });
        let names = ["fx", "fy", "cx", "cy", "k1", "k2"];
        let place = |k: usize| PixelPoint::new(639.0 * (k % 13) as f64 / 12.0, 479.0 * (k / 13) as f64 / 9.0);
        let at: Vec<PixelPoint> = (0..130).map(place).collect();
        let covariance = DMatrix::from_diagonal(&DVector::from_row_slice(&[0.04, 0.04, 0.09, 0.09, 1e-6, 1e-5]));
        let (mean, _) = Frame::new(&camera, &names, &at).unwrap().spread(&covariance);
        let weight = frame_weight(&camera, &names, (13, 10), Distance::Far).unwrap();
        assert!((mean / (weight * &covariance).trace() - 1.0).abs() < 1e-9, "{mean}");
        // Variances of places are those without weights.
        let variances = Frame::new(&camera, &names, &at).unwrap().variances(&covariance);
        let weighted: f64 = variances.iter().zip(weights(size, &at)).map(|(variance, weight)| variance * weight).sum();
        assert!((weighted / 130.0 / mean - 1.0).abs() < 1e-9);
    }
}
