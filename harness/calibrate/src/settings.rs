//! How to calibrate.

use calibench_adjust::Variance;
use calibench_model::ObservedStation;

use crate::{BoardShape, DatumChoice, Discs, Optics};

/// How to calibrate.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The cameras: at least one.
    pub cameras: Vec<Optics>,
    /// What fixes the frame of the object.
    pub datum: DatumChoice,
    /// What is asked of the shape of a planar testfield.
    pub shape: BoardShape,
    /// Bound of Huber's weights, in standard deviations of an image point as the residuals show them.
    pub huber: Option<f64>,
    /// Whether what Baarda's test rejects is left out.
    pub snoop: bool,
    /// A-priori standard deviation of an image coordinate, px; `None` for [`USUAL_SIGMA`], about which nothing is known but its order of magnitude.
    pub sigma_px: Option<f64>,
    /// How well a camera must be known over its frame, px ([`crate::OverFrame`]); `None` for [`crate::usual_limit_px`].
    pub limit_px: Option<f64>,
    /// Whether image points are weighted by their own covariances, where they have them.
    pub covariances: bool,
    /// Discs whose eccentricity is taken from the centres of their pictures; `None` to take image points as they are.
    pub discs: Option<Discs>,
    /// Poses that were observed, or parts of them.
    pub stations: Vec<ObservedStation>,
}

/// The a-priori standard deviation of an image coordinate where none is given, px.
pub const USUAL_SIGMA: f64 = 0.1;

/// Huber's bound of start values where image points are left out later.
const SNOOPED: f64 = 2.0;

impl Settings {
    /// The usual ones for some cameras, at least one.
    pub fn new(cameras: Vec<Optics>) -> Self {
        Self {
            cameras,
            datum: DatumChoice::Control,
            shape: BoardShape::Flat,
            huber: None,
            snoop: false,
            sigma_px: None,
            limit_px: None,
            covariances: false,
            discs: None,
            stations: Vec::new(),
        }
    }

    /// The a-priori standard deviation of an image coordinate, px.
    pub fn sigma(&self) -> f64 {
        self.sigma_px.unwrap_or(USUAL_SIGMA)
    }

    /// Bound of Huber's weights on the way to start values, in a-priori standard deviations: where gross errors are looked for they must not lead it astray.
    pub(crate) fn start_huber(&self) -> Option<f64> {
        self.huber.or(self.snoop.then_some(SNOOPED))
    }

    /// Whose variance factor tests and standard deviations take: the a-priori one means something only if the user stated it.
    pub(crate) fn tested(&self) -> Variance {
        if self.sigma_px.is_some() { Variance::Apriori } else { Variance::Estimated }
    }
}
