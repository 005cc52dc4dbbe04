//! The separable part of a point spread: boxes convolved with a Gaussian, in one dimension.

use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// A Gaussian convolved with up to two boxes: the photosite's aperture and, for a defocus disc, a chord of the disc. Area 1, centred at 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Profile {
    /// Standard deviation, px, positive.
    pub sigma: f64,
    /// Width of the aperture, px, positive.
    pub aperture: f64,
    /// Width of the second box, px; 0 if there is none.
    pub chord: f64,
}

/// How many standard deviations of the Gaussian are kept: what lies beyond is 2e-9 of it.
const TAIL: f64 = 6.0;

impl Profile {
    /// Where the profile ends, px from its centre.
    pub fn reach(&self) -> f64 {
        (self.aperture + self.chord) / 2.0 + TAIL * self.sigma
    }

    /// The profile at `u`, px^-1.
    pub fn density(&self, u: f64) -> f64 {
        let cdf = |u: f64| cumulative(u / self.sigma);
        let once = |u: f64| self.once(u);
        if self.chord > 0.0 { difference(once, u, self.aperture, self.chord) } else { centred(cdf, u, self.aperture) }
    }

    /// The slope of the density at `u`, px^-2.
    pub fn slope(&self, u: f64) -> f64 {
        let cdf = |u: f64| cumulative(u / self.sigma);
        let gauss = |u: f64| density(u / self.sigma) / self.sigma;
        if self.chord > 0.0 { difference(cdf, u, self.aperture, self.chord) } else { centred(gauss, u, self.aperture) }
    }

    /// The integral of the profile from minus infinity to `u`.
    pub fn integral(&self, u: f64) -> f64 {
        let once = |u: f64| self.once(u);
        let twice = |u: f64| self.twice(u);
        if self.chord > 0.0 { difference(twice, u, self.aperture, self.chord) } else { centred(once, u, self.aperture) }
    }

    /// The integral of the Gaussian's cumulative distribution.
    fn once(&self, u: f64) -> f64 {
        let s = u / self.sigma;
        u * cumulative(s) + self.sigma * density(s)
    }

    /// The integral of [`Self::once`].
    fn twice(&self, u: f64) -> f64 {
        let s = u / self.sigma;
        0.5 * ((u * u + self.sigma * self.sigma) * cumulative(s) + u * self.sigma * density(s))
    }
}

fn centred(f: impl Fn(f64) -> f64, u: f64, width: f64) -> f64 {
    (f(u + width / 2.0) - f(u - width / 2.0)) / width
}

fn difference(f: impl Fn(f64) -> f64, u: f64, a: f64, b: f64) -> f64 {
    centred(|u| centred(&f, u, a), u, b)
}

/// The standard normal density.
fn density(s: f64) -> f64 {
    (-0.5 * s * s).exp() / (2.0 * PI).sqrt()
}

/// The standard normal distribution function.
fn cumulative(s: f64) -> f64 {
    0.5 * libm::erfc(-s * FRAC_1_SQRT_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROFILES: [Profile; 4] = [
        Profile { sigma: 0.3, aperture: 1.0, chord: 0.0 },
        Profile { sigma: 0.7, aperture: 0.8, chord: 0.0 },
        Profile { sigma: 0.4, aperture: 1.0, chord: 0.4 },
        Profile { sigma: 1.1, aperture: 0.9, chord: 5.0 },
    ];

    #[test]
    fn the_density_is_the_integrals_slope_and_the_area_is_one() {
        for profile in PROFILES {
            let reach = profile.reach();
            assert!(profile.integral(-reach).abs() < 1e-9 && (profile.integral(reach) - 1.0).abs() < 1e-9, "{profile:?}");
            for i in -50..=50 {
                let (u, h) = (reach * f64::from(i) / 50.0, 1e-4);
                let slope = (profile.integral(u + h) - profile.integral(u - h)) / (2.0 * h);
                assert!((slope - profile.density(u)).abs() < 1e-6, "{profile:?} at {u}: {slope} {}", profile.density(u));
                let bend = (profile.density(u + h) - profile.density(u - h)) / (2.0 * h);
                assert!((bend - profile.slope(u)).abs() < 1e-6, "{profile:?} at {u}: {bend} {}", profile.slope(u));
            }
        }
    }

    #[test]
    fn variances_add_up() {
        for profile in PROFILES {
            let (n, reach) = (4000, profile.reach());
            let h = 2.0 * reach / f64::from(n);
            let second: f64 = (0..n).map(|i| -reach + (f64::from(i) + 0.5) * h).map(|u| u * u * profile.density(u) * h).sum();
            let expected = profile.sigma.powi(2) + (profile.aperture.powi(2) + profile.chord.powi(2)) / 12.0;
            assert!((second - expected).abs() < 1e-6 * (1.0 + expected), "{profile:?}: {second} {expected}");
        }
    }
}
