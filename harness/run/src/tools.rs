//! What a build has beside its methods.

use calibench_calibrate::BoardSolver;
use calibench_measure::BoardDetector;

/// What a build has beside its methods; none of it by default.
#[derive(Clone, Copy, Default)]
pub struct Tools<'a> {
    /// Finds chessboards.
    pub detector: Option<&'a dyn BoardDetector>,
    /// OpenCV's calibration from a board.
    pub solver: Option<&'a dyn BoardSolver>,
}
