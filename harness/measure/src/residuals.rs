//! What a fit leaves: noise, or something that the model does not picture.

/// Structure has a covariance of neighbours of so many standard deviations of that of white noise.
const SIGNIFICANT: f64 = 5.0;
/// White noise has fewer, but for one window in a thousand.
const WHITE: f64 = 3.0;

/// The residuals of a window, row by row, in units of half the contrast.
pub(crate) struct Residuals {
    pub(crate) grey: Vec<f32>,
    pub(crate) side: usize,
}

impl Residuals {
    /// Whether they hold more structure than noise does, and than `most`, the root of the covariance of neighbours, in units of half the contrast: a lens, a
    /// print or a light that is not even leave some.
    pub(crate) fn are_no_noise(&self, most: f64) -> bool {
        let (covariance, significance) = self.structure();
        covariance > most * most && significance > SIGNIFICANT
    }

    /// Whether they are white noise, as far as neighbours tell.
    pub(crate) fn are_white(&self) -> bool {
        self.structure().1 < WHITE
    }

    /// The covariance of neighbours, in units of half the contrast squared, and how many standard deviations it has where residuals are white noise.
    fn structure(&self) -> (f64, f64) {
        let (side, r) = (self.side, &self.grey);
        let (mut product, mut square, mut pairs) = (0.0, 0.0, 0.0);
        for row in 0..side {
            for column in 0..side {
                let here = f64::from(r[row * side + column]);
                square += here * here;
                if column + 1 < side {
                    product += here * f64::from(r[row * side + column + 1]);
                    pairs += 1.0;
                }
                if row + 1 < side {
                    product += here * f64::from(r[(row + 1) * side + column]);
                    pairs += 1.0;
                }
            }
        }
        let (covariance, variance) = (product / pairs, square / (side * side) as f64);
        (covariance, covariance * f64::sqrt(pairs) / variance)
    }
}
