//! Each stage against theory. Seeds were fixed beforehand; bounds are five standard errors unless they say otherwise.

mod emva;
mod noise;
mod order;
mod patterns;
mod pictures;
mod refused;
mod shading;
mod wells;

use calibench_model::Image;
use calibench_random::Key;

use super::{Design, Electrons, Exposure, Noise, Sensor};

pub(super) const KEY: Key<'_> = Key { seed: 20, of: "sensor", trial: 0, view: "a", target: "" };
/// Ten million pixels.
pub(super) const SIZE: (usize, usize) = (4000, 2500);

pub(super) fn flat((width, height): (usize, usize), light: f32) -> Image<'static> {
    Image::new(width, height, vec![light; width * height])
}

pub(super) fn electrons(electrons: Electrons) -> Design {
    Design { noise: Noise::Electrons(electrons), ..Design::default() }
}

pub(super) fn expose(design: Design, light: Image<'static>, key: Key<'_>) -> Exposure {
    Sensor::new(design).unwrap().expose(light, key).unwrap()
}

/// Errors of an image in some unit, and their moments.
pub(super) struct Errors {
    width: usize,
    values: Vec<f64>,
}

impl Errors {
    /// (grey - mean) * scale.
    pub fn of(image: &Image, mean: f64, scale: f64) -> Self {
        let values = image.grey().iter().map(|&grey| (f64::from(grey) - mean) * scale).collect();
        Self { width: image.width(), values }
    }

    pub fn count(&self) -> f64 {
        self.values.len() as f64
    }

    pub fn moment(&self, power: i32) -> f64 {
        self.values.iter().map(|error| error.powi(power)).sum::<f64>() / self.count()
    }

    /// Mean product with the error `columns` to the right and `rows` down.
    pub fn product(&self, columns: usize, rows: usize) -> f64 {
        let height = self.values.len() / self.width;
        let row = |y: usize| &self.values[y * self.width..(y + 1) * self.width];
        let sum: f64 = (0..height - rows).map(|y| row(y).iter().zip(&row(y + rows)[columns..]).map(|(a, b)| a * b).sum::<f64>()).sum();
        sum / ((height - rows) * (self.width - columns)) as f64
    }

    /// Mean product with another image's errors.
    pub fn product_with(&self, other: &Self) -> f64 {
        self.values.iter().zip(&other.values).map(|(a, b)| a * b).sum::<f64>() / self.count()
    }

    /// Asserts mean 0, `variance`, third cumulant `third` and whiteness; `fourth` is the fourth cumulant, for the variance's own error.
    pub fn assert_white(&self, variance: f64, third: f64, fourth: f64) {
        let n = self.count();
        let near = |what: &str, found: f64, expected: f64, sigma: f64| {
            assert!((found - expected).abs() <= 5.0 * sigma / n.sqrt(), "{what}: {found}, expected {expected} +- {}", sigma / n.sqrt());
        };
        near("mean", self.moment(1), 0.0, variance.sqrt());
        near("variance", self.moment(2), variance, (2.0 * variance * variance + fourth).sqrt());
        // Variance of a third moment about the true mean: m6 - m3^2, m6 from cumulants up to the fourth.
        let m6 = 15.0 * variance.powi(3) + 10.0 * third * third + 15.0 * fourth * variance;
        near("third moment", self.moment(3), third, m6.sqrt());
        for (columns, rows) in [(1, 0), (2, 0), (128, 0), (256, 0), (0, 1), (0, 64), (1, 1)] {
            near(&format!("product at {columns}, {rows}"), self.product(columns, rows), 0.0, variance);
        }
    }
}
