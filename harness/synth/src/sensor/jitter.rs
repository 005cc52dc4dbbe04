//! Rows that are read out of their place. The shift is geometry: the renderer's work.

use calibench_random::{Key, Purpose, stream};
use rand_distr::{Distribution, StandardNormal};

/// How far each of `height` rows is shifted along x, px: independent normal numbers of standard deviation `sigma` px, new in each image.
pub fn row_shifts(sigma: f64, height: usize, key: Key<'_>) -> Vec<f64> {
    let mut rng = stream(key, Purpose::RowJitter);
    let mut shift = || -> f64 { StandardNormal.sample(&mut rng) };
    (0..height).map(|_| sigma * shift()).collect()
}
