//! The board of a calibration as JSON.

use calibench_calibrate::{Calibration, Shape};
use schemars::JsonSchema;
use serde::Serialize;

use super::measured_board::{MeasuredBoardAnswer, Scale};
use crate::calibration::board_bend;

#[derive(Serialize, JsonSchema)]
pub(super) struct Board {
    /// `untouched` (not asked for), `untested`, `flat` (as far as the images tell) or `bent`.
    shape: &'static str,
    /// Why it was not tested.
    why: Option<String>,
    /// The bend along u, along v and its twist, object units, positive towards the camera.
    bend: Option<[f64; 3]>,
    /// Standard deviations of these.
    sigma: Option<[f64; 3]>,
    /// Probability of as much of a bend by chance, if the board is flat.
    p: Option<f64>,
    /// What was stated of the print's scale and how much of the standard deviations it is; null where it was not.
    scale: Option<Scale>,
    /// The standard deviation that was stated of each coordinate of a corner, object units; null where none was.
    print_noise: Option<f64>,
    /// The corners as the images show them; null where they were not asked for.
    measured: Option<MeasuredBoardAnswer>,
}

/// The board of a calibration.
pub(super) fn board(calibration: &Calibration<'_>) -> Board {
    let stated = &calibration.prepared.settings.board;
    let none = Board {
        shape: "untouched",
        why: None,
        bend: None,
        sigma: None,
        p: None,
        scale: stated.scale.map(|scale| Scale { value: scale.value, sigma: scale.sigma, of_lengths: scale.share() }),
        print_noise: stated.noise,
        measured: calibration.measured_board.as_ref().and_then(|board| board.as_ref().ok()).map(MeasuredBoardAnswer::new),
    };
    match &calibration.prepared.shape {
        Shape::Untouched => none,
        Shape::Untested(why) => Board { shape: "untested", why: Some(why.clone()), ..none },
        Shape::Flat { bend, .. } => {
            Board { shape: "flat", bend: Some(bend.coefficients), sigma: Some(bend.sigmas), p: Some(bend.p), ..none }
        }
        Shape::Bent { bend, .. } => {
            let (values, sigmas) = board_bend(calibration).unzip();
            Board { shape: "bent", bend: values, sigma: sigmas, p: bend.map(|bend| bend.p), ..none }
        }
    }
}
