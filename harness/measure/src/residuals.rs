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

/// Products of residuals with their neighbours to the right and below, and squares, added up.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Structure {
    pub(crate) product: f64,
    pub(crate) pairs: f64,
    pub(crate) square: f64,
    pub(crate) count: f64,
}

impl Structure {
    /// Whether there is more than noise has, and than `most`, the root of the covariance of neighbours, in units of half the contrast: a lens, a
    /// print or a light that is not even leave some.
    pub(crate) fn is_no_noise(&self, most: f64) -> bool {
        self.covariance() > most * most && self.significance() > SIGNIFICANT
    }

    /// Whether the residuals are white noise, as far as neighbours tell.
    fn is_white(&self) -> bool {
        self.significance() < WHITE
    }

    /// The covariance of neighbours, in units of half the contrast squared.
    fn covariance(&self) -> f64 {
        self.product / self.pairs
    }

    /// How many standard deviations it has where residuals are white noise.
    fn significance(&self) -> f64 {
        self.covariance() * self.pairs.sqrt() / (self.square / self.count)
    }
}

impl Residuals {
    /// As [`Structure::is_no_noise`].
    pub(crate) fn are_no_noise(&self, most: f64) -> bool {
        self.structure().is_no_noise(most)
    }

    /// Whether they are white noise, as far as neighbours tell.
    pub(crate) fn are_white(&self) -> bool {
        self.structure().is_white()
    }

    fn structure(&self) -> Structure {
        let (side, r, mut sums) = (self.side, &self.grey, Structure::default());
        for (index, here) in r.iter().map(|here| f64::from(*here)).enumerate().filter(|(_, here)| !here.is_nan()) {
            sums.square += here * here;
            sums.count += 1.0;
            let right = r.get(index + 1).filter(|_| (index + 1) % side != 0);
            for beside in [right, r.get(index + side)].into_iter().flatten().filter(|beside| !beside.is_nan()) {
                sums.product += here * f64::from(*beside);
                sums.pairs += 1.0;
            }
        }
        sums
    }
}
