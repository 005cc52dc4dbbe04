//! What a sensor adds to the grey values.

use calibench_model::Image;
use rand::Rng;
use rand_distr::{Distribution, Normal};

/// Adds white Gaussian noise of standard deviation `sigma` (fraction of full scale; zero adds nothing) to every pixel.
///
/// # Panics
/// If `sigma` is negative or not finite: scenarios are checked before.
pub fn add_grey_noise(image: &mut Image, sigma: f64, rng: &mut impl Rng) {
    if sigma == 0.0 {
        return;
    }
    let normal = Normal::new(0.0, sigma).expect("a finite standard deviation");
    for grey in image.grey_mut() {
        *grey = (f64::from(*grey) + normal.sample(rng)) as f32;
    }
}

/// Rounds every grey value to the nearest of 2^`bits` levels from 0 to full scale, and clips what lies outside.
pub fn quantise(image: &mut Image, bits: u32) {
    let top = ((1_u64 << bits) - 1) as f32;
    for grey in image.grey_mut() {
        *grey = (*grey * top).round().clamp(0.0, top) / top;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use calibench_random::{Key, Purpose, stream};

    #[test]
    fn noise_has_its_mean_variance_and_no_autocorrelation() {
        let (sigma, n) = (0.02, 1_000_000);
        let mut image = Image::new(1000, 1000, vec![0.5; n]);
        let key = Key { seed: 7, of: "noise", trial: 0, view: "", target: "" };
        add_grey_noise(&mut image, sigma, &mut stream(key, Purpose::GreyNoise));
        let errors: Vec<f64> = image.grey().iter().map(|&g| (f64::from(g) - 0.5) / sigma).collect();
        let mean = errors.iter().sum::<f64>() / n as f64;
        let variance = errors.iter().map(|e| e * e).sum::<f64>() / n as f64;
        let neighbours = errors.windows(2).map(|e| e[0] * e[1]).sum::<f64>() / n as f64;
        // Five standard errors each, of a seed fixed beforehand.
        assert!(mean.abs() < 5e-3, "{mean}");
        assert!((variance - 1.0).abs() < 5.0 * (2.0_f64 / n as f64).sqrt(), "{variance}");
        assert!(neighbours.abs() < 5e-3, "{neighbours}");
    }

    #[test]
    fn quantised_values_are_levels() {
        let mut image = Image::new(4, 1, vec![-0.1, 0.5, 0.501, 1.2]);
        quantise(&mut image, 8);
        let levels: Vec<f32> = image.grey().iter().map(|g| g * 255.0).collect();
        assert_eq!(levels, [0.0, 128.0, 128.0, 255.0]);
    }
}
