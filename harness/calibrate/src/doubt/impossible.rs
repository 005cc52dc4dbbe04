//! What cannot be as it is said to be: points outside of their images, residuals that no operator leaves.

use calibench_adjust::ImageObservation;
use calibench_model::PixelPoint;
use calibench_model::camera::{CameraModel, ImageSize};

use crate::Calibration;

/// Residuals beyond this, px, at half of the points are no operator's: names, counts, sizes or the model are wrong.
const MOST_PX: f64 = 5.0;

/// What is wrong for sure, in words. Of large residuals only where no check has found their cause.
pub(super) fn found(calibration: &Calibration<'_>) -> Vec<String> {
    let explained = calibration.checked.iter().any(|checked| checked.doubt().is_some());
    outside(calibration).into_iter().chain(far(calibration).filter(|_| !explained)).collect()
}

/// Image points outside the frame: of another size, or swapped coordinates.
fn outside(calibration: &Calibration<'_>) -> Option<String> {
    let is_outside = |o: &&ImageObservation| is_outside(calibration.camera(calibration.owner(o.image)).size(), o.position);
    let count = calibration.prepared.network.observations.iter().filter(is_outside).count();
    (count > 0).then(|| format!("{count} image points lie outside the images: is their size right (--size), and are x and y?"))
}

/// Whether a position is in no pixel of an image.
pub(crate) fn is_outside(size: ImageSize, position: PixelPoint) -> bool {
    let at = position.to_corner();
    !((0.0..=f64::from(size.width)).contains(&at.x) && (0.0..=f64::from(size.height)).contains(&at.y))
}

/// The length that half of the residuals reach, so that gross errors do not count, whether they were left out or not; where no operator leaves as much.
pub(crate) fn half_of(residuals: impl Iterator<Item = [f64; 2]>) -> Option<f64> {
    let mut lengths: Vec<f64> = residuals.map(|[x, y]| x.hypot(y)).collect();
    let middle = lengths.len() / 2;
    let half = if lengths.is_empty() { 0.0 } else { *lengths.select_nth_unstable_by(middle, f64::total_cmp).1 };
    (half > MOST_PX).then_some(half)
}

fn far(calibration: &Calibration<'_>) -> Option<String> {
    half_of(calibration.solution.each_residual().filter_map(|residual| residual.v)).map(|half| {
        format!(
            "residuals of {half:.1} px and more at half of the points are no operator's: are the columns and rows of the board, the names of points and their object coordinates right, and is the model the lens's?"
        )
    })
}
