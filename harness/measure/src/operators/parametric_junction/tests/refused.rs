//! What is no junction.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::efficiency::near;
use super::*;
use crate::tests::bound::noisy;

/// Of 10,000 the upper 95 % limit of Clopper and Pearson is then 0.93 %.
const MOST_ACCEPTED: f64 = 0.0075;

const WIDTH: usize = 41;

/// Noise under a Gaussian of this standard deviation, px, of unit variance.
fn texture(sigma: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
    let reach = (4.0 * sigma).ceil() as usize;
    let taps: Vec<f64> = (0..=2 * reach).map(|i| (-0.5 * ((i as f64 - reach as f64) / sigma).powi(2)).exp()).collect();
    let wide = WIDTH + 2 * reach;
    let white = noisy(&vec![0.0; wide * wide], 1.0, rng);
    let along = |grey: &[f64], columns: usize, step: usize, from: usize| -> f64 {
        taps.iter().enumerate().map(|(i, tap)| tap * grey[from + i * step * columns.max(1)]).sum()
    };
    let across: Vec<f64> = (0..wide * WIDTH).map(|i| along(&white, 0, 1, i / WIDTH * wide + i % WIDTH)).collect();
    let grey: Vec<f64> = (0..WIDTH * WIDTH).map(|i| along(&across, WIDTH, 1, i)).collect();
    let size = taps.iter().map(|tap| tap * tap).sum::<f64>();
    grey.iter().map(|grey| grey / size).collect()
}

fn accepted(spec: &str, windows: usize, mut grey: impl FnMut(&mut ChaCha8Rng) -> Vec<f64>) -> usize {
    let operator = operator(spec);
    let mut rng = ChaCha8Rng::seed_from_u64(71);
    let mut measured = |rng: &mut ChaCha8Rng| {
        let image = quadrature_images::image(&grey(rng), WIDTH);
        operator.measure(&image, &near([20.0, 20.0], 2.0, rng)).is_ok()
    };
    (0..windows).filter(|_| measured(&mut rng)).count()
}

fn edge(rng: &mut ChaCha8Rng) -> Vec<f64> {
    let (sin, cos) = (f64::from(rng.random_range(0..4)) * 0.5 * PI + rng.random_range(0.01..0.5 * PI - 0.01)).sin_cos();
    let (blur, off): (f64, f64) = (rng.random_range(0.3..2.0), rng.random_range(-3.0..3.0));
    let contrast = rng.random_range(0.2..0.8);
    let noise = contrast * [0.005, 0.02, 0.1][rng.random_range(0..3)];
    // The square's shadow across the edge is a trapezium; under it the step is integrated twice.
    let (wide, narrow) = (0.5 * (cos.abs() + sin.abs()), 0.5 * (cos.abs() - sin.abs()));
    let twice = |z: f64| {
        let u = z / blur;
        let phi = 0.5 * libm::erfc(-u * std::f64::consts::FRAC_1_SQRT_2);
        0.5 * ((z * z + blur * blur) * phi + z * blur * (-0.5 * u * u).exp() / TAU.sqrt())
    };
    let step = |i: usize| {
        let z = ((i % WIDTH) as f64 - 20.0) * cos + ((i / WIDTH) as f64 - 20.0) * sin - off;
        let seen = (twice(z + wide) - twice(z + narrow) - twice(z - narrow) + twice(z - wide)) / (cos * sin).abs();
        0.1 + contrast * seen
    };
    noisy(&(0..WIDTH * WIDTH).map(step).collect::<Vec<_>>(), noise, rng)
}

fn refuses(spec: &str, windows: usize) {
    let mut counts = vec![("edges".to_owned(), accepted(spec, windows, edge))];
    counts.push(("noise".to_owned(), accepted(spec, windows, |rng| noisy(&[0.5; WIDTH * WIDTH], 0.02, rng))));
    for sigma in [0.7, 1.0, 1.5, 2.0, 3.0] {
        let grey = |rng: &mut ChaCha8Rng| {
            let grey = texture(sigma, rng).iter().map(|grey| 0.5 + 0.1 * grey).collect::<Vec<_>>();
            noisy(&grey, 0.003, rng)
        };
        counts.push((format!("texture of {sigma} px"), accepted(spec, windows, grey)));
    }
    println!("{spec}: of {windows} accepted: {counts:?}");
    // Of three or four arms so soft a texture is none in a window of 15 px.
    let held = if spec.ends_with('3') || spec.ends_with('4') { counts.len() - 1 } else { counts.len() };
    for (what, count) in &counts[..held] {
        assert!(*count as f64 <= MOST_ACCEPTED * windows as f64, "{spec}, {what}: {count} of {windows}");
    }
}

#[test]
fn bare_edges_noise_and_texture_are_refused() {
    refuses("window=15", 400);
}

#[test]
#[ignore = "takes minutes"]
fn of_ten_thousand_windows_fewer_than_one_percent_are_taken_for_junctions() {
    let windows = std::env::var("WINDOWS").map_or(10_000, |windows| windows.parse().unwrap());
    for arms in 0..=4 {
        if arms != 1 {
            refuses(&format!("window=15,arms={arms}"), windows);
        }
    }
}
