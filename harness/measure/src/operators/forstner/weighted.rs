//! Förstner's sums with Gaussian weights, and what noise does to the point.

use calibench_model::{Covariance, Image};

use super::kernel::Sums;

/// Gradients of a window, unnormalised Sobel, with weights; coordinates from the window's middle pixel.
pub(super) struct Gradients {
    half: i64,
    /// gx, gy and weight, row by row.
    values: Vec<[f64; 3]>,
}

impl Gradients {
    /// The window of `half` px around pixel (`x`, `y`), weighted by a Gaussian of `sigma` px about (`dx`, `dy`) from there; 0 for equal weights.
    pub(super) fn new(image: &Image, (x, y): (i64, i64), half: i64, sigma: f64, (dx, dy): (f64, f64)) -> Self {
        let at = |x: i64, y: i64| f64::from(image.at(x as usize, y as usize));
        // The Gaussian of a distance is the product of those along a row and a column: exponentials of all pixels take half of the time.
        let weigh = |d: f64| -> Vec<f64> {
            let weight = |u: i64| if sigma > 0.0 { (-(u as f64 - d).powi(2) / (2.0 * sigma * sigma)).exp() } else { 1.0 };
            (-half..=half).map(weight).collect()
        };
        let (along, down) = (weigh(dx), weigh(dy));
        let mut values = Vec::with_capacity(along.len() * down.len());
        for (v, u) in (-half..=half).flat_map(|v| (-half..=half).map(move |u| (v, u))) {
            let (cx, cy) = (x + u, y + v);
            let column = |x: i64| at(x, cy - 1) + 2.0 * at(x, cy) + at(x, cy + 1);
            let row = |y: i64| at(cx - 1, y) + 2.0 * at(cx, y) + at(cx + 1, y);
            let weight = along[(u + half) as usize] * down[(v + half) as usize];
            values.push([column(cx + 1) - column(cx - 1), row(cy + 1) - row(cy - 1), weight]);
        }
        Self { half, values }
    }

    fn iter(&self) -> impl Iterator<Item = (i64, i64, [f64; 3])> + '_ {
        let side = 2 * self.half + 1;
        self.values.iter().enumerate().map(move |(i, &value)| (i as i64 % side - self.half, i as i64 / side - self.half, value))
    }

    /// The sums of the normal equations.
    pub(super) fn sums(&self) -> Sums {
        let mut s = Sums::default();
        for (x, y, [gx, gy, weight]) in self.iter() {
            let t = gx * x as f64 + gy * y as f64;
            s.gxx += weight * gx * gx;
            s.gxy += weight * gx * gy;
            s.gyy += weight * gy * gy;
            s.bx += weight * gx * t;
            s.by += weight * gy * t;
            s.c += weight * t * t;
        }
        s
    }

    /// Sum of the weights.
    pub(super) fn weight(&self) -> f64 {
        self.values.iter().map(|value| value[2]).sum()
    }

    /// The covariance of the point at (`dx`, `dy`), whose normal equations have `sums`, for independent noise of `variance` in the grey values.
    ///
    /// The point solves `S = sum w g (g . r) = 0` with `r` from the point. Noise `e` in the gradients changes it by `N^-1 sum w [e (g . r) + g (e . r)]`; the
    /// gradients share pixels, so the sum is taken pixel by pixel: each has a coefficient in two gradients' worth of neighbours.
    pub(super) fn covariance(&self, sums: &Sums, (dx, dy): (f64, f64), variance: f64) -> Covariance {
        let side = (2 * self.half + 3) as usize;
        let mut coefficients = vec![[0.0; 2]; side * side];
        for (x, y, [gx, gy, weight]) in self.iter() {
            let (rx, ry) = (x as f64 - dx, y as f64 - dy);
            let t = gx * rx + gy * ry;
            // By gx and by gy, each for both components of the sum.
            let (by_x, by_y) = ([weight * (t + gx * rx), weight * gy * rx], [weight * gx * ry, weight * (t + gy * ry)]);
            for (v, u) in (-1..=1).flat_map(|v: i64| (-1..=1).map(move |u: i64| (v, u))) {
                let (sx, sy) = ((u * (2 - v.abs())) as f64, (v * (2 - u.abs())) as f64);
                let to = &mut coefficients[(y + v + self.half + 1) as usize * side + (x + u + self.half + 1) as usize];
                to[0] += sx * by_x[0] + sy * by_y[0];
                to[1] += sx * by_x[1] + sy * by_y[1];
            }
        }
        let determinant = sums.gxx * sums.gyy - sums.gxy * sums.gxy;
        let mut covariance = Covariance { sxx: 0.0, sxy: 0.0, syy: 0.0 };
        for [a, b] in coefficients {
            let (x, y) = ((sums.gyy * a - sums.gxy * b) / determinant, (sums.gxx * b - sums.gxy * a) / determinant);
            covariance.sxx += variance * x * x;
            covariance.sxy += variance * x * y;
            covariance.syy += variance * y * y;
        }
        covariance
    }
}

/// The variance of the noise in a window, from the mask (1 -2 1) x (1 -2 1), which sees no plane and no edge along an axis; `None` without noise.
///
/// Of the absolute responses the lower quartile counts: oblique edges take up to half of a window with a corner.
///
/// Source: Immerkær 1996 (the mask); the quartile is ours.
pub(super) fn noise_variance(image: &Image, (x, y): (i64, i64), half: i64) -> Option<f64> {
    /// The lower quartile of the absolute value of a standard normal variable.
    const QUARTILE: f64 = 0.318_639_363_964_375_2;
    let at = |x: i64, y: i64| f64::from(image.at(x as usize, y as usize));
    let second = |x: i64, y: i64| at(x - 1, y) - 2.0 * at(x, y) + at(x + 1, y);
    let response = |(v, u): (i64, i64)| (second(x + u, y + v - 1) - 2.0 * second(x + u, y + v) + second(x + u, y + v + 1)).abs();
    let mut responses: Vec<f64> = (-half..=half).flat_map(|v| (-half..=half).map(move |u| (v, u))).map(response).collect();
    let place = responses.len() / 4;
    let (_, quartile, _) = responses.select_nth_unstable_by(place, f64::total_cmp);
    // Squares of the mask's elements: 36.
    let sigma = *quartile / QUARTILE / 6.0;
    (sigma > 0.0).then_some(sigma * sigma)
}
