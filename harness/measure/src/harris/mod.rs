//! The Harris strength: of the pixels in a square, and of a whole image.

mod detector;
mod kernel;
mod scale;
mod smooth;

pub use detector::{Detection, HarrisDetector};
pub use kernel::Gradient;
pub use scale::{HarrisLaplace, ScaledDetection};
pub use smooth::smooth;

use calibench_model::{Image, Rejection};

use self::kernel::{Recipe, Source};

/// How the strength is computed: `I = det A - alpha tr(A)^2`, `A` the weighted mean of the gradients' products times a factor.
///
/// A strength is in grey values (fractions of full scale) to the fourth power per px^4, a scale-adapted one in grey values to the fourth power.
#[derive(Clone, Debug, PartialEq)]
pub struct Harris {
    alpha: f64,
    /// One half of the integration weights, from the middle outwards; they sum to one over the whole.
    weights: Vec<f64>,
    gradient: Gradient,
    /// Factor of `A`.
    factor: f64,
}

/// Strengths of all pixels of an image that are at least `margin` px from its border.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StrengthMap {
    /// Columns of pixels that have one.
    pub columns: usize,
    /// Rows of pixels that have one.
    pub rows: usize,
    /// Where the first of them lies, px from the left and from the top.
    pub margin: usize,
    /// The strengths, row by row, `columns` x `rows`, in the unit of [`Harris`].
    pub values: Vec<f32>,
}

/// Strengths of a square of pixels, row by row, in the unit of [`Harris`].
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

    /// The 3 x 3 strengths around (`column`, `row`), row by row.
    pub fn around(&self, column: usize, row: usize) -> [[f64; 3]; 3] {
        [row - 1, row, row + 1].map(|y| [column - 1, column, column + 1].map(|x| self.at(x, y)))
    }
}

impl Harris {
    /// With `alpha` of Eq. 1 and an integration Gaussian of standard deviation `sigma` px, cut off at three sigma; Sobel gradients.
    pub fn new(alpha: f64, sigma: f64) -> Self {
        let radius = (3.0 * sigma).ceil().max(1.0) as usize;
        let raw: Vec<f64> = (0..=radius).map(|d| (-((d * d) as f64) / (2.0 * sigma * sigma)).exp()).collect();
        let sum = raw[0] + 2.0 * raw[1..].iter().sum::<f64>();
        Self { alpha, weights: raw.into_iter().map(|w| w / sum).collect(), gradient: Gradient::Sobel, factor: 1.0 }
    }

    /// With the plain mean over `2 radius + 1` px squared (`radius` at least 1) in place of a Gaussian: the block of other libraries.
    pub fn block(alpha: f64, radius: usize) -> Self {
        let radius = radius.max(1);
        Self { alpha, weights: vec![1.0 / (2 * radius + 1) as f64; radius + 1], gradient: Gradient::Sobel, factor: 1.0 }
    }

    /// The improved strength for images already smoothed by a Gaussian of `derivation` px, integrated over one of `integration` px: the gradients are
    /// central differences of the smoothed image, and `A` is multiplied by `derivation^2`, so that strengths of several scales can be compared.
    ///
    /// Source: Zhu et al. 2007, Eq. 2; Mikolajczyk & Schmid 2004.
    pub fn scale_adapted(alpha: f64, derivation: f64, integration: f64) -> Self {
        Self { gradient: Gradient::Central, factor: derivation * derivation, ..Self::new(alpha, integration) }
    }

    /// How far past a pixel its strength looks, px: the integration radius and one for the gradient.
    pub fn reach(&self) -> usize {
        self.weights.len()
    }

    /// Strengths `det A - alpha tr(A)^2` of all pixels within `half` px of pixel (`x`, `y`), in double precision.
    ///
    /// # Errors
    /// [`Rejection::Border`] when what they look at leaves the image, [`Rejection::NotFinite`].
    ///
    /// Source: Zhu et al. 2007, Eq. 1; Harris & Stephens 1988.
    pub fn strengths(&self, image: &Image, x: i64, y: i64, half: usize) -> Result<Strengths, Rejection> {
        let reach = half + self.reach();
        let mut rows = image.rows_around(x, y, reach as i64).ok_or(Rejection::Border)?;
        if rows.any(|row| row.iter().any(|grey| !grey.is_finite())) {
            return Err(Rejection::NotFinite);
        }
        let first = (y as usize - reach) * image.width() + x as usize - reach;
        let side = 2 * half + 1;
        let mut values = vec![0.0; side * side];
        kernel::double(
            Source { grey: &image.grey()[first..], stride: image.width(), columns: side, rows: side },
            self.recipe(),
            &mut values,
        );
        Ok(Strengths { side, values })
    }

    /// Strengths of all pixels whose surroundings are inside the image, in single precision: none for a small image.
    /// Where a grey value is not a number, they are not either.
    pub fn map(&self, image: &Image) -> StrengthMap {
        let mut map = StrengthMap::default();
        self.map_into(image, &mut map);
        map
    }

    /// As [`Self::map`], in memory used before: of a large image the fresh memory costs as much as the strengths.
    pub fn map_into(&self, image: &Image, map: &mut StrengthMap) {
        let margin = self.reach();
        let [columns, rows] = [image.width(), image.height()].map(|side| side.saturating_sub(2 * margin));
        map.values.resize(columns * rows, 0.0);
        (map.columns, map.rows, map.margin) = (columns, rows, margin);
        let source = Source { grey: image.grey(), stride: image.width(), columns, rows };
        kernel::single(source, self.recipe(), &mut map.values);
    }

    fn recipe(&self) -> Recipe<'_> {
        Recipe { weights: &self.weights, alpha: self.alpha, gradient: self.gradient, scale: self.factor }
    }
}

impl StrengthMap {
    /// The 3 x 3 strengths around (`column`, `row`) of the map, which is not on its border, row by row.
    pub fn around(&self, column: usize, row: usize) -> [[f64; 3]; 3] {
        [row - 1, row, row + 1].map(|y| [column - 1, column, column + 1].map(|x| f64::from(self.values[y * self.columns + x])))
    }
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

    #[test]
    fn the_map_holds_the_strengths_of_the_squares() {
        // 1000 columns: several strips.
        let image = Image::from_fn(1000, 30, |x, y| {
            let (x, y) = (x as f32, y as f32);
            0.5 + 0.2 * (0.7 * x + 0.1 * y).sin() * (0.9 * y).cos() + 0.1 * (0.013 * x * y).sin()
        });
        for harris in [
            Harris::new(0.04, 0.5),
            Harris::new(0.06, 1.0),
            Harris::new(0.04, 1.6),
            Harris::block(0.04, 2),
            Harris::scale_adapted(0.05, 1.5, 0.8),
        ] {
            let map = harris.map(&image);
            assert_eq!((map.columns, map.rows), (1000 - 2 * map.margin, 30 - 2 * map.margin));
            let largest = map.values.iter().fold(0.0_f32, |a, b| a.max(b.abs()));
            for (x, y) in [(12, 12), (17, 14), (478, 13), (486, 15), (495, 16), (971, 12), (983, 16)] {
                let one = harris.strengths(&image, x, y, 1).unwrap();
                let found = map.around(x as usize - map.margin, y as usize - map.margin);
                for (column, row) in (0..3).flat_map(|row| (0..3).map(move |column| (column, row))) {
                    assert!((one.at(column, row) - found[row][column]).abs() < 1e-5 * f64::from(largest), "{x} {y}: {one:?} {found:?}");
                }
            }
        }
    }

    #[test]
    fn a_block_is_the_plain_mean() {
        let image = Image::from_fn(41, 41, |x, y| (x as f32 - 20.0) * (y as f32 - 20.0));
        // The moment of five equal weights is 2.
        let found = Harris::block(0.05, 2).strengths(&image, 20, 20, 2).unwrap().at(2, 2);
        assert!((found - (4.0 - 0.05 * 16.0)).abs() < 1e-12);
    }

    #[test]
    fn small_images_have_no_strengths() {
        for side in 0..9 {
            let map = Harris::new(0.04, 1.0).map(&Image::new(side, side, vec![0.0; side * side]));
            assert_eq!(map.values.len(), side.saturating_sub(8).pow(2));
        }
    }
}
