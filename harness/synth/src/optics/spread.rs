//! A profile tabulated over the pixel's phase, ready for the pixels around a point.

use super::profile::Profile;

/// Pixels are handled in groups of this many.
pub(crate) const LANES: usize = 4;

/// What a point at a real coordinate gives to each pixel around it: one row of weights for each phase of the coordinate, and linear interpolation between rows.
#[derive(Clone, Debug)]
pub(crate) struct Spread {
    reach: f64,
    phases: f64,
    /// Weights of one phase, a multiple of [`LANES`], the last ones zero.
    pub taps: usize,
    /// Those of them that are not zero.
    pub reached: usize,
    table: Vec<f64>,
}

impl Spread {
    /// The density around a coordinate: weight `k(u - pixel)` for each pixel.
    pub fn density(profile: &Profile) -> Self {
        Self::tabulate(profile, profile.reach(), |u| profile.density(u))
    }

    /// The slope of the density around a coordinate: weight `k'(u - pixel)` for each pixel.
    pub fn slope(profile: &Profile) -> Self {
        Self::tabulate(profile, profile.reach(), |u| profile.slope(u))
    }

    /// The integral over each pixel's width: weight `S(u - pixel + 1/2) - S(u - pixel - 1/2)`. They add up to one.
    pub fn steps(profile: &Profile) -> Self {
        Self::tabulate(profile, profile.reach() + 0.5, |u| profile.integral(u + 0.5) - profile.integral(u - 0.5))
    }

    fn tabulate(profile: &Profile, reach: f64, weight: impl Fn(f64) -> f64) -> Self {
        // Linear interpolation errs by h^2/8 times the second derivative, which is at most 0.25 / sigma^2 for steps of area one: below 4e-8.
        let phases = (900.0 / profile.sigma).ceil().max(512.0);
        let taps = ((2.0 * reach).ceil() as usize).next_multiple_of(LANES);
        // Where twice the reach is a whole number, both ends of it.
        let reached = ((2.0 * reach).floor() as usize + 1).min(taps);
        let row = |phase: usize| {
            let start = reach - phase as f64 / phases;
            let weight = &weight;
            (0..taps).map(move |tap| start - tap as f64).map(move |u| if u < -reach { 0.0 } else { weight(u) })
        };
        let table = (0..=phases as usize).flat_map(row).collect();
        Self { reach, phases, taps, reached, table }
    }

    /// How far from a coordinate pixels are touched, px.
    pub fn reach(&self) -> f64 {
        self.reach
    }

    /// The first pixel touched by coordinate `u`, the two rows of weights, and the share of the second.
    #[inline(always)]
    pub fn around(&self, u: f64) -> (i64, &[f64], &[f64], f64) {
        let start = u - self.reach;
        let first = start.ceil();
        let phase = (first - start) * self.phases;
        let below = (phase as usize).min(self.phases as usize - 1);
        let rows = &self.table[below * self.taps..(below + 2) * self.taps];
        let (low, high) = rows.split_at(self.taps);
        (first as i64, low, high, phase - below as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weights(spread: &Spread, u: f64) -> Vec<(i64, f64)> {
        let (first, low, high, share) = spread.around(u);
        low.iter().zip(high).enumerate().map(|(tap, (l, h))| (first + tap as i64, l + share * (h - l))).collect()
    }

    #[test]
    fn tables_agree_with_the_profile() {
        for (sigma, aperture, chord) in [(0.1, 1.0, 0.0), (0.3, 1.0, 0.0), (0.7, 0.8, 0.0), (2.0, 1.0, 0.0), (0.5, 1.0, 6.0)] {
            let profile = Profile { sigma, aperture, chord };
            let (density, steps) = (Spread::density(&profile), Spread::steps(&profile));
            for i in 0..1000 {
                let u = f64::from(i) * 0.617 - 100.0;
                for (pixel, weight) in weights(&density, u) {
                    let expected = profile.density(u - pixel as f64);
                    assert!((weight - expected).abs() < 2e-6, "{profile:?}: density at {}: {weight} {expected}", u - pixel as f64);
                }
                // On the table's first phase too, where the most pixels are reached.
                for u in [u, u.round() + density.reach] {
                    let beyond = weights(&density, u).split_off(density.reached);
                    assert!(beyond.iter().all(|(_, weight)| *weight == 0.0), "{profile:?}: at {u} {beyond:?}");
                }
                let mut sum = 0.0;
                for (pixel, weight) in weights(&steps, u + 0.5) {
                    let v = u - pixel as f64;
                    let expected = profile.integral(v + 1.0) - profile.integral(v);
                    assert!((weight - expected).abs() < 2e-7, "{profile:?}: step at {v}: {weight} {expected}");
                    sum += weight;
                }
                assert!((sum - 1.0).abs() < 1e-8, "{profile:?}: {sum}");
            }
        }
    }
}
