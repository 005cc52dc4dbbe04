//! What a blurred pixel sees of a point and of a half-plane, along one axis.

/// Fractions of a px at which the profile is tabulated; between them it is a Taylor series.
const STEPS: usize = 16;
/// Pixels that are sampled side by side. Fixed, so that every instruction set gives the same bits.
pub(super) const LANES: usize = 16;
/// W, k and the first four derivatives of k.
const DERIVATIVES: usize = 6;
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
    /// For each fraction, for each of the [`DERIVATIVES`], for each pixel, with margins for [`LANES`] pixels that do not see the point. In single precision: 1e-7 of a grey value is far below its noise.
    table: Vec<f32>,
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
        let (stride, width) = (self.stride(), self.width());
        self.table.clear();
        self.table.resize(STEPS * DERIVATIVES * stride, 0.0);
        for (step, row) in self.table.chunks_exact_mut(DERIVATIVES * stride).enumerate() {
            let fraction = (step as f64 + 0.5) / STEPS as f64;
            row[..LANES].fill(1.0);
            let mut above = Boundary::new(fraction + self.half as f64 + 0.5, sigma);
            for pixel in 0..width {
                let below = Boundary::new(fraction + self.half as f64 - pixel as f64 - 0.5, sigma);
                (0..DERIVATIVES).for_each(|i| row[i * stride + LANES + pixel] = (above.0[i] - below.0[i]) as f32);
                above = below;
            }
        }
    }

    /// From one derivative to the next in the table.
    fn stride(&self) -> usize {
        LANES + self.width() + LANES
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

    /// Samples of as many pixels as the slices have (whole [`LANES`]) for the point `at`; returns from which to which pixel these see it.
    ///
    /// Outside the value is zero and the integral one (before the point) or zero (after it). What is not wanted is left as it is.
    #[inline(always)]
    pub(super) fn sample(&self, at: f64, out: &mut Samples<'_>, wanted: Wanted) -> (usize, usize) {
        // The whole number below, without a call into a library.
        let cut = at as i64;
        let whole = cut - i64::from((cut as f64) > at);
        let scaled = (at - whole as f64) * STEPS as f64;
        let step = (scaled as usize).min(STEPS - 1);
        let d = ((scaled - step as f64 - 0.5) / STEPS as f64) as f32;
        let [half, third, fourth] = [d * 0.5, d * (1.0 / 3.0), d * 0.25];
        let (first, width, pixels) = (whole - self.half as i64, self.width() as i64, out.value.len());
        let stride = self.stride();
        let row = &self.table[step * DERIVATIVES * stride..(step + 1) * DERIVATIVES * stride];
        for from in (0..pixels).step_by(LANES) {
            // Far from the point all lanes come from the table's margins.
            let place = (LANES as i64 + from as i64 - first).clamp(0, LANES as i64 + width) as usize;
            let entry = |i: usize| lanes(row, i * stride + place);
            let [w, k, k1, k2, k3, k4] = [entry(0), entry(1), entry(2), entry(3), entry(4), entry(5)];
            let mut lanes = [0.0; LANES];
            // Slices of a length that the compiler knows: otherwise each is a call.
            if wanted.value {
                for i in 0..LANES {
                    lanes[i] = k[i] + d * (k1[i] + half * (k2[i] + third * (k3[i] + fourth * k4[i])));
                }
                out.value[from..][..LANES].copy_from_slice(&lanes);
            }
            if wanted.integral {
                for i in 0..LANES {
                    lanes[i] = w[i] + d * (k[i] + half * (k1[i] + third * (k2[i] + fourth * k3[i])));
                }
                out.integral[from..][..LANES].copy_from_slice(&lanes);
            }
            if wanted.slope {
                for i in 0..LANES {
                    lanes[i] = k1[i] + d * (k2[i] + half * (k3[i] + third * k4[i]));
                }
                out.slope[from..][..LANES].copy_from_slice(&lanes);
            }
        }
        let seen = |pixel: i64| pixel.clamp(0, pixels as i64) as usize;
        (seen(first), seen(first + width))
    }
}

/// Which samples are worked out.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    /// `W`.
    pub(super) integral: bool,
    /// `k`.
    pub(super) value: bool,
    /// `dk/dt`.
    pub(super) slope: bool,
}

/// The `LANES` values from `index` on.
#[inline(always)]
fn lanes(values: &[f32], index: usize) -> &[f32; LANES] {
    values[index..index + LANES].try_into().expect("a slice of that length")
}

/// Samples along one axis of a window.
#[derive(Debug)]
pub(super) struct Samples<'a> {
    /// `W`.
    pub(super) integral: &'a mut [f32],
    /// `k`.
    pub(super) value: &'a mut [f32],
    /// `dk/dt`.
    pub(super) slope: &'a mut [f32],
}

/// What one border of a pixel gives to `W`, `k` and the derivatives of `k`.
struct Boundary([f64; DERIVATIVES]);

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

    const ALL: Wanted = Wanted { integral: true, value: true, slope: true };

    struct Sampled {
        low: usize,
        high: usize,
        integral: Vec<f32>,
        value: Vec<f32>,
        slope: Vec<f32>,
    }

    fn samples(profile: &Profile, at: f64) -> Sampled {
        let [mut integral, mut value, mut slope] = [(); 3].map(|()| vec![0.0; 48]);
        let (low, high) = profile.sample(at, &mut Samples { integral: &mut integral, value: &mut value, slope: &mut slope }, ALL);
        Sampled { low, high, integral, value, slope }
    }

    #[test]
    fn samples_are_those_of_a_pixel_under_a_gaussian() {
        for sigma in [0.3, 0.7, 2.0] {
            let profile = Profile::new(sigma);
            for at in [13.0, 13.031, 23.49, -2.77, 0.999, 38.2, 70.0] {
                let axis = samples(&profile, at);
                for (pixel, value) in axis.value[..40].iter().enumerate() {
                    let t = at - pixel as f64;
                    assert!((f64::from(*value) - by_midpoints(t, sigma)).abs() < 1e-6, "{sigma} {t}: {value}");
                }
            }
        }
    }

    #[test]
    fn each_is_the_derivative_of_the_one_before() {
        for sigma in [0.4, 1.3] {
            let profile = Profile::new(sigma);
            // Differences of the fourth order: with a shorter h the rounding of single precision would show.
            let (h, at) = (0.03, 15.33);
            let [far_low, low, here, high, far_high] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|steps| samples(&profile, at + steps * h));
            for i in 0..40 {
                let slope = |of: &dyn Fn(&Sampled) -> f32| {
                    let [a, b, c, d] = [&far_low, &low, &high, &far_high].map(|sampled| f64::from(of(sampled)));
                    (8.0 * (c - b) - (d - a)) / (12.0 * h)
                };
                let (first, second) = (slope(&|s| s.integral[i]), slope(&|s| s.value[i]));
                let off = [f64::from(here.value[i]) - first, f64::from(here.slope[i]) - second];
                assert!(off[0].abs() < 1e-5 && off[1].abs() < 2e-5, "{i}: {off:?}");
            }
        }
    }

    #[test]
    fn the_integral_goes_from_one_to_nothing() {
        let profile = Profile::new(0.9);
        let axis = samples(&profile, 17.2);
        let (low, high) = (axis.low, axis.high);
        assert!(low > 0 && (axis.integral[low - 1], axis.integral[high]) == (1.0, 0.0));
        assert!((axis.integral[low] - 1.0).abs() < 1e-6 && axis.integral[high - 1].abs() < 1e-6);
        for (at, expected) in [(-60.0, 0.0), (90.0, 1.0)] {
            assert!(samples(&profile, at).integral[..40].iter().all(|&w| w == expected), "{at}");
        }
    }
}
