//! Other tools' own calibrations from a flat board, beside ours.

use calibench_adjust::approximate::Control;
use calibench_model::camera::{Camera, ImageSize};

/// What another tool makes of a board's corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardSolution {
    /// Its camera.
    pub camera: Camera,
    /// The standard deviation that it gives for its focal length, the mean of both, px; `None` where it gives none.
    pub sigma_f_px: Option<f64>,
    /// Root mean square of its residuals, the length of each, px.
    pub rms_px: f64,
}

/// A tool that calibrates from a flat board.
pub trait BoardSolver: Send + Sync {
    /// Its name.
    fn name(&self) -> &'static str;

    /// Its version.
    fn version(&self) -> String;

    /// The camera behind the corners of each view, from nothing but them: object coordinates with Z = 0, and image coordinates, px.
    ///
    /// # Errors
    /// In words: what the tool refuses.
    fn solve(&self, size: ImageSize, views: &[Vec<Control>]) -> Result<BoardSolution, String>;
}
