//! The theoretical precision of the paraboloid's maximum.

use crate::paraboloid::{Paraboloid, Weights};

/// Covariances of the nine strengths f0 to f8, which are counted row by row: 9 x 9, in the squared unit of the strengths.
pub type SampleCovariance = [[f64; 9]; 9];

/// Which solution is propagated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// Eq. 11 as printed: `T(5, 6) = +0.5`, `F = (f1, f2, f3, f4, f5, f6)`. Two misprints: its `a4` is that of no paraboloid through the samples.
    Printed,
    /// Eq. 11 corrected: `T(5, 6) = -0.5`, `F = (f1, f2, f3, f4, f5, f7)`: the paraboloid through six samples, from which the paper starts.
    Corrected,
    /// The adjusted solution with nine samples, which is what the paper's method (and ours) delivers; weights as in Eq. 10.
    Adjusted(Weights),
}

/// Variances of the position of the maximum, px^2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Precision {
    /// `sigma_x^2`, px^2, Eq. 15.
    pub xx: f64,
    /// `sigma_y^2`, px^2, Eq. 16.
    pub yy: f64,
}

impl Precision {
    /// `sqrt(sigma_x^2 + sigma_y^2)`, px.
    pub fn sigma(self) -> f64 {
        (self.xx + self.yy).sqrt()
    }
}

/// The map from the nine samples to the six coefficients, y up as in the paper's Fig. 2.
type Map = [[f64; 9]; 6];

/// The covariance of independent samples of one variance, in its unit.
pub fn white(variance: f64) -> SampleCovariance {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { variance } else { 0.0 }))
}

/// Variances (px^2) of the maximum of the paraboloid for strengths `f[row][column]`, 1 px apart, with covariance `q_ff`; `None` where it has no
/// extremum.
///
/// Source: Zhu et al. 2007, Eq. 14 to 18; Eq. 11 as `form` says.
pub fn precision(form: Form, f: &[[f64; 3]; 3], q_ff: &SampleCovariance) -> Option<Precision> {
    let map = map(form);
    let samples: [f64; 9] = std::array::from_fn(|i| f[i / 3][i % 3]);
    let a = map.map(|row| row.iter().zip(&samples).map(|(t, f)| t * f).sum::<f64>());
    let (k1, k2) = derivatives(&a)?;
    let variance = |k: &[f64; 6]| {
        let row: [f64; 9] = std::array::from_fn(|j| (0..6).map(|i| k[i] * map[i][j]).sum());
        (0..9).flat_map(|i| (0..9).map(move |j| (i, j))).map(|(i, j)| row[i] * q_ff[i][j] * row[j]).sum::<f64>()
    };
    Some(Precision { xx: variance(&k1), yy: variance(&k2) })
}

/// T of Eq. 11, or of the adjusted solution.
fn map(form: Form) -> Map {
    match form {
        Form::Printed => spread([1, 2, 3, 4, 5, 6], 0.5),
        Form::Corrected => spread([1, 2, 3, 4, 5, 7], -0.5),
        Form::Adjusted(weights) => {
            let mut map = [[0.0; 9]; 6];
            for sample in 0..9 {
                let mut unit = [[0.0; 3]; 3];
                unit[sample / 3][sample % 3] = 1.0;
                let Paraboloid { a: [a0, a1, a2, a3, a4, a5] } = weights.fit(&unit);
                // y is down in the fit and up here.
                for (row, value) in map.iter_mut().zip([a0, a1, -a2, a3, -a4, a5]) {
                    row[sample] = value;
                }
            }
            map
        }
    }
}

/// The 6 x 6 matrix as printed but for `T(5, 6)`, for the samples in `chosen`.
fn spread(chosen: [usize; 6], t56: f64) -> Map {
    let printed = [
        [0.0, 0.0, 0.5, -1.0, 0.5, 0.0],
        [0.5, 0.0, 0.0, -1.0, 0.0, 0.5],
        [-1.0, 1.0, 0.0, 1.0, -1.0, 0.0],
        [0.0, 0.0, -0.5, 0.0, 0.5, 0.0],
        [0.5, 0.0, 0.0, 0.0, 0.0, t56],
        [0.0, 0.0, 0.0, 1.0, 0.0, 0.0],
    ];
    printed.map(|row| std::array::from_fn(|sample| chosen.iter().position(|&c| c == sample).map_or(0.0, |column| row[column])))
}

/// Derivatives of the maximum's x (Eq. 17) and y (Eq. 18) by the coefficients.
fn derivatives(&[a0, a1, a2, a3, a4, _]: &[f64; 6]) -> Option<([f64; 6], [f64; 6])> {
    let d = a2 * a2 - 4.0 * a1 * a0;
    if d == 0.0 || !d.is_finite() {
        return None;
    }
    let k1 = [
        4.0 * a1 * (2.0 * a1 * a3 - a2 * a4) / (d * d),
        (2.0 * a2 * a2 * a3 - 4.0 * a0 * a2 * a4) / (d * d),
        (a2 * a2 * a4 - 4.0 * a1 * a2 * a3 + 4.0 * a0 * a1 * a4) / (d * d),
        2.0 * a1 / d,
        -a2 / d,
        0.0,
    ];
    let k2 = [
        (2.0 * a2 * a2 * a4 - 4.0 * a1 * a2 * a3) / (d * d),
        (8.0 * a0 * a0 * a4 - 4.0 * a0 * a2 * a3) / (d * d),
        (a2 * a2 * a3 + 4.0 * a0 * a1 * a3 - 4.0 * a0 * a2 * a4) / (d * d),
        -a2 / d,
        2.0 * a0 / d,
        0.0,
    ];
    Some((k1, k2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::closed_form_images::Noise;

    const STRENGTHS: [[f64; 3]; 3] = [[0.61, 0.78, 0.60], [0.80, 1.0, 0.71], [0.52, 0.74, 0.63]];

    /// Eq. 12, y up.
    fn maximum(&[a0, a1, a2, a3, a4, _]: &[f64; 6]) -> [f64; 2] {
        let d = a2 * a2 - 4.0 * a1 * a0;
        [(2.0 * a1 * a3 - a2 * a4) / d, (2.0 * a0 * a4 - a2 * a3) / d]
    }

    #[test]
    fn equations_17_and_18_are_the_derivatives_of_12() {
        let a = [-0.31, -0.24, 0.05, 0.04, -0.03, 1.0];
        let (k1, k2) = derivatives(&a).unwrap();
        for i in 0..6 {
            let h = 1e-6;
            let moved = |by: f64| maximum(&std::array::from_fn(|j| if i == j { a[j] + by } else { a[j] }));
            let (low, high) = (moved(-h), moved(h));
            assert!((k1[i] - (high[0] - low[0]) / (2.0 * h)).abs() < 1e-7 && (k2[i] - (high[1] - low[1]) / (2.0 * h)).abs() < 1e-7, "{i}");
        }
    }

    /// Empirical standard deviation of the solution `form` for samples with noise.
    fn empirical(form: Form, sigma: f64) -> f64 {
        let (map, mut noise) = (map(form), Noise(4));
        let solve = |f: &[f64; 9]| maximum(&map.map(|row| row.iter().zip(f).map(|(t, f)| t * f).sum()));
        let exact: [f64; 9] = std::array::from_fn(|i| STRENGTHS[i / 3][i % 3]);
        let truth = solve(&exact);
        let trials = 20_000;
        let squares = (0..trials).map(|_| {
            let [x, y] = solve(&exact.map(|f| f + sigma * noise.normal()));
            (x - truth[0]).powi(2) + (y - truth[1]).powi(2)
        });
        (squares.sum::<f64>() / f64::from(trials)).sqrt()
    }

    #[test]
    fn the_precision_is_that_of_a_monte_carlo() {
        for form in [Form::Printed, Form::Corrected, Form::Adjusted(Weights::new(0.2)), Form::Adjusted(Weights::new(2.0))] {
            let sigma = 0.002;
            let (theory, found) = (precision(form, &STRENGTHS, &white(sigma * sigma)).unwrap().sigma(), empirical(form, sigma));
            // 40000 squares: 0.35 % of a standard deviation.
            assert!((theory / found - 1.0).abs() < 0.015, "{form:?}: {theory} {found}");
        }
    }

    #[test]
    fn the_misprints_matter_and_only_the_adjusted_form_is_the_methods_own() {
        let sigma = |form| precision(form, &STRENGTHS, &white(1e-6)).unwrap().sigma();
        let adjusted = sigma(Form::Adjusted(Weights::new(0.2)));
        let fitted = |noise: &mut Noise| {
            let f = STRENGTHS.map(|row| row.map(|f| f + 1e-3 * noise.normal()));
            Weights::new(0.2).fit(&f).maximum().unwrap()
        };
        let (truth, mut noise) = (Weights::new(0.2).fit(&STRENGTHS).maximum().unwrap(), Noise(9));
        let squares = (0..20_000).map(|_| fitted(&mut noise)).map(|(x, y)| (x - truth.0).powi(2) + (y - truth.1).powi(2));
        let found = (squares.sum::<f64>() / 20_000.0).sqrt();
        assert!((adjusted / found - 1.0).abs() < 0.015, "{adjusted} {found}");
        assert!(sigma(Form::Printed) > 2.0 * adjusted, "{} {adjusted}", sigma(Form::Printed));
    }

    #[test]
    fn a_flat_patch_has_none() {
        assert_eq!(precision(Form::Corrected, &[[1.0; 3]; 3], &white(1.0)), None);
    }
}
