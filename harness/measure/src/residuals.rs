//! What a fit leaves: noise, or something that the model does not picture.

/// Structure has a covariance of neighbours of so many standard deviations of that of white noise.
const SIGNIFICANT: f64 = 5.0;
/// White noise has fewer, but for one window in a thousand.
const WHITE: f64 = 3.0;

/// The residuals of a window, row by row, in units of half the contrast; those that do not count are NaN.
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
        let (mut product, mut square, mut pairs, mut count) = (0.0, 0.0, 0.0, 0.0);
        for (index, here) in r.iter().map(|here| f64::from(*here)).enumerate().filter(|(_, here)| !here.is_nan()) {
            (square, count) = (square + here * here, count + 1.0);
            let right = r.get(index + 1).filter(|_| (index + 1) % side != 0);
            for beside in [right, r.get(index + side)].into_iter().flatten().filter(|beside| !beside.is_nan()) {
                product += here * f64::from(*beside);
                pairs += 1.0;
            }
        }
        let (covariance, variance) = (product / pairs, square / count);
        (covariance, covariance * f64::sqrt(pairs) / variance)
    }
}
