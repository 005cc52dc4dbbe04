//! Least squares by differences, for a handful of unknowns.

use nalgebra::{SMatrix, SVector};

/// Steps at most.
const STEPS: usize = 200;
/// Damping at first, and at most.
const DAMPING: (f64, f64) = (1e-3, 1e12);

/// The least sum of squares of `residuals` from `start` downhill, with the place of it: Levenberg and Marquardt, derivatives by forward differences of
/// `difference`. A step that lowers the sum of squares by less than `small`, as a part of it, is the last.
///
/// `residuals` are as many everywhere, `None` where there are none. `None` where there are none at the start.
pub fn least_squares<const N: usize>(
    start: [f64; N],
    (difference, small): (f64, f64),
    residuals: impl Fn(&[f64; N]) -> Option<Vec<f64>>,
) -> Option<([f64; N], f64)> {
    let squares = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>();
    let mut at = start;
    let mut values = residuals(&at)?;
    let (mut cost, mut damping) = (squares(&values), DAMPING.0);
    for _ in 0..STEPS {
        let columns = slopes(&at, &values, difference, &residuals);
        let normal = SMatrix::<f64, N, N>::from_fn(|i, k| dot(&columns[i], &columns[k]));
        let right = SVector::<f64, N>::from_fn(|i, _| -dot(&columns[i], &values));
        let before = cost;
        while damping < DAMPING.1 {
            let damped = SMatrix::<f64, N, N>::from_fn(|i, k| normal[(i, k)] * if i == k { 1.0 + damping } else { 1.0 });
            let step = damped.cholesky().map(|factor| factor.solve(&right));
            let next = step.map(|step| std::array::from_fn(|i| at[i] + step[i]));
            let found = next.and_then(|next| residuals(&next).map(|values| (next, squares(&values), values)));
            match found {
                Some((next, lower, new)) if lower < cost => {
                    (at, cost, values) = (next, lower, new);
                    damping = (damping * 0.2).max(1e-9);
                    break;
                }
                _ => damping *= 5.0,
            }
        }
        if before - cost <= small * before {
            break;
        }
    }
    Some((at, cost))
}

/// The derivatives of all residuals by each unknown; zero where there are none beside `at`.
fn slopes<const N: usize>(
    at: &[f64; N],
    values: &[f64],
    difference: f64,
    residuals: &impl Fn(&[f64; N]) -> Option<Vec<f64>>,
) -> Vec<Vec<f64>> {
    let beside = |index: usize| {
        let mut moved = *at;
        moved[index] += difference;
        residuals(&moved).map_or_else(|| vec![0.0; values.len()], |new| new.iter().zip(values).map(|(n, v)| (n - v) / difference).collect())
    };
    (0..N).map(beside).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
