//! Whether an image has one pose, or its rows were exposed one after the other.

use calibench_adjust::{Attitude, Centre, Status};
use calibench_model::PixelPoint;

use super::motion::Moving;
use super::{Cameras, Richer};
use crate::Calibration;
use crate::allowed::Allowed;
use crate::resampled::GROUPS;

/// A motion from row to row that explains so many times as much as one from column to column is of the shutter.
const BY_ROWS: f64 = 1.2;
/// Share of the variance that both must explain to be more than residuals of neighbours that belong together, as those of real corners do.
const MUCH: f64 = 0.5;
/// Share of the variance from which a motion counts, however little it moves the camera to first order: no image has one pose then.
const NEARLY_ALL: f64 = 0.8;

/// The same observations with a pose that changes evenly from the first row of an image to the last.
pub(super) fn check(calibration: &Calibration<'_>) -> Allowed {
    let solution = &calibration.solution;
    let network = solution.network();
    if network.images.iter().any(|image| image.centre != Centre::Free || image.attitude != Attitude::Free) {
        return Allowed::untested("something is known of the poses");
    }
    if network.points.iter().flat_map(|point| point.coordinates).any(Status::is_unknown) {
        return Allowed::untested("object points are unknown too");
    }
    if !network.per_image.is_empty() {
        return Allowed::untested("images have numbers of their own");
    }
    let Some(moving) = Moving::of(solution, |at| at.y) else {
        return Allowed::untested("a pose that changes is not determined");
    };
    let redundancy = solution.counts().redundancy().saturating_sub(moving.more as _).max(1) as f64;
    let richer =
        Richer { cost: moving.cost, more: moving.more, cameras: Cameras::Changed(moving.changes()), white: moving.white().collect() };
    let mut is_by_rows = false;
    let words = || {
        let gain = |moving: &Moving<'_, '_>| solution.cost() - moving.cost;
        let columns = Moving::of(solution, |at: &PixelPoint| at.x);
        is_by_rows = columns.is_none_or(|columns| gain(&moving) > BY_ROWS * gain(&columns));
        cause(is_by_rows).into()
    };
    let allowed = calibration.judged(&richer, || moving.optimism(GROUPS, redundancy), words);
    counted(allowed, is_by_rows)
}

/// What is found counts by how much it explains, and by whether rows explain it better than columns.
fn counted(allowed: Allowed, is_by_rows: bool) -> Allowed {
    let explains = allowed.explains();
    let Allowed { verdict, is_clean } = allowed;
    let verdict = match explains {
        explains if explains > NEARLY_ALL => verdict.doubted(),
        explains if is_by_rows || explains > MUCH => verdict,
        _ => verdict.sound(),
    };
    Allowed { verdict, is_clean }
}

/// A turn along rows and one along columns picture nearly the same, and so does a sheet that bends.
fn cause(is_by_rows: bool) -> &'static str {
    if is_by_rows {
        "a rolling shutter: rows of an image were exposed one after the other while camera or testfield moved; hold both still"
    } else {
        "something differs within each image: a rolling shutter with a camera or testfield that moved, or a testfield that bends from image to image"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Finding, Verdict};

    #[test]
    fn a_motion_that_explains_nearly_all_counts_however_little_it_moves_the_camera() {
        let slight = |explains| Verdict::Slight(Finding { p: 1e-9, moves: Some(1.0), explains }, "cause".into());
        let of = |explains, is_by_rows| counted(Allowed { verdict: slight(explains), is_clean: true }, is_by_rows).verdict;
        for is_by_rows in [true, false] {
            assert!(matches!(of(0.81, is_by_rows), Verdict::Doubt(..)));
            assert!(matches!(of(0.79, is_by_rows), Verdict::Slight(..)));
        }
        assert!(matches!(of(0.3, true), Verdict::Slight(..)) && matches!(of(0.3, false), Verdict::Sound(_)));
    }
}
