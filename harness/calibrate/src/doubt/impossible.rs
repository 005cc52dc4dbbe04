//! What cannot be as it is said to be: points outside of their images, images of another size, cameras that no lens makes, residuals that no operator leaves.

use std::f64::consts::{PI, TAU};

use calibench_adjust::ImageObservation;
use calibench_model::camera::{Camera, CameraModel, Fold, Ray, fold, implausible};
use calibench_model::{PixelPoint, upper_median};

use crate::placed::{cropped, in_use, is_outside};
use crate::{Calibration, Doubt, Subject};

/// Residuals beyond this, px, at half of the points are no operator's: names, counts, sizes or the model are wrong.
const MOST_PX: f64 = 5.0;

/// Beyond this angle from its axis a lens that pictures angles may see nothing more, degrees.
const CIRCLE: f64 = 75.0;
/// Directions in which that angle is asked for, and the share of the fold's radius at which.
const DIRECTIONS: u32 = 16;
const INSIDE: f64 = 0.98;

/// What is wrong for sure; and folds where a fisheye may see nothing more, in words. Of large residuals only where no check has found their cause.
pub(super) fn found(calibration: &Calibration<'_>) -> (Vec<Doubt>, Vec<String>) {
    let explained = calibration.checked.iter().any(|checked| checked.doubt().is_some());
    let mut found: Vec<Doubt> = outside(calibration).into_iter().chain(far(calibration).filter(|_| !explained)).collect();
    let mut rims = Vec::new();
    for camera in 0..calibration.cameras() {
        if let Some((fold, angle)) = fold_of(calibration.camera(camera)) {
            let words = folded(fold, angle, &calibration.of(camera));
            if angle < CIRCLE.to_radians() {
                found.push(Doubt::of_camera(Subject::Fold, camera, words));
            } else {
                rims.push(words);
            }
        }
        found.extend(of_no_lens(calibration, camera).chain(of_a_crop(calibration, camera)));
    }
    found.extend(calibration.doubted_distances());
    (found, rims)
}

/// The fold of a camera inside its own frame and the angle from its axis at which it is, radians.
fn fold_of(camera: &Camera) -> Option<(Fold, f64)> {
    let (found, axis) = (fold(camera)?, camera.project(Ray::from_tangent(0.0, 0.0)).ok()?);
    let angle = |k: u32| {
        let (sin, cos) = (f64::from(k) * TAU / f64::from(DIRECTIONS)).sin_cos();
        let inside = INSIDE * found.radius_px;
        let ray = camera.unproject(PixelPoint::new(axis.x + inside * cos, axis.y + inside * sin)).ok()?;
        Some(ray.x.hypot(ray.y).atan2(-ray.z))
    };
    Some((found, (0..DIRECTIONS).filter_map(angle).fold(PI, f64::min)))
}

/// A fold in words.
fn folded(fold: Fold, angle: f64, of: &str) -> String {
    format!(
        "the camera{of} folds over {:.0} px from the image of its axis ({:.0} degrees): {:.1} % of the frame have no ray; fewer parameters, or points near the borders, decide",
        fold.radius_px,
        angle.to_degrees(),
        100.0 * fold.share
    )
}

/// What no lens has, beyond the points too.
fn of_no_lens(calibration: &Calibration<'_>, camera: usize) -> impl Iterator<Item = Doubt> {
    let of = calibration.of(camera);
    let told = move |fault| Doubt::of_camera(Subject::Implausible, camera, format!("the camera{of}: {fault}"));
    implausible(calibration.camera(camera)).into_iter().map(told)
}

/// A principal point in the middle of what the points fill, and not of the frame.
fn of_a_crop(calibration: &Calibration<'_>, camera: usize) -> Option<Doubt> {
    let [across, down] = cropped(calibration, camera)?;
    let words = format!(
        "the principal point{} lies in the middle of {across:.2} times the width and {down:.2} times the height of the frame, and the image points fill just that: is the size of the images right (--size)?",
        calibration.of(camera)
    );
    Some(Doubt::of_camera(Subject::Crop, camera, words))
}

/// Image points in use outside the frame: of another size, or swapped coordinates.
fn outside(calibration: &Calibration<'_>) -> Option<Doubt> {
    let is_outside = |o: &&ImageObservation| is_outside(calibration.camera(calibration.owner(o.image)).size(), o.position);
    let count = in_use(calibration).filter(is_outside).count();
    let words = || format!("{count} image points lie outside the images: is their size right (--size), and are x and y?");
    (count > 0).then(|| Doubt::of_all(Subject::Frame, words()))
}

/// The length that half of the residuals reach, so that gross errors do not count, whether they were left out or not; where no operator leaves as much.
pub(crate) fn half_of(residuals: impl Iterator<Item = [f64; 2]>) -> Option<f64> {
    upper_median(residuals.map(|[x, y]| x.hypot(y))).filter(|half| *half > MOST_PX)
}

fn far(calibration: &Calibration<'_>) -> Option<Doubt> {
    half_of(calibration.solution.each_residual().filter_map(|residual| residual.v)).map(|half| {
        let words = format!(
            "residuals of {half:.1} px and more at half of the points are no operator's: are the columns and rows of the board, the names of points and their object coordinates right, and is the model the lens's?"
        );
        Doubt::of_all(Subject::Residuals, words)
    })
}
