//! Which view is not like the others.

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::statistics::holm;

/// The chance (0 to 1) that a view is named in photographs that are all alike, over all of their views together.
pub const ALPHA: f64 = 0.01;

/// From the median absolute deviation to the standard deviation of a normal distribution.
const MAD: f64 = 1.4826;

/// Of each view the p-value, Holm's, of its RMS residual being that of the others.
///
/// `views` are RMS residuals (2D, of any one unit) and numbers of corners; `parameters` those of the camera, shared by all views. The logarithm of a
/// view's RMS is compared with the median of all, in units of their median absolute deviation, or of what chance alone makes (`1 / sqrt(2 f)`, f the
/// view's redundancy) where that is more: views differ in sharpness and tilt, and that alone does not make one of them bad. One-sided, by Student's
/// distribution.
///
/// Fewer than four views have no outlier. A view without residuals is not one.
pub fn outliers(views: &[(f64, usize)], parameters: usize) -> Vec<f64> {
    let corners: usize = views.iter().map(|view| view.1).sum();
    if views.len() < 4 || corners == 0 {
        return vec![1.0; views.len()];
    }
    let logs: Vec<f64> = views.iter().map(|(rms, _)| rms.max(f64::MIN_POSITIVE).ln()).collect();
    let middle = median(&logs);
    let spread = MAD * median(&logs.iter().map(|log| (log - middle).abs()).collect::<Vec<_>>());
    let Ok(student) = StudentsT::new(0.0, 1.0, views.len() as f64 - 1.0) else { return vec![1.0; views.len()] };
    let p = views.iter().zip(&logs).map(|((_, count), log)| {
        let shared = parameters as f64 * *count as f64 / corners as f64;
        let freedom = (2.0 * *count as f64 - 6.0 - shared).max(1.0);
        student.sf((log - middle) / spread.max(1.0 / (2.0 * freedom).sqrt()))
    });
    holm(&p.collect::<Vec<_>>())
}

/// The middle of at least one value.
fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    f64::midpoint(values[(values.len() - 1) / 2], values[values.len() / 2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_list_of_the_samples_has_one_bad_view() {
        // `per_view_reprojection_errors` of OpenCV's left_intrinsics.yml: left01 to left14 without left10.
        let published = [0.193, 1.182, 0.173, 0.193, 0.160, 0.180, 0.231, 0.242, 0.296, 0.167, 0.202, 0.381, 0.174];
        let views: Vec<(f64, usize)> = published.map(|rms| (rms, 54)).to_vec();
        let named: Vec<usize> = (0..13).filter(|&view| outliers(&views, 8)[view] < ALPHA).collect();
        assert_eq!(named, [1]);
    }

    #[test]
    fn what_says_nothing_names_nothing() {
        assert_eq!(outliers(&[], 4), Vec::<f64>::new());
        assert_eq!(outliers(&[(0.1, 54), (9.0, 54), (0.1, 54)], 4), [1.0; 3]);
        assert!(outliers(&[(0.0, 54); 6], 4).iter().all(|p| *p > 0.4), "all alike, and exact");
    }
}
