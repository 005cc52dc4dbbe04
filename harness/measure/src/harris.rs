//! The Harris strength of the pixels in a square.

use calibench_model::{Image, Rejection};

/// How the strength is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Harris {
    alpha: f64,
    /// One half of the integration weights, from the middle outwards; they sum to one over the whole.
    weights: Vec<f64>,
}

/// Strengths of a square of pixels, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Strengths {
    side: usize,
    values: Vec<f64>,
}

impl Strengths {
    /// Pixels along one side.
    pub fn side(&self) -> usize {
        self.side
    }

    /// The strength at (`column`, `row`) of the square.
    pub fn at(&self, column: usize, row: usize) -> f64 {
        self.values[row * self.side + column]
    }

    /// The 3 x 3 strengths around (`column`, `row`).
    pub fn around(&self, column: usize, row: usize) -> [[f64; 3]; 3] {
        [row - 1, row, row + 1].map(|y| [column - 1, column, column + 1].map(|x| self.at(x, y)))
    }
}

impl Harris {
    /// With `alpha` of Eq. 1 and an integration Gaussian of standard deviation `sigma` px, cut off at three sigma.
    pub fn new(alpha: f64, sigma: f64) -> Self {
        let radius = (3.0 * sigma).ceil() as usize;
        let raw: Vec<f64> = (0..=radius).map(|d| (-((d * d) as f64) / (2.0 * sigma * sigma)).exp()).collect();
        let sum = raw[0] + 2.0 * raw[1..].iter().sum::<f64>();
        Self { alpha, weights: raw.into_iter().map(|w| w / sum).collect() }
    }

    /// How far past a pixel its strength looks, px: the integration radius and one for the gradient.
    pub fn reach(&self) -> usize {
        self.weights.len()
    }

    /// Strengths `det A - alpha tr(A)^2` of all pixels within `half` px of pixel (`x`, `y`); `A` from Sobel gradients per px.
    ///
    /// # Errors
    /// [`Rejection::Border`] when what they look at leaves the image, [`Rejection::NotFinite`].
    ///
    /// Source: Zhu et al. 2007, Eq. 1; Harris & Stephens 1988.
    pub fn strengths(&self, image: &Image, x: i64, y: i64, half: usize) -> Result<Strengths, Rejection> {
        let radius = self.weights.len() - 1;
        let rows: Vec<&[f32]> = image.rows_around(x, y, (half + radius + 1) as i64).ok_or(Rejection::Border)?.collect();
        if rows.iter().any(|row| row.iter().any(|grey| !grey.is_finite())) {
            return Err(Rejection::NotFinite);
        }
        let products = gradient_products(&rows);
        let side = 2 * half + 1;
        let [xx, xy, yy] = products.map(|product| self.integrate(&product, side));
        let strength = |i: usize| xx[i] * yy[i] - xy[i] * xy[i] - self.alpha * (xx[i] + yy[i]) * (xx[i] + yy[i]);
        Ok(Strengths { side, values: (0..side * side).map(strength).collect() })
    }

    /// The separable weighted mean of a square that is larger by the radius on every side.
    fn integrate(&self, values: &[f64], side: usize) -> Vec<f64> {
        let radius = self.weights.len() - 1;
        let wide = side + 2 * radius;
        let mut along_rows = Vec::with_capacity(wide * side);
        for row in values.chunks_exact(wide) {
            along_rows.extend((0..side).map(|x| self.weigh(|d| row[x + radius - d] + row[x + radius + d], row[x + radius])));
        }
        let at = |x: usize, y: usize| along_rows[y * side + x];
        let columns = |i: usize| {
            let (x, y) = (i % side, i / side + radius);
            self.weigh(|d| at(x, y - d) + at(x, y + d), at(x, y))
        };
        (0..side * side).map(columns).collect()
    }

    fn weigh(&self, pair: impl Fn(usize) -> f64, middle: f64) -> f64 {
        self.weights.iter().enumerate().skip(1).fold(self.weights[0] * middle, |sum, (d, weight)| sum + weight * pair(d))
    }
}

/// gx^2, gx gy and gy^2 of all pixels but the outermost ring; Sobel, grey values per px.
fn gradient_products(rows: &[&[f32]]) -> [Vec<f64>; 3] {
    let inner = rows.len() - 2;
    let mut products = [(); 3].map(|()| Vec::with_capacity(inner * inner));
    for three in rows.windows(3) {
        let at = |row: usize, column: usize| f64::from(three[row][column]);
        for x in 0..inner {
            let column = |x: usize| at(0, x) + 2.0 * at(1, x) + at(2, x);
            let step = |x: usize| at(2, x) - at(0, x);
            let gx = (column(x + 2) - column(x)) / 8.0;
            let gy = (step(x) + 2.0 * step(x + 1) + step(x + 2)) / 8.0;
            products[0].push(gx * gx);
            products[1].push(gx * gy);
            products[2].push(gy * gy);
        }
    }
    products
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Grey values `p(x, y)` with constant gradients in each sector give the strength by hand.
    #[test]
    fn a_ramp_has_the_strength_of_an_edge() {
        let image = Image::from_fn(31, 31, |x, y| (3 * x + 4 * y) as f32);
        let strengths = Harris::new(0.04, 1.0).strengths(&image, 15, 15, 2).unwrap();
        // A = g g^T with g = (3, 4): det 0, trace 25.
        assert!((strengths.at(2, 2) + 0.04 * 625.0).abs() < 1e-9);
    }

    #[test]
    fn a_saddle_has_its_moments() {
        // g = (y, x): A = [[m, xy], [xy, m]] with m = the second moment of the weights at the middle, xy = 0 there.
        let image = Image::from_fn(41, 41, |x, y| (x as f32 - 20.0) * (y as f32 - 20.0));
        let harris = Harris::new(0.05, 1.3);
        let moment: f64 = harris.weights.iter().enumerate().skip(1).map(|(d, w)| 2.0 * w * (d * d) as f64).sum();
        let found = harris.strengths(&image, 20, 20, 0).unwrap().at(0, 0);
        assert!((found - (moment * moment - 0.05 * 4.0 * moment * moment)).abs() < 1e-12);
    }

    #[test]
    fn weights_sum_to_one() {
        for sigma in [0.3, 1.0, 2.7] {
            let harris = Harris::new(0.04, sigma);
            let sum = harris.weights[0] + 2.0 * harris.weights[1..].iter().sum::<f64>();
            assert!((sum - 1.0).abs() < 1e-15);
        }
    }
}
