//! Ellipses through points.

use nalgebra::{Matrix2, Matrix3, SMatrix, SVector, Vector2, Vector3};

use crate::ellipse::Ellipse;

/// The ellipse of least algebraic distance, `4ac - b^2 = 1`; `None` for points that determine none.
///
/// Source: Fitzgibbon, Pilu & Fisher 1999, in the form of Halíř & Flusser 1998.
pub fn direct(points: &[Vector2<f64>]) -> Option<Ellipse> {
    let count = points.len() as f64;
    let mean = points.iter().sum::<Vector2<f64>>() / count;
    let scale = (points.iter().map(|p| (p - mean).norm_squared()).sum::<f64>() / count).sqrt();
    let (mut quadratic, mut mixed, mut linear) = (Matrix3::zeros(), Matrix3::zeros(), Matrix3::zeros());
    for point in points {
        let p = (point - mean) / scale;
        let (q, l) = (Vector3::new(p.x * p.x, p.x * p.y, p.y * p.y), Vector3::new(p.x, p.y, 1.0));
        quadratic += q * q.transpose();
        mixed += q * l.transpose();
        linear += l * l.transpose();
    }
    let eliminate = -linear.try_inverse()? * mixed.transpose();
    let reduced = quadratic + mixed * eliminate;
    let m = Matrix3::from_rows(&[0.5 * reduced.row(2), -reduced.row(1), 0.5 * reduced.row(0)]);
    let values = m.complex_eigenvalues();
    let conic = values.iter().filter_map(|value| {
        let rows = m - Matrix3::identity() * value.re;
        let row = |i: usize| rows.row(i).transpose();
        let vectors = [row(0).cross(&row(1)), row(1).cross(&row(2)), row(2).cross(&row(0))];
        let vector = vectors.into_iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()))?.try_normalize(0.0)?;
        (4.0 * vector[0] * vector[2] - vector[1] * vector[1] > 1e-9).then_some(vector)
    });
    let q = conic.max_by(|a, b| (4.0 * a[0] * a[2] - a[1] * a[1]).total_cmp(&(4.0 * b[0] * b[2] - b[1] * b[1])))?;
    let Ellipse { position, shape } = from_conic(&q, &(eliminate * q))?;
    Some(Ellipse { position: [0, 1].map(|i| mean[i] + scale * position[i]), shape: shape.map(|s| s * scale) })
}

/// `q0 x^2 + q1 xy + q2 y^2 + l0 x + l1 y + l2 = 0`.
fn from_conic(q: &Vector3<f64>, l: &Vector3<f64>) -> Option<Ellipse> {
    let form = Matrix2::new(q[0], 0.5 * q[1], 0.5 * q[1], q[2]);
    let linear = Vector2::new(l[0], l[1]);
    let position = -0.5 * form.try_inverse()? * linear;
    let level = -(l[2] + 0.5 * linear.dot(&position));
    // (p - c)^T form (p - c) = level, so A^2 = level form^-1.
    let square = form.try_inverse()? * level;
    let ellipse = Ellipse::from_moments([position.x, position.y], [0.25 * square[(0, 0)], 0.25 * square[(0, 1)], 0.25 * square[(1, 1)]]);
    (square.determinant() > 0.0 && square.trace() > 0.0 && ellipse.semi_axes()[1].is_finite()).then_some(ellipse)
}

/// An ellipse fitted to points.
#[derive(Clone, Copy, Debug)]
pub struct Fit {
    /// The ellipse.
    pub ellipse: Ellipse,
    /// Cofactors of its unknowns (position, shape), px^2 per px^2 of a distance's variance.
    pub cofactors: SMatrix<f64, 5, 5>,
    /// Variance of one distance, px^2.
    pub variance: f64,
}

/// The ellipse of least orthogonal distances, from an approximate one; `None` when it comes to none.
///
/// Distances are those of first order, the deviation divided by its gradient, and exact on the ellipse itself.
pub fn orthogonal(points: &[Vector2<f64>], start: Ellipse) -> Option<Fit> {
    let mut ellipse = start;
    for _ in 0..30 {
        let (mut n, mut b, mut omega) = (SMatrix::<f64, 5, 5>::zeros(), SVector::<f64, 5>::zeros(), 0.0);
        let [axx, axy, ayy] = ellipse.shape;
        let inverse = Matrix2::new(axx, axy, axy, ayy).try_inverse()?;
        for point in points {
            let offset = inverse * (point - Vector2::from(ellipse.position));
            let radius = offset.norm();
            let unit = offset / radius;
            let gradient = inverse * unit;
            let (distance, normal) = ((radius - 1.0) / gradient.norm(), gradient.normalize());
            // How the ellipse's nearest point moves outwards.
            let j = SVector::from([normal.x, normal.y, normal.x * unit.x, normal.x * unit.y + normal.y * unit.x, normal.y * unit.y]);
            n += j * j.transpose();
            b += j * distance;
            omega += distance * distance;
        }
        let factor = n.cholesky()?;
        let step = factor.solve(&b);
        let [x, y] = ellipse.position;
        ellipse = Ellipse { position: [x + step[0], y + step[1]], shape: [axx + step[2], axy + step[3], ayy + step[4]] };
        let [large, small] = ellipse.semi_axes();
        if !large.is_finite() || small <= 1e-6 {
            return None;
        }
        if step.norm() < 1e-9 * large {
            let variance = omega / (points.len() as f64 - 5.0).max(1.0);
            return Some(Fit { ellipse, cofactors: factor.inverse(), variance });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_fits_find_the_ellipse_of_exact_points_on_any_arc() {
        let truth = Ellipse { position: [103.2, 57.9], shape: [6.0, 1.3, 3.5] };
        for arc in [std::f64::consts::TAU, 4.0, 2.5] {
            let points: Vec<_> = (0..40).map(|i| Vector2::from(truth.position) + truth.point(f64::from(i) / 40.0 * arc).0).collect();
            let first = direct(&points).unwrap();
            let differs = |e: &Ellipse| [0, 1].map(|i| (e.position[i] - truth.position[i]).abs()).into_iter().fold(0.0, f64::max);
            assert!(differs(&first) < 1e-7 && (first.shape[1] - 1.3).abs() < 1e-7, "{arc}: {first:?}");
            let rough = Ellipse { position: [103.4, 57.6], shape: [5.5, 1.0, 3.8] };
            let fit = orthogonal(&points, rough).unwrap();
            assert!(differs(&fit.ellipse) < 1e-9 && fit.variance < 1e-16, "{arc}: {fit:?}");
        }
    }

    #[test]
    fn a_line_is_no_ellipse() {
        let points: Vec<_> = (0..9).map(|i| Vector2::new(f64::from(i), 2.0 * f64::from(i))).collect();
        assert!(direct(&points).is_none());
    }
}
