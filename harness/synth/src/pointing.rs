//! How a person points at a target: near it, and often at a whole pixel.

use calibench_model::PixelPoint;
use rand::Rng;
use rand_distr::{Distribution, Normal};

/// A pointing error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// Standard deviation of the hand per axis, px.
    pub sigma: f64,
    /// The pointer stops at whole pixels.
    pub whole_pixels: bool,
}

impl Hand {
    /// Where this hand points when the target is at `truth`.
    ///
    /// # Panics
    /// If `sigma` is negative or not finite: scenarios are checked before.
    pub fn point(&self, truth: PixelPoint, rng: &mut impl Rng) -> PixelPoint {
        let normal = Normal::new(0.0, self.sigma).expect("a finite standard deviation");
        let (x, y) = (truth.x + normal.sample(rng), truth.y + normal.sample(rng));
        if self.whole_pixels { PixelPoint::new(x.round(), y.round()) } else { PixelPoint::new(x, y) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_random::{Key, Purpose, stream};

    #[test]
    fn rounding_adds_a_twelfth_to_the_variance() {
        let hand = Hand { sigma: 0.5, whole_pixels: true };
        let n = 100_000;
        let mut rng = stream(Key { seed: 3, scenario: "hand", trial: 0, view: "", target: "" }, Purpose::Pointing);
        let squares = (0..n).map(|i| {
            let truth = PixelPoint::new(f64::from(i) * 0.618_033_988_749_895, 0.25);
            (hand.point(truth, &mut rng).x - truth.x).powi(2)
        });
        let variance = squares.sum::<f64>() / f64::from(n);
        let expected = 0.25 + 1.0 / 12.0;
        assert!((variance / expected - 1.0).abs() < 5.0 * (2.0 / f64::from(n)).sqrt(), "{variance} {expected}");
    }
}
