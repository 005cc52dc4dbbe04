//! Which view is not like the others.

use calibench_model::median;
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
    let middle = median(logs.iter().copied()).unwrap_or_default();
    let spread = MAD * median(logs.iter().map(|log| (log - middle).abs())).unwrap_or_default();
    let Ok(student) = StudentsT::new(0.0, 1.0, views.len() as f64 - 1.0) else { return vec![1.0; views.len()] };
    let p = views.iter().zip(&logs).map(|((_, count), log)| {
        let shared = parameters as f64 * *count as f64 / corners as f64;
        let freedom = (2.0 * *count as f64 - 6.0 - shared).max(1.0);
        student.sf((log - middle) / spread.max(1.0 / (2.0 * freedom).sqrt()))
    });
    holm(&p.collect::<Vec<_>>())
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

    fn close(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-12, "{found} is not {expected}");
    }

    /// The upper tail of Student's distribution in closed form: with three and with four degrees of freedom.
    fn tails(t: f64) -> (f64, f64) {
        let (a, b) = (t / 3.0_f64.sqrt(), 1.0 + t * t / 4.0);
        let three = 0.5 - (a / (1.0 + a * a) + a.atan()) / std::f64::consts::PI;
        (three, 0.5 - 0.375 * t / b.sqrt() * (1.0 - t * t / b / 12.0))
    }

    /// Logarithms -1, -0.5, 0, 0.5 and 4: median 0, of the absolute ones 0.5, so that the last is 4 / (1.4826 * 0.5) off.
    #[test]
    fn a_view_is_compared_with_the_scatter_of_the_others() {
        let views = [-0.5_f64, 4.0, 0.0, -1.0, 0.5].map(|log| (0.2 * log.exp(), 54));
        let p = outliers(&views, 8);
        close(p[1], 5.0 * tails(4.0 / 0.7413).1);
        close(p[4], (4.0 * tails(0.5 / 0.7413).1).min(1.0));
        assert_eq!((p[0], p[2], p[3]), (1.0, 1.0, 1.0), "one-sided");
    }

    /// Three of four views alike: nothing scatters but by chance.
    /// With 3, 6, 30 and 61 of 100 corners and 10 parameters the redundancies are -0.3 (at least 1), 5.4, 51 and 109.9.
    #[test]
    fn views_that_are_alike_are_compared_with_what_chance_makes_of_their_corners() {
        let sharp = [(0.1, 3), (0.1, 6), (0.1, 30), (0.1 * 0.3_f64.exp(), 61)];
        close(outliers(&sharp, 10)[3], 4.0 * tails(0.3 * 219.8_f64.sqrt()).0);
        let few = [(0.1 * 2.0_f64.exp(), 3), (0.1, 6), (0.1, 30), (0.1, 61)];
        close(outliers(&few, 10)[0], 4.0 * tails(2.0 * 2.0_f64.sqrt()).0);
        let some = [(0.1, 3), (0.1 * 1.5_f64.exp(), 6), (0.1, 30), (0.1, 61)];
        close(outliers(&some, 10)[1], 4.0 * tails(1.5 * 10.8_f64.sqrt()).0);
        assert_eq!(outliers(&[(0.1, 0), (0.1, 0), (0.1, 0), (99.0, 0)], 10), [1.0; 4], "no corners say nothing");
    }
}
