//! Gaussian smoothing and reduction.

use calibench_model::{Image, stop};

/// The image smoothed by a Gaussian of `sigma` px; beyond its border it goes on as at its border.
pub(crate) fn smooth(image: &Image, sigma: f64) -> Image<'static> {
    let kernel = gaussian(sigma);
    let (width, height) = (image.width(), image.height());
    let reach = kernel.len() / 2;
    let mut along = vec![0.0_f32; width * height];
    let mut padded = vec![0.0_f32; width + 2 * reach];
    for y in 0..height {
        stop::point();
        let row = image.row(y);
        padded[..reach].fill(row[0]);
        padded[reach..reach + width].copy_from_slice(row);
        padded[reach + width..].fill(row[width - 1]);
        let sums = &mut along[y * width..(y + 1) * width];
        for (k, &weight) in kernel.iter().enumerate() {
            sums.iter_mut().zip(&padded[k..]).for_each(|(sum, &grey)| *sum += weight * grey);
        }
    }
    let mut both = vec![0.0_f32; width * height];
    for y in 0..height {
        stop::point();
        let sums = &mut both[y * width..(y + 1) * width];
        for (k, &weight) in kernel.iter().enumerate() {
            let from = (y + k).saturating_sub(reach).min(height - 1);
            sums.iter_mut().zip(&along[from * width..]).for_each(|(sum, &grey)| *sum += weight * grey);
        }
    }
    Image::new(width, height, both)
}

/// Weights of a Gaussian of `sigma` px, to three sigma, of sum 1.
pub(crate) fn gaussian(sigma: f64) -> Vec<f32> {
    let reach = (3.0 * sigma).ceil() as i64;
    let weights: Vec<f64> = (-reach..=reach).map(|i| (-0.5 * (i as f64 / sigma.max(1e-9)).powi(2)).exp()).collect();
    let sum: f64 = weights.iter().sum();
    weights.into_iter().map(|weight| (weight / sum) as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_becomes_a_gaussian_of_its_sigma_and_a_constant_stays() {
        let image = smooth(&Image::from_fn(21, 17, |x, y| f32::from(u8::from(x == 10 && y == 8))), 1.5);
        let moment = |i: i32, j: i32| -> f64 {
            let at = |k: usize| (k % 21, k / 21);
            image
                .grey()
                .iter()
                .enumerate()
                .map(|(k, &g)| f64::from(g) * (at(k).0 as f64 - 10.0).powi(i) * (at(k).1 as f64 - 8.0).powi(j))
                .sum()
        };
        assert!((moment(0, 0) - 1.0).abs() < 1e-5 && moment(1, 0).abs() < 1e-5 && moment(1, 1).abs() < 1e-5);
        assert!((moment(2, 0) - 2.25).abs() < 0.1 && (moment(0, 2) - 2.25).abs() < 0.1, "{} {}", moment(2, 0), moment(0, 2));
        let constant = smooth(&Image::from_fn(5, 3, |_, _| 0.3), 2.0);
        assert!(constant.grey().iter().all(|g| (g - 0.3).abs() < 1e-6));
    }
}
