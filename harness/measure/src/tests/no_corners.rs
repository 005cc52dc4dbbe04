//! Images that hold no corner: edges and texture.

use std::f64::consts::{PI, TAU};

use calibench_model::{PixelPoint, Start};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::bound::noisy;
use super::quadrature_images;
use crate::operator::Operator;

/// Their width and height, px.
pub(crate) const WIDTH: usize = 41;

/// Of `windows` of bare edges, of noise and of textures that are 0.7 to 3 px soft, how many an operator accepts, from up to 2 px off the middle.
pub(crate) fn accepted(operator: &dyn Operator, windows: usize) -> Vec<(String, usize)> {
    let count = |grey: &dyn Fn(&mut ChaCha8Rng) -> Vec<f64>| {
        let mut rng = ChaCha8Rng::seed_from_u64(71);
        let is_accepted = |rng: &mut ChaCha8Rng| {
            let image = quadrature_images::image(&grey(rng), WIDTH);
            operator.measure(&image, &near_middle(rng)).is_ok()
        };
        (0..windows).filter(|_| is_accepted(&mut rng)).count()
    };
    let mut counts = vec![("edges".to_owned(), count(&edge))];
    counts.push(("noise".to_owned(), count(&|rng| noisy(&[0.5; WIDTH * WIDTH], 0.02, rng))));
    for sigma in [0.7, 1.0, 1.5, 2.0, 3.0] {
        let grey = |rng: &mut ChaCha8Rng| noisy(&texture(sigma, rng).iter().map(|grey| 0.5 + 0.1 * grey).collect::<Vec<_>>(), 0.003, rng);
        counts.push((format!("texture of {sigma} px"), count(&grey)));
    }
    println!("of {windows} accepted: {counts:?}");
    counts
}

fn near_middle(rng: &mut ChaCha8Rng) -> Start {
    loop {
        let (x, y) = (rng.random_range(-2.0..2.0), rng.random_range(-2.0..2.0_f64));
        if f64::hypot(x, y) <= 2.0 {
            return Start::at(PixelPoint::new(20.0 + x, 20.0 + y));
        }
    }
}

/// Noise under a Gaussian of this standard deviation, px, of unit variance.
pub(crate) fn texture(sigma: f64, rng: &mut ChaCha8Rng) -> Vec<f64> {
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

/// A bare edge within 3 px of the middle pixel, at any angle, through a lens of 0.3 to 2 px and over photosites as wide as pixels, with noise of 0.5 to 10 % of the contrast.
pub(crate) fn edge(rng: &mut ChaCha8Rng) -> Vec<f64> {
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
