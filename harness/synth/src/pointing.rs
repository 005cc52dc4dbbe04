//! How a person points at a target: near it, and often at a whole pixel; and how well its map is known beforehand.

use calibench_model::{Affine, PixelPoint};
use rand::Rng;
use rand_distr::{Distribution, Normal, StandardNormal};

/// A pointing error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hand {
    /// Standard deviation of the hand per axis, px.
    pub sigma: f64,
    /// The pointer stops at whole pixels.
    pub whole_pixels: bool,
    /// How far off the map of the target's own plane is that is handed on with the position.
    pub map: MapError,
}

/// The error of an approximate map from a target's own plane to the image: as an approximate orientation of the camera gives it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct MapError {
    /// Standard deviation of a turn in the image, radians.
    pub turn: f64,
    /// Standard deviation of the logarithm of each own axis' length.
    pub stretch: f64,
}

impl MapError {
    /// A map that is off by a random turn and random lengths of both axes.
    pub fn apply(self, map: Affine, rng: &mut impl Rng) -> Affine {
        let [turn, u, v]: [f64; 3] = [0; 3].map(|_| StandardNormal.sample(rng));
        let (sine, cosine) = (self.turn * turn).sin_cos();
        let [u, v] = [u, v].map(|standard| (self.stretch * standard).exp());
        Affine {
            axx: u * (cosine * map.axx - sine * map.ayx),
            axy: v * (cosine * map.axy - sine * map.ayy),
            ayx: u * (sine * map.axx + cosine * map.ayx),
            ayy: v * (sine * map.axy + cosine * map.ayy),
        }
    }
}

impl Hand {
    /// Whether it does not shake, whether it stops at whole pixels or not.
    pub fn is_steady(&self) -> bool {
        self.sigma == 0.0 && self.map == MapError::default()
    }

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
        let hand = Hand { sigma: 0.5, whole_pixels: true, map: MapError::default() };
        let n = 100_000;
        let mut rng = stream(Key { seed: 3, of: "hand", trial: 0, view: "", target: "" }, Purpose::Pointing);
        let squares = (0..n).map(|i| {
            let truth = PixelPoint::new(f64::from(i) * 0.618_033_988_749_895, 0.25);
            (hand.point(truth, &mut rng).x - truth.x).powi(2)
        });
        let variance = squares.sum::<f64>() / f64::from(n);
        let expected = 0.25 + 1.0 / 12.0;
        assert!((variance / expected - 1.0).abs() < 5.0 * (2.0 / f64::from(n)).sqrt(), "{variance} {expected}");
    }

    /// Turn and lengths have their standard deviations; without any the map is as it was.
    #[test]
    fn a_map_is_off_by_what_is_said() {
        let (map, n) = (Affine { axx: 3.0, axy: -1.0, ayx: 4.0, ayy: 7.0 }, 20_000);
        let mut rng = stream(Key { seed: 4, of: "map", trial: 0, view: "", target: "" }, Purpose::Pointing);
        assert_eq!(MapError::default().apply(map, &mut rng), map);
        let error = MapError { turn: 0.1, stretch: 0.05 };
        let (mut turns, mut lengths) = (0.0, [0.0; 2]);
        for _ in 0..n {
            let found = error.apply(map, &mut rng);
            turns += (found.ayx.atan2(found.axx) - map.ayx.atan2(map.axx)).powi(2);
            lengths[0] += (found.axx.hypot(found.ayx) / 5.0).ln().powi(2);
            lengths[1] += (found.axy.hypot(found.ayy) / 50_f64.sqrt()).ln().powi(2);
            let angle = (found.axx * found.axy + found.ayx * found.ayy) / (found.axx.hypot(found.ayx) * found.axy.hypot(found.ayy));
            assert!((angle - 25.0 / (5.0 * 50_f64.sqrt())).abs() < 1e-12, "both axes turn alike");
        }
        for (square, sigma) in [(turns, 0.1), (lengths[0], 0.05), (lengths[1], 0.05)] {
            assert!((square / f64::from(n) / (sigma * sigma) - 1.0).abs() < 5.0 * (2.0 / f64::from(n)).sqrt(), "{square} {sigma}");
        }
    }
}
