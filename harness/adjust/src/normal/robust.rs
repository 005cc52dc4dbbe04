//! Weights that fall with the residual.

/// What a residual costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Loss {
    /// Its square.
    #[default]
    Squares,
    /// Its square up to a bound (in standard deviations), then linear.
    ///
    /// Source: Huber 1964.
    Huber(f64),
}

impl Loss {
    /// The cost of an image point whose white residual has the square `square`, and its weight.
    #[inline]
    pub(crate) fn of(self, square: f64) -> (f64, f64) {
        match self {
            Self::Huber(bound) if square > bound * bound => {
                let length = square.sqrt();
                (2.0 * bound * length - bound * bound, bound / length)
            }
            _ => (square, 1.0),
        }
    }
}
