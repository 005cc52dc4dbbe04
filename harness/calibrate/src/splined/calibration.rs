//! The adjustment of splines, and its quality.

use calibench_adjust::{Found, SplinedPlace, SplinedQuality, SplinedSolution, Use};
use calibench_model::camera::CameraModel;
use calibench_model::convert::cell_share;

use super::doubted::SplinedDoubt;
use super::prepared::SplinedPrepared;
use crate::usual_limit_px;

/// Columns and rows of the grid over the frame.
pub(super) const GRID: (usize, usize) = (31, 21);

/// A calibrated camera of splines.
#[derive(Clone, Debug)]
pub struct SplinedCalibration<'p> {
    /// What was adjusted.
    pub prepared: &'p SplinedPrepared,
    /// The result.
    pub solution: SplinedSolution<'p>,
    /// Image points that were left out, if they were looked for.
    pub found: Vec<Found>,
    /// Image points in use that do not fit: all where none were to be left out, or those that would be too many.
    pub kept: Vec<Found>,
    /// How well core and control points are known, with the estimated variance factor where there is redundancy.
    pub quality: SplinedQuality,
    /// The uncertainty over the frame, row by row; places without a ray are missing.
    pub over_frame: Vec<SplinedPlace>,
    /// Why the result is in doubt.
    pub doubts: Vec<SplinedDoubt>,
}

impl SplinedCalibration<'_> {
    /// Root mean square of the residuals in use (2D), px.
    pub fn rms_px(&self) -> f64 {
        let residuals = self.solution.residuals();
        let used = residuals.iter().filter(|r| r.used != Use::LeftOut).filter_map(|r| r.v);
        let (sum, count) = used.fold((0.0, 0_usize), |(sum, count), [x, y]| (sum + x * x + y * y, count + 1));
        (sum / count.max(1) as f64).sqrt()
    }

    /// The standard deviation (2D) of the image of a point far away, root mean square over the frame, px; infinite where a part of it has no ray.
    pub fn over_frame_px(&self) -> f64 {
        if self.over_frame.len() < GRID.0 * GRID.1 { f64::INFINITY } else { self.rms_over(|_| true) }
    }

    /// The same over the part of the frame where image points hold the splines; `None` where none do.
    pub fn over_held_px(&self) -> Option<f64> {
        Some(self.rms_over(|place| place.is_held)).filter(|rms| rms.is_finite())
    }

    fn rms_over(&self, takes_part: impl Fn(&SplinedPlace) -> bool) -> f64 {
        let size = self.solution.camera().size();
        let weighed = self.over_frame.iter().filter(|place| takes_part(place)).map(|place| {
            let weight = cell_share(size, place.at);
            (weight, weight * (place.covariance.sxx + place.covariance.syy))
        });
        let (weight, sum) = weighed.fold((0.0, 0.0), |(weight, sum), (w, s)| (weight + w, sum + s));
        if weight > 0.0 { (sum / weight).max(0.0).sqrt() } else { f64::NAN }
    }

    /// The share of the frame where no image point lies in the cell of the splines, 0 to 1: neighbours and the prior hold them there.
    pub fn share_unheld(&self) -> f64 {
        let size = self.solution.camera().size();
        let held: f64 = self.over_frame.iter().filter(|place| place.is_held).map(|place| cell_share(size, place.at)).sum();
        let cells = (GRID.0 - 1) * (GRID.1 - 1);
        1.0 - held / cells as f64
    }

    /// Beyond which the camera is in doubt, px.
    pub fn limit_px(&self) -> f64 {
        self.prepared.asked.settings.limit_px.unwrap_or_else(|| usual_limit_px(self.solution.camera().size()))
    }
}
