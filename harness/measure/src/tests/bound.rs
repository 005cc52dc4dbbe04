//! Errors in units of the Cramér-Rao bound, for white noise.

use nalgebra::SMatrix;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};

/// White noise of standard deviation `sigma` from a stream of its own.
pub(crate) fn noisy(grey: &[f64], sigma: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let normal = Normal::new(0.0, sigma).unwrap();
    grey.iter().map(|g| g + normal.sample(rng)).collect()
}

/// The Cramér-Rao bound of the first two of `P` unknowns for white noise of unit variance: its trace, px^2.
pub(crate) fn bound<const P: usize>(at: [f64; P], render: impl Fn(&[f64; P]) -> Vec<f64>) -> f64 {
    let derivative = |i: usize| {
        let shifted = |h: f64| {
            let mut x = at;
            x[i] += h;
            render(&x)
        };
        let (high, low) = (shifted(1e-4), shifted(-1e-4));
        high.iter().zip(&low).map(|(h, l)| (h - l) / 2e-4).collect::<Vec<_>>()
    };
    let j: Vec<Vec<f64>> = (0..P).map(derivative).collect();
    let n = SMatrix::<f64, P, P>::from_fn(|a, b| j[a].iter().zip(&j[b]).map(|(a, b)| a * b).sum());
    let inverse = n.try_inverse().expect("all unknowns are determined");
    inverse[(0, 0)] + inverse[(1, 1)]
}

/// Squared errors in units of the bound, pooled: their number, mean and standard error.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Pool {
    n: f64,
    sum: f64,
    squares: f64,
}

impl Pool {
    pub(crate) fn add(&mut self, value: f64) {
        self.n += 1.0;
        self.sum += value;
        self.squares += value * value;
    }

    pub(crate) fn join(&mut self, other: &Self) {
        self.n += other.n;
        self.sum += other.sum;
        self.squares += other.squares;
    }

    pub(crate) fn trials(&self) -> usize {
        self.n as usize
    }

    /// The root of the mean, and its 99 % interval.
    pub(crate) fn ratio(&self) -> (f64, [f64; 2]) {
        self.within(2.576)
    }

    /// The root of the mean, and its interval of so many standard errors of the mean.
    pub(crate) fn within(&self, errors: f64) -> (f64, [f64; 2]) {
        let mean = self.sum / self.n;
        let error = ((self.squares / self.n - mean * mean).max(0.0) / self.n).sqrt();
        (mean.sqrt(), [(mean - errors * error).max(0.0).sqrt(), (mean + errors * error).sqrt()])
    }
}
