//! How to calibrate.

use calibench_adjust::Variance;
use calibench_model::{MeasuredDistance, ObservedStation};

use crate::{BoardShape, CalibrationError, DatumChoice, Discs, GrossErrors, Optics, StatedBoard};

/// How to calibrate.
#[derive(Clone, Debug)]
pub struct Settings {
    /// The cameras: at least one.
    pub cameras: Vec<Optics>,
    /// What fixes the frame of the object.
    pub datum: DatumChoice,
    /// What is asked of the shape of a planar testfield.
    pub shape: BoardShape,
    /// What is stated of a board beside its coordinates.
    pub board: StatedBoard,
    /// What is done about image points in gross error.
    pub gross: GrossErrors,
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
    /// Distances that were measured between targets.
    pub distances: Vec<MeasuredDistance>,
    /// Targets between which the adjusted length is asked for.
    pub lengths: Vec<[String; 2]>,
}

/// The a-priori standard deviation of an image coordinate where none is given, px.
pub const USUAL_SIGMA: f64 = 0.1;

impl Settings {
    /// The usual ones for some cameras, at least one.
    pub fn new(cameras: Vec<Optics>) -> Self {
        Self {
            cameras,
            datum: DatumChoice::Control,
            shape: BoardShape::Flat,
            board: StatedBoard::default(),
            gross: GrossErrors::default(),
            sigma_px: None,
            limit_px: None,
            covariances: false,
            discs: None,
            stations: Vec::new(),
            distances: Vec::new(),
            lengths: Vec::new(),
        }
    }

    /// The a-priori standard deviation of an image coordinate, px.
    pub fn sigma(&self) -> f64 {
        self.sigma_px.unwrap_or(USUAL_SIGMA)
    }

    /// What else says how large things are must not be stated beside the scale of a print.
    pub(crate) fn check_scale(&self) -> Result<(), CalibrationError> {
        let refused = |why: &'static str| Err(CalibrationError::BoardScale { why });
        match self.board.scale {
            Some(_) if !self.distances.is_empty() => refused("measured distances say the scale, too"),
            Some(_) if self.stations.iter().any(|row| row.centre.is_some()) => refused("observed projection centres say the scale, too"),
            _ => Ok(()),
        }
    }

    /// Whose variance factor tests and standard deviations take: the a-priori one means something only if the user stated it.
    pub(crate) fn tested(&self) -> Variance {
        if self.sigma_px.is_some() { Variance::Apriori } else { Variance::Estimated }
    }
}
