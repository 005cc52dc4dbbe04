//! Gauss-Legendre quadrature.

use std::f64::consts::PI;

/// Nodes and weights of the Gauss-Legendre rule of `n` points on the interval from 0 to 1.
///
/// Nodes rise, weights add up to 1; polynomials up to degree 2n - 1 are integrated exactly, to rounding. Empty for `n` = 0.
/// Nodes are found by Newton's method on the Legendre polynomial, its values by the three-term recurrence.
///
/// Source: Abramowitz & Stegun 1964, 25.4.29 (on -1 to 1) and 22.7.10.
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (value, below) = legendre(n, x);
            slope = n as f64 * (x * value - below) / (x * x - 1.0);
            let step = value / slope;
            x -= step;
            if step.abs() < 1e-16 {
                break;
            }
        }
        (0.5 * (1.0 - x), 1.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// Values at `x` of the Legendre polynomials of degree `n` (1 or more) and `n - 1`.
fn legendre(n: usize, x: f64) -> (f64, f64) {
    (1..n).fold((x, 1.0), |(value, below), k| {
        let k = k as f64;
        (((2.0 * k + 1.0) * x * value - k * below) / (k + 1.0), value)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_integrated_exactly() {
        for n in 1..40 {
            let rule = gauss_legendre(n);
            assert!(rule.windows(2).all(|pair| pair[0].0 < pair[1].0));
            for degree in 0..2 * n as i32 {
                let integral: f64 = rule.iter().map(|(x, w)| w * x.powi(degree)).sum();
                assert!((integral * f64::from(degree + 1) - 1.0).abs() < 1e-12, "{n} {degree}");
            }
        }
    }
}
