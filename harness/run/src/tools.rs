//! What a build has beside its methods.

use calibench_calibrate::BoardSolver;
use calibench_calibrators::Listed;
use calibench_measure::BoardDetector;
use calibench_scenario::Transfer;

/// What a build has beside its methods; none of it by default.
#[derive(Clone, Copy, Default)]
pub struct Tools<'a> {
    /// OpenCV's detector of chessboards.
    pub detector: Option<&'a dyn BoardDetector>,
    /// OpenCV's calibration from a board.
    pub solver: Option<&'a dyn BoardSolver>,
    /// Calibration systems: ours, and programs.
    pub calibrators: &'a [Listed],
}

impl Tools<'_> {
    /// Why the calibration at `place` cannot run with them, if so.
    pub(crate) fn lack(&self, transfer: &Transfer, place: usize) -> Option<String> {
        transfer.unavailable(place, self.solver.is_some(), self.detector.is_some())
    }
}
