//! From the noise of the grey values to that of the Harris strengths: the `Q_FF` that the theoretical precision begins with.

use calibench_model::{Image, Rejection};

use crate::harris_paraboloid::HarrisParaboloid;
use crate::paraboloid_precision::SampleCovariance;

/// Half the step of the differences, fraction of full scale. The strength is of the fourth order in the grey values: the error is of the order of its square.
const STEP: f32 = 0.005;

/// Covariance of the 3 x 3 strengths around pixel (`x`, `y`) for white noise of standard deviation `sigma` (fraction of full scale) of the grey
/// values, to first order: each grey value has its part in several strengths, which makes neighbours correlated.
///
/// # Errors
/// [`Rejection::Border`], [`Rejection::NotFinite`].
///
/// Source: Zhu et al. 2007, Eq. 14, whose `Q_FF` is not given there.
pub fn strength_covariance(
    operator: &HarrisParaboloid,
    image: &Image,
    (x, y): (i64, i64),
    sigma: f64,
) -> Result<SampleCovariance, Rejection> {
    let reach = operator.reach() as i64;
    let rows = image.rows_around(x, y, reach).ok_or(Rejection::Border)?;
    let side = 2 * operator.reach() + 1;
    let mut around = Image::new(side, side, rows.flatten().copied().collect());
    let samples = |image: &Image| -> Result<[f64; 9], Rejection> {
        let strengths = operator.strengths_around(image, (reach, reach), 1)?;
        Ok(std::array::from_fn(|i| strengths.at(i % 3, i / 3)))
    };
    let mut covariance = [[0.0; 9]; 9];
    for index in 0..side * side {
        let grey = around.grey()[index];
        let (low, high) = (grey - STEP, grey + STEP);
        around.grey_mut()[index] = low;
        let below = samples(&around)?;
        around.grey_mut()[index] = high;
        let above = samples(&around)?;
        around.grey_mut()[index] = grey;
        let slope: [f64; 9] = std::array::from_fn(|i| sigma * (above[i] - below[i]) / f64::from(high - low));
        for (row, a) in covariance.iter_mut().zip(slope) {
            row.iter_mut().zip(slope).for_each(|(sum, b)| *sum += a * b);
        }
    }
    Ok(covariance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::paraboloid::Weights;
    use crate::paraboloid_precision::{Form, precision};
    use crate::registry::Registry;
    use crate::tests::closed_form_images::Noise;
    use calibench_model::{PixelPoint, Start};

    /// A soft corner, its edges a product of two error functions' likenesses.
    fn corner(x: usize, y: usize) -> f32 {
        let edge = |at: f64| 1.0 / (1.0 + (-at / 0.6).exp());
        (edge(x as f64 - 14.8) * edge(y as f64 - 15.3)) as f32
    }

    #[test]
    fn the_theoretical_precision_is_that_of_noisy_images() {
        for spec in ["harris_paraboloid:window=7", "harris_paraboloid:window=7,derivation=0.7,sigma=0.7"] {
            let configured = Registry::builtin().parse(spec).unwrap();
            let operator = HarrisParaboloid::of(&configured.settings);
            let image = Image::from_fn(33, 33, corner);
            let start = Start::at(PixelPoint::new(15.0, 16.0));
            let pixel = operator.strongest_pixel(&image, &start).unwrap();
            let strengths = operator.strengths_around(&image, pixel, 1).unwrap().around(1, 1);
            let weights = Weights::new(0.2);
            let truth = weights.fit(&strengths).maximum().unwrap();
            let (sigma, mut noise, trials) = (5e-4, Noise(11), 4000);
            let mut squares = 0.0;
            for _ in 0..trials {
                let noisy = image.grey().iter().map(|grey| grey + (sigma * noise.normal()) as f32).collect();
                let noisy = Image::new(33, 33, noisy);
                let f = operator.strengths_around(&noisy, pixel, 1).unwrap().around(1, 1);
                let (x, y) = weights.fit(&f).maximum().unwrap();
                squares += (x - truth.0).powi(2) + (y - truth.1).powi(2);
            }
            let found = (squares / f64::from(trials)).sqrt();
            let q_ff = strength_covariance(&operator, &image, pixel, sigma).unwrap();
            let theory = precision(Form::Adjusted(weights), &strengths, &q_ff).unwrap().sigma();
            // 8000 squares: 0.8 % of a standard deviation; five of these.
            assert!((theory / found - 1.0).abs() < 0.04, "{spec}: {theory} {found}");
        }
    }

    #[test]
    fn strengths_at_the_border_have_none() {
        let configured = Registry::builtin().parse("harris_paraboloid").unwrap();
        let operator = HarrisParaboloid::of(&configured.settings);
        assert_eq!(strength_covariance(&operator, &Image::from_fn(33, 33, corner), (2, 15), 0.01), Err(Rejection::Border));
    }
}
