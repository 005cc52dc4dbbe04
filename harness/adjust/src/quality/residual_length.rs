//! How long the residual of an image point is, by its own covariance.

use nalgebra::{Matrix2, Vector2};
use statrs::distribution::{ContinuousCDF, Normal};

/// An eigenvalue of the cofactors of a residual below which its direction is not: they are the small rest of two numbers of one.
const DIRECTION_UNCHECKED: f64 = 1e-7;
/// Lengths beyond which the tail of the normal distribution is as good as its first term.
const FAR: f64 = 20.0;

/// The length of white residuals `v` by their cofactors `q`, whose eigenvalues are between 0 and 1.
pub(crate) fn length(q: &Matrix2<f64>, v: Vector2<f64>) -> Option<f64> {
    let eigen = (0.5 * (q + q.transpose())).symmetric_eigen();
    let checked = (0..2).filter(|&i| eigen.eigenvalues[i] > DIRECTION_UNCHECKED);
    let square: f64 = checked.clone().map(|i| eigen.eigenvectors.column(i).dot(&v).powi(2) / eigen.eigenvalues[i]).sum();
    match checked.count() {
        0 => None,
        1 => Some(as_of_two(square)),
        _ => Some(square.sqrt()),
    }
}

/// The length of two normal numbers that is as rare as one normal number of this square.
fn as_of_two(square: f64) -> f64 {
    let length = square.sqrt();
    // Far out the tail of one is that of two over the length by sqrt(pi / 2), and has no digits.
    if length > FAR {
        (square + (std::f64::consts::FRAC_PI_2 * square).ln()).sqrt()
    } else {
        (-2.0 * (2.0 * Normal::standard().sf(length)).ln()).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_those_of_two_normal_numbers() {
        let v = Vector2::new(3.0, -1.0);
        let close = |found: Option<f64>, expected: f64| assert!((found.unwrap() - expected).abs() < 1e-9, "{found:?} {expected}");
        close(length(&Matrix2::identity(), v), 10_f64.sqrt());
        close(length(&Matrix2::new(0.25, 0.0, 0.0, 0.04), v), 61_f64.sqrt());
        // By the inverse.
        let q = Matrix2::new(0.5, 0.2, 0.2, 0.3);
        close(length(&q, v), v.dot(&(q.try_inverse().unwrap() * v)).sqrt());
        assert_eq!(length(&Matrix2::new(1e-10, 0.0, 0.0, 0.0), v), None);
        // One direction, (1, 1): of the residual 2 / sqrt 2 lies along it. 1.96 is as rare as 2.4477.
        close(length(&Matrix2::from_element(0.25), v), as_of_two(4.0));
        assert!((as_of_two(1.959_964_f64.powi(2)) - 2.447_747).abs() < 1e-5);
        // Where both ways of the tail meet.
        let (before, after) = (as_of_two((FAR - 1e-9).powi(2)), as_of_two((FAR + 1e-9).powi(2)));
        assert!((before - after).abs() < 2e-4 && after > FAR, "{before} {after}");
    }
}
