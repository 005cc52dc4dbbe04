//! Whether a board is bent: the network adjusted with a flat one and with a bent one.

use calibench_adjust::{AdjustError, Network, Options, Variance, adjust, compare};

use super::board::Board;
use super::surface;
use crate::ended::{ITERATIONS, ended};
use crate::{BoardShape, Settings};

/// Probability at which a flat board is taken for a bent one: a thousandth, since residuals of real images are not quite independent.
const ALPHA: f64 = 1e-3;
/// Huber's bound of both adjustments, in standard deviations that the residuals show: gross errors neither hide a bend nor feign one.
const BOUND: f64 = 3.0;
/// Variances of an image coordinate, against the a-priori one, below which residuals are rounding.
const ROUNDING: f64 = 1e-10;

/// The bend of a board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    /// Coefficients, object units: see [`BoardShape::Bent`].
    pub coefficients: [f64; 3],
    /// Their standard deviations, object units.
    pub sigmas: [f64; 3],
    /// Probability of a fit that improves as much if the board is flat.
    pub p: f64,
}

impl Bend {
    /// Whether the board is bent, at a level of 0.001.
    pub fn is_significant(&self) -> bool {
        self.p < ALPHA
    }
}

/// The bend that the observations show, and its test; `None` where residuals are rounding.
pub(crate) fn bend(network: &Network, board: &Board, settings: &Settings) -> Result<Option<Bend>, AdjustError> {
    let plain = Options { huber: settings.gross.huber(), most_iterations: ITERATIONS, ..Options::default() };
    let first = adjust(network, &plain)?;
    let Some(scale) = first.scale().filter(|scale| scale * scale > ROUNDING) else { return Ok(None) };
    let robust = Options { huber: Some(BOUND * scale), ..plain };
    let flat_start = ended(&first);
    let flat = adjust(&flat_start, &robust)?;
    let mut bent_start = ended(&flat);
    bent_start.surfaces = vec![surface(network, board, BoardShape::Bent, [0.0; 3])];
    let bent = adjust(&bent_start, &robust)?;
    let covariance = bent.covariances(Variance::Estimated)?.surfaces[0];
    let p = compare(&flat, &bent)?.p;
    let coefficients = bent.surfaces().next().unwrap_or_default();
    Ok(Some(Bend { coefficients, sigmas: std::array::from_fn(|i| covariance[(i, i)].max(0.0).sqrt()), p }))
}
