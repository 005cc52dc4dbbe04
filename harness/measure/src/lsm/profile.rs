//! What a blurred pixel sees of a point and of a half-plane, along one axis.

/// Fractions of a px at which the profile is tabulated; between them it is a Taylor series.
const STEPS: usize = 16;
/// The most pixels along an axis of a window, a multiple of the lanes.
pub(super) const PIXELS: usize = 48;
/// How far the Gaussian reaches, in standard deviations: less than 4e-6 of it is left beyond.
const REACH: f64 = 4.5;

/// The profile of a pixel one px wide under a Gaussian, and its integral, at all pixels around a point.
///
/// With `phi` the normal density, `Phi` its integral and `u = (t -+ 1/2) / sigma`, the profile at distance `t` is `k(t) = Phi(u+) - Phi(u-)` and
/// its integral `W(t) = sigma (G(u+) - G(u-))`, `G(u) = u Phi(u) + phi(u)`: a pixel at `x` sees `W(p - x)` of everything left of `p`.
/// The pixels lie at whole distances, so that they share the fraction of a px and with it one row of the table.
#[derive(Clone, Debug)]
pub(super) struct Profile {
    sigma: f64,
    half: usize,
    /// For each fraction, for each pixel: W, k and the first four derivatives of k.
    table: Vec<[f64; 6]>,
}

impl Profile {
    /// With a Gaussian of standard deviation `sigma` px, more than 0.
    pub(super) fn new(sigma: f64) -> Self {
        let mut profile = Self { sigma: 0.0, half: 0, table: Vec::new() };
        profile.set(sigma);
        profile
    }

    /// Changes the standard deviation; the table's memory is used again.
    pub(super) fn set(&mut self, sigma: f64) {
        if sigma == self.sigma {
            return;
        }
        (self.sigma, self.half) = (sigma, (0.5 + REACH * sigma).ceil() as usize);
        self.table.clear();
        for step in 0..STEPS {
            let fraction = (step as f64 + 0.5) / STEPS as f64;
            let mut above = Boundary::new(fraction + self.half as f64 + 0.5, sigma);
            for pixel in 0..self.width() {
                let below = Boundary::new(fraction + self.half as f64 - pixel as f64 - 0.5, sigma);
                self.table.push(std::array::from_fn(|i| above.0[i] - below.0[i]));
                above = below;
            }
        }
    }

    /// Its standard deviation, px.
    pub(super) fn sigma(&self) -> f64 {
        self.sigma
    }

    /// Pixels that see a point.
    pub(super) fn width(&self) -> usize {
        2 * self.half + 2
    }

    /// How far from a point they lie at most, px.
    pub(super) fn reach(&self) -> f64 {
        self.half as f64 + 1.0
    }

    /// Samples of all pixels from 0 on for the point `at`; returns the pixels that see it, as far as `axis` reaches.
    /// Outside these the value is zero and the integral one (before the point) or zero (after it).
    #[inline(always)]
    pub(super) fn sample(&self, at: f64, axis: &mut Axis) -> (usize, usize) {
        let whole = at.floor();
        let scaled = (at - whole) * STEPS as f64;
        let step = (scaled as usize).min(STEPS - 1);
        let d = (scaled - step as f64 - 0.5) / STEPS as f64;
        let first = whole as i64 - self.half as i64;
        let limit = axis.pixels as i64;
        let (low, high) = (first.clamp(0, limit) as usize, (first + self.width() as i64).clamp(0, limit) as usize);
        axis.integral[..low].fill(1.0);
        axis.integral[high..].fill(0.0);
        for rest in [&mut axis.value, &mut axis.slope] {
            rest[..low].fill(0.0);
            rest[high..].fill(0.0);
        }
        let skipped = (low as i64 - first) as usize;
        let row = &self.table[step * self.width()..(step + 1) * self.width()];
        // Nothing is seen when low is high: then nothing is read.
        for (pixel, entry) in (low..high).zip(row.iter().skip(skipped)) {
            (axis.integral[pixel], axis.value[pixel], axis.slope[pixel]) = taylor(entry, d);
        }
        (low, high)
    }
}

/// Samples along one axis of a window.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// Pixels of the window.
    pub(super) pixels: usize,
    /// `W`.
    pub(super) integral: [f64; PIXELS],
    /// `k`.
    pub(super) value: [f64; PIXELS],
    /// `dk/dt`.
    pub(super) slope: [f64; PIXELS],
}

impl Axis {
    /// For a window of `pixels`, at most [`PIXELS`].
    pub(super) fn new(pixels: usize) -> Self {
        Self { pixels, integral: [0.0; PIXELS], value: [0.0; PIXELS], slope: [0.0; PIXELS] }
    }
}

#[inline(always)]
fn taylor(&[w, k, k1, k2, k3, k4]: &[f64; 6], d: f64) -> (f64, f64, f64) {
    let slope = k1 + d * (k2 + d * (k3 / 2.0 + d * (k4 / 6.0)));
    let value = k + d * (k1 + d * (k2 / 2.0 + d * (k3 / 6.0 + d * (k4 / 24.0))));
    let integral = w + d * (k + d * (k1 / 2.0 + d * (k2 / 6.0 + d * (k3 / 24.0))));
    (integral, value, slope)
}

/// What one border of a pixel gives to `W`, `k` and the derivatives of `k`.
struct Boundary([f64; 6]);

impl Boundary {
    fn new(t: f64, sigma: f64) -> Self {
        let u = t / sigma;
        let density = (-0.5 * u * u).exp() * 0.398_942_280_401_432_7;
        let below = 0.5 * libm::erfc(-u * std::f64::consts::FRAC_1_SQRT_2);
        let s = 1.0 / sigma;
        let derivatives = [s, -u * s * s, (u * u - 1.0) * s * s * s, (3.0 * u - u * u * u) * s * s * s * s].map(|factor| factor * density);
        let [k1, k2, k3, k4] = derivatives;
        Self([sigma * (u * below + density), below, k1, k2, k3, k4])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `k` at `t` by adding up the Gaussian over the pixel.
    fn by_midpoints(t: f64, sigma: f64) -> f64 {
        let n = 4000;
        let gauss = |u: f64| (-0.5 * u * u).exp() / (2.0 * std::f64::consts::PI).sqrt() / sigma;
        (0..n).map(|i| gauss((t - 0.5 + (f64::from(i) + 0.5) / f64::from(n)) / sigma)).sum::<f64>() / f64::from(n)
    }

    fn samples(profile: &Profile, at: f64) -> (usize, usize, Axis) {
        let mut axis = Axis::new(40);
        let (low, high) = profile.sample(at, &mut axis);
        (low, high, axis)
    }

    #[test]
    fn samples_are_those_of_a_pixel_under_a_gaussian() {
        for sigma in [0.3, 0.7, 2.0] {
            let profile = Profile::new(sigma);
            for at in [13.0, 13.031, 23.49, -2.77, 0.999, 38.2, 70.0] {
                let (_, _, axis) = samples(&profile, at);
                for (pixel, value) in axis.value[..40].iter().enumerate() {
                    let t = at - pixel as f64;
                    assert!((value - by_midpoints(t, sigma)).abs() < 1e-6, "{sigma} {t}: {value}");
                }
            }
        }
    }

    #[test]
    fn each_is_the_derivative_of_the_one_before() {
        for sigma in [0.4, 1.3] {
            let profile = Profile::new(sigma);
            let (h, at) = (1e-4, 15.33);
            let ((_, _, low), (_, _, here), (_, _, high)) = (samples(&profile, at - h), samples(&profile, at), samples(&profile, at + h));
            for i in 0..40 {
                let first = (high.integral[i] - low.integral[i]) / (2.0 * h);
                let second = (high.value[i] - low.value[i]) / (2.0 * h);
                assert!((here.value[i] - first).abs() < 1e-5 && (here.slope[i] - second).abs() < 2e-5, "{i}");
            }
        }
    }

    #[test]
    fn the_integral_goes_from_one_to_nothing() {
        let profile = Profile::new(0.9);
        let (low, high, axis) = samples(&profile, 17.2);
        assert!(low > 0 && (axis.integral[low - 1], axis.integral[high]) == (1.0, 0.0));
        assert!((axis.integral[low] - 1.0).abs() < 1e-6 && axis.integral[high - 1].abs() < 1e-6);
        for (at, expected) in [(-60.0, 0.0), (90.0, 1.0)] {
            assert!(samples(&profile, at).2.integral[..40].iter().all(|&w| w == expected), "{at}");
        }
    }
}
