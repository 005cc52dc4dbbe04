//! Image points in gross error, before anything is known of the camera.

use calibench_adjust::approximate::{Control, Search, Tolerance, resect};
use calibench_model::camera::Camera;
use calibench_model::upper_median;
use rayon::prelude::*;

/// What a camera makes of the images: which points fit, image by image, and how badly they do.
struct Fit {
    fits: Vec<Vec<bool>>,
    badness: f64,
}

/// The views without the points that do not fit with the camera, of several, whose images fit best; as they are where none orients half of them.
pub(super) fn without_gross(views: Vec<Vec<Control>>, cameras: &[Camera]) -> Vec<Vec<Control>> {
    let best = cameras.iter().filter_map(|camera| fit(camera, &views)).min_by(|a, b| a.badness.total_cmp(&b.badness));
    let Some(best) = best else { return views };
    let kept = views.into_iter().zip(best.fits).map(|(view, fits)| {
        let mut fits = fits.into_iter();
        view.into_iter().filter(|_| fits.next().unwrap_or(true)).collect()
    });
    kept.collect()
}

/// `None` where less than half of the images have a pose. Badness is the median of the standard deviation by the share of points that fit.
fn fit(camera: &Camera, views: &[Vec<Control>]) -> Option<Fit> {
    let against = Search { seed: 1, tolerance: Tolerance::Unknown };
    let resected: Vec<_> = views.par_iter().map(|view| resect(camera, view, Some(&against)).ok()).collect();
    let fits = views.iter().zip(&resected).map(|(view, found)| {
        let rejected = |index: usize| found.as_ref().is_some_and(|found| found.rejected.contains(&index));
        (0..view.len()).map(|index| !rejected(index)).collect()
    });
    let badness: Vec<f64> = views
        .iter()
        .zip(&resected)
        .filter_map(|(view, found)| {
            found.as_ref().map(|found| found.sigma0 * view.len() as f64 / (view.len() - found.rejected.len()) as f64)
        })
        .collect();
    if 2 * badness.len() <= views.len() {
        return None;
    }
    let badness = upper_median(badness)?;
    Some(Fit { fits: fits.collect(), badness })
}
