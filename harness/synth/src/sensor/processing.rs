//! What a camera does to the developed image: smoothing against noise, sharpening of edges.

use calibench_model::Image;
use rayon::prelude::*;

use super::{SensorError, check};

/// Smoothing and sharpening of grey values before the curve, on signal and noise alike.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Processing {
    /// Standard deviation of the Gaussian that smooths, px; 0: none.
    pub smoothing: f64,
    /// Amount a of an unsharp mask, of what is left after smoothing: in + a (in - Gaussian of it); below 0 it softens.
    pub sharpening: f64,
    /// Standard deviation of that Gaussian, px.
    pub radius: f64,
}

/// Standard deviations of a Gaussian that are kept.
const KEPT: f64 = 4.5;

impl Processing {
    pub(super) fn check(&self) -> Result<(), SensorError> {
        check("the smoothing", self.smoothing, 0.0, 5.0)?;
        check("the sharpening", self.sharpening, -0.9, 5.0)?;
        check("the sharpening's radius", self.radius, 0.1, 20.0)
    }

    /// Whether it leaves everything as it is.
    pub fn is_nothing(&self) -> bool {
        self.smoothing == 0.0 && self.sharpening == 0.0
    }

    /// The image after smoothing and sharpening; beyond the borders are the outermost pixels.
    pub fn apply(&self, mut image: Image<'static>) -> Image<'static> {
        if self.smoothing > 0.0 {
            image = blurred(&image, self.smoothing);
        }
        if self.sharpening != 0.0 {
            let mask = blurred(&image, self.radius);
            let amount = self.sharpening as f32;
            image.grey_mut().par_iter_mut().zip(mask.grey()).for_each(|(grey, mask)| *grey += amount * (*grey - mask));
        }
        image
    }
}

/// `image` convolved with a Gaussian sampled at whole pixels, whose weights add up to one.
fn blurred(image: &Image<'_>, sigma: f64) -> Image<'static> {
    let (width, height) = (image.width(), image.height());
    let reach = (KEPT * sigma).ceil() as i64;
    let weights: Vec<f64> = (-reach..=reach).map(|u| (-0.5 * (u as f64 / sigma).powi(2)).exp()).collect();
    let total: f64 = weights.iter().sum();
    let taps: Vec<(i64, f32)> = (-reach..=reach).zip(weights).map(|(u, weight)| (u, (weight / total) as f32)).collect();
    let within = |at: i64, length: usize| at.clamp(0, length as i64 - 1) as usize;
    let mut along = vec![0.0_f32; width * height];
    along.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        let from = image.row(y);
        for (x, value) in row.iter_mut().enumerate() {
            *value = taps.iter().map(|(u, weight)| weight * from[within(x as i64 + u, width)]).sum();
        }
    });
    let mut down = vec![0.0_f32; width * height];
    down.par_chunks_mut(width.max(1)).enumerate().for_each(|(y, row)| {
        for (u, weight) in &taps {
            let from = &along[within(y as i64 + u, height) * width..][..width];
            row.iter_mut().zip(from).for_each(|(value, from)| *value += weight * from);
        }
    });
    Image::new(width, height, down)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step() -> Image<'static> {
        Image::from_fn(60, 20, |x, _| if x < 30 { 0.2 } else { 0.8 })
    }

    #[test]
    fn smoothing_is_a_gaussian_and_keeps_the_light() {
        let point = Image::from_fn(41, 41, |x, y| f32::from(u8::from(x == 20 && y == 20)));
        let smooth = Processing { smoothing: 1.3, sharpening: 0.0, radius: 1.0 }.apply(point);
        let sum: f64 = smooth.grey().iter().map(|grey| f64::from(*grey)).sum();
        let second: f64 = (0..41).map(|x| f64::from(smooth.at(x, 20)) * (x as f64 - 20.0).powi(2)).sum::<f64>()
            / (0..41).map(|x| f64::from(smooth.at(x, 20))).sum::<f64>();
        assert!((sum - 1.0).abs() < 1e-5 && (second / 1.69 - 1.0).abs() < 1e-3, "{sum} {second}");
    }

    #[test]
    fn sharpening_overshoots_on_both_sides_alike_and_leaves_areas() {
        let sharp = Processing { smoothing: 0.0, sharpening: 1.5, radius: 1.0 }.apply(step());
        let (low, high) = (f64::from(sharp.at(29, 10)), f64::from(sharp.at(30, 10)));
        assert!(low < 0.19 && ((0.2 - low) - (high - 0.8)).abs() < 1e-6, "{low} {high}");
        assert!((sharp.at(5, 10) - 0.2).abs() < 1e-6 && (sharp.at(55, 10) - 0.8).abs() < 1e-6);
        let soft = Processing { smoothing: 0.0, sharpening: -0.5, radius: 1.0 }.apply(step());
        assert!(soft.at(29, 10) > 0.2 && soft.at(30, 10) < 0.8);
    }
}
