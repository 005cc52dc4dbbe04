//! The extremum of a paraboloid through 3 x 3 samples, weighted by distance.

/// A paraboloid `f(x, y) = a0 x^2 + a1 y^2 + a2 xy + a3 x + a4 y + a5`, with (0, 0) at the middle sample, px, y down.
///
/// Source: Zhu et al. 2007, Eq. 4 (their Fig. 2 has y up: `a2` and `a4` change sign).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Paraboloid {
    /// The coefficients a0 to a5: a0, a1, a2 in the unit of f per px^2, a3, a4 in that per px, a5 in that of f.
    pub a: [f64; 6],
}

/// Weights `exp(-d^2 / k^2)` of a fit, worked out once for many fits.
///
/// By symmetry the normal equations of nine samples and six unknowns fall apart, and with `q = exp(-1 / k^2)`, the weight of a direct neighbour, all
/// weights stand in ratios 1 : q : q^2; divided out, nothing is lost however small `q` is: at `k = 0.2` it is e^-25, and the
/// limit `q = 0` is that of finite differences, `q = 1` the unweighted fit.
///
/// Source: Zhu et al. 2007, Eq. 10.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weights {
    q: f64,
    /// `1 / (2 + 4 q)`.
    odd: f64,
    /// `2 q / (1 + 2 q)`.
    even: f64,
}

impl Weights {
    /// For `k` px, positive.
    pub fn new(k: f64) -> Self {
        let q = (-1.0 / (k * k)).exp();
        Self { q, odd: 1.0 / (2.0 + 4.0 * q), even: 2.0 * q / (1.0 + 2.0 * q) }
    }

    /// The least-squares paraboloid for `f[row][column]`, samples 1 px apart, of any unit.
    ///
    /// Source: Zhu et al. 2007, Eq. 9 to 11, solved in closed form.
    #[inline]
    pub fn fit(&self, f: &[[f64; 3]; 3]) -> Paraboloid {
        let [[nw, north, ne], [west, centre, east], [sw, south, se]] = *f;
        let a2 = (nw + se - ne - sw) / 4.0;
        let a3 = ((east - west) + self.q * ((ne + se) - (nw + sw))) * self.odd;
        let a4 = ((south - north) + self.q * ((sw + se) - (nw + ne))) * self.odd;
        // The even part: means along x, along y and over the diagonals, with one condition between them, `misclosure = 0`.
        let (x, y, diagonal) = ((east + west) / 2.0, (north + south) / 2.0, (nw + ne + sw + se) / 4.0);
        let misclosure = centre - x - y + diagonal;
        let share = self.even * misclosure;
        let a0 = x - centre + share;
        let a1 = y - centre + share;
        let a5 = centre - self.even * share;
        Paraboloid { a: [a0, a1, a2, a3, a4, a5] }
    }
}

impl Paraboloid {
    /// The weighted least-squares fit to `f[row][column]` with weights `exp(-d^2 / k^2)`; for many fits see [`Weights`]. `k` in px, positive.
    ///
    /// Source: Zhu et al. 2007, Eq. 9 to 11, solved in closed form.
    pub fn fit(f: &[[f64; 3]; 3], k: f64) -> Self {
        Weights::new(k).fit(f)
    }

    /// Where the paraboloid has its maximum, from the middle sample, px; `None` if it has none (a saddle, a valley, a cylinder).
    ///
    /// Source: Zhu et al. 2007, Eq. 12.
    #[inline]
    pub fn maximum(&self) -> Option<(f64, f64)> {
        let [a0, a1, a2, a3, a4, _] = self.a;
        let denominator = a2 * a2 - 4.0 * a1 * a0;
        (a0 < 0.0 && denominator < 0.0).then(|| ((2.0 * a1 * a3 - a2 * a4) / denominator, (2.0 * a0 * a4 - a2 * a3) / denominator))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{SMatrix, SVector};

    const SAMPLES: [[f64; 3]; 3] = [[0.31, 0.62, 0.44], [0.58, 1.0, 0.71], [0.27, 0.66, 0.53]];

    /// The second method: the normal equations as printed, solved numerically.
    fn by_normal_equations(f: &[[f64; 3]; 3], k: f64) -> [f64; 6] {
        let mut design = SMatrix::<f64, 9, 6>::zeros();
        let mut weighted = SVector::<f64, 9>::zeros();
        for i in 0..9 {
            let (x, y) = ((i % 3) as f64 - 1.0, (i / 3) as f64 - 1.0);
            let root = (-(x * x + y * y) / (k * k) / 2.0).exp();
            design.set_row(i, &(SMatrix::<f64, 1, 6>::new(x * x, y * y, x * y, x, y, 1.0) * root));
            weighted[i] = f[i / 3][i % 3] * root;
        }
        let solution = design.svd(true, true).solve(&weighted, 1e-14).unwrap();
        solution.as_slice().try_into().unwrap()
    }

    #[test]
    fn closed_form_is_the_least_squares_solution() {
        for k in [0.5, 0.7, 1.0, 2.0, 100.0] {
            let (closed, normal) = (Paraboloid::fit(&SAMPLES, k).a, by_normal_equations(&SAMPLES, k));
            for (a, b) in closed.iter().zip(normal) {
                assert!((a - b).abs() < 1e-11, "k = {k}: {closed:?} {normal:?}");
            }
        }
    }

    #[test]
    fn small_k_tends_to_finite_differences() {
        let [[f0, f1, f2], [f3, f4, f5], [f6, f7, f8]] = SAMPLES;
        // y down here, up in the paper: a2 and a4 have the other sign.
        let expected = [(f3 + f5) / 2.0 - f4, (f1 + f7) / 2.0 - f4, -(f2 + f6 - f0 - f8) / 4.0, (f5 - f3) / 2.0, -(f1 - f7) / 2.0, f4];
        for k in [0.2, 0.01, 1e-150] {
            let found = Paraboloid::fit(&SAMPLES, k).a;
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-10), "{k}: {found:?} {expected:?}");
        }
    }

    #[test]
    fn a_paraboloid_is_found_exactly() {
        let truth = Paraboloid { a: [-1.3, -0.8, 0.4, 0.2, -0.3, 5.0] };
        let mut f = [[0.0; 3]; 3];
        for (row, values) in f.iter_mut().enumerate() {
            for (column, value) in values.iter_mut().enumerate() {
                let (x, y) = (column as f64 - 1.0, row as f64 - 1.0);
                let [a0, a1, a2, a3, a4, a5] = truth.a;
                *value = a0 * x * x + a1 * y * y + a2 * x * y + a3 * x + a4 * y + a5;
            }
        }
        for k in [0.2, 1.0, 10.0] {
            let fitted = Paraboloid::fit(&f, k);
            let ((x, y), (tx, ty)) = (fitted.maximum().unwrap(), truth.maximum().unwrap());
            assert!((x - tx).abs() < 1e-12 && (y - ty).abs() < 1e-12);
            // The gradient vanishes there.
            let [a0, a1, a2, a3, a4, _] = truth.a;
            assert!((2.0 * a0 * x + a2 * y + a3).abs() < 1e-12 && (2.0 * a1 * y + a2 * x + a4).abs() < 1e-12);
        }
    }

    #[test]
    fn saddles_and_valleys_have_no_maximum() {
        assert_eq!(Paraboloid { a: [-1.0, 1.0, 0.0, 0.1, 0.1, 0.0] }.maximum(), None);
        assert_eq!(Paraboloid { a: [1.0, 1.0, 0.0, 0.1, 0.1, 0.0] }.maximum(), None);
        assert_eq!(Paraboloid { a: [-1.0, -1.0, 2.0, 0.1, 0.1, 0.0] }.maximum(), None);
        assert_eq!(Paraboloid { a: [f64::NAN; 6] }.maximum(), None);
    }
}
