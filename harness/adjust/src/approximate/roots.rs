//! Real roots of polynomials.

/// Newton steps and halvings at most.
const MOST_STEPS: usize = 200;
/// A value at an extremum, relative to the sum of the terms' magnitudes, that counts as a double root.
const TOUCHING: f64 = 1e-14;

/// The real roots of `sum c_i x^i`, in no fixed order; a double root may come once or twice. Leading zeros are allowed.
///
/// The roots of the derivative part the line into pieces that hold one root each; roots beyond 1 are those of the reversed polynomial within 1.
pub(super) fn real_roots(coefficients: &[f64]) -> Vec<f64> {
    let largest = coefficients.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
    if !largest.is_finite() || largest == 0.0 {
        return Vec::new();
    }
    let scaled: Vec<f64> = coefficients.iter().map(|c| c / largest).collect();
    let mut roots = within_one(&scaled);
    let reversed: Vec<f64> = scaled.iter().rev().copied().collect();
    let outer = within_one(&reversed).into_iter().filter(|y| y.abs() < 1.0 && *y != 0.0).map(f64::recip);
    roots.extend(outer.filter(|x| x.is_finite()));
    roots
}

/// Value, slope and the sum of the terms' magnitudes at `x`.
fn evaluate(coefficients: &[f64], x: f64) -> (f64, f64, f64) {
    let (mut value, mut slope, mut size) = (0.0, 0.0, 0.0);
    for c in coefficients.iter().rev() {
        slope = slope * x + value;
        value = value * x + c;
        size = size * x.abs() + c.abs();
    }
    (value, slope, size)
}

/// The roots in [-1, 1], ascending.
fn within_one(coefficients: &[f64]) -> Vec<f64> {
    if coefficients.len() < 2 {
        return Vec::new();
    }
    let derivative: Vec<f64> = coefficients.iter().enumerate().skip(1).map(|(i, c)| i as f64 * c).collect();
    let mut ends = vec![-1.0];
    ends.extend(within_one(&derivative).into_iter().filter(|x| x.abs() < 1.0));
    ends.push(1.0);
    let mut roots = Vec::new();
    for pair in ends.windows(2) {
        let ((low, _, low_size), (high, _, _)) = (evaluate(coefficients, pair[0]), evaluate(coefficients, pair[1]));
        let touches = low.abs() <= TOUCHING * low_size;
        if touches {
            roots.push(pair[0]);
        } else if low * high < 0.0 {
            roots.push(between(coefficients, pair[0], pair[1], low));
        }
    }
    let (last, _, size) = evaluate(coefficients, 1.0);
    if last.abs() <= TOUCHING * size {
        roots.push(1.0);
    }
    roots
}

/// The root between `low` and `high`, where the signs differ: Newton, and halving where it leaves the interval or is slow.
fn between(coefficients: &[f64], mut low: f64, mut high: f64, at_low: f64) -> f64 {
    let mut x = 0.5 * (low + high);
    let mut before = high - low;
    for _ in 0..MOST_STEPS {
        let (value, slope, _) = evaluate(coefficients, x);
        if value == 0.0 {
            return x;
        }
        (low, high) = if value * at_low > 0.0 { (x, high) } else { (low, x) };
        let newton = x - value / slope;
        let inside = newton > low && newton < high && (newton - x).abs() < 0.5 * before;
        let next = if inside { newton } else { 0.5 * (low + high) };
        before = (next - x).abs();
        if before <= f64::EPSILON * x.abs().max(f64::MIN_POSITIVE) || next == x {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expand(roots: &[f64], pairs: &[[f64; 2]]) -> Vec<f64> {
        let times = |p: &[f64], q: &[f64]| {
            let mut product = vec![0.0; p.len() + q.len() - 1];
            p.iter().enumerate().for_each(|(i, a)| q.iter().enumerate().for_each(|(j, b)| product[i + j] += a * b));
            product
        };
        let linear = roots.iter().fold(vec![1.0], |p, r| times(&p, &[-r, 1.0]));
        pairs.iter().fold(linear, |p, [re, im]| times(&p, &[re * re + im * im, -2.0 * re, 1.0]))
    }

    fn sorted(mut values: Vec<f64>) -> Vec<f64> {
        values.sort_by(f64::total_cmp);
        values
    }

    #[test]
    fn inner_and_outer_roots_of_a_tenth_degree() {
        let roots = [-130.0, -2.0, -0.3, 0.01, 0.4, 5.0];
        let found = sorted(real_roots(&expand(&roots, &[[0.3, 0.5], [-3.0, 1.0]])));
        assert_eq!(found.len(), 6, "{found:?}");
        roots.iter().zip(&found).for_each(|(r, f)| assert!((r - f).abs() < 1e-11 * r.abs().max(0.1), "{r} {f}"));
    }

    #[test]
    fn degenerate_polynomials() {
        assert!(real_roots(&[]).is_empty());
        assert!(real_roots(&[0.0, 0.0]).is_empty());
        assert!(real_roots(&[3.0]).is_empty());
        assert!(real_roots(&[1.0, f64::NAN]).is_empty());
        assert!(real_roots(&[1.0, 0.0, 1.0]).is_empty());
        assert_eq!(real_roots(&[-1.0, 2.0, 0.0, 0.0]), [0.5]);
        assert_eq!(sorted(real_roots(&[0.0, -4.0, 0.0, 1.0])), [-2.0, 0.0, 2.0]);
        let double = real_roots(&[0.25, -1.0, 1.0]);
        assert!(!double.is_empty() && double.iter().all(|x| (x - 0.5).abs() < 1e-7), "{double:?}");
    }

    proptest::proptest! {
        #[test]
        fn every_root_of_a_product_is_found(roots in proptest::collection::vec(-10.0..10.0f64, 1..6)) {
            let roots = sorted(roots);
            let apart = roots.windows(2).all(|w| w[1] - w[0] > 0.1);
            proptest::prop_assume!(apart && roots.iter().all(|r| (r.abs() - 1.0).abs() > 1e-3));
            let found = sorted(real_roots(&expand(&roots, &[])));
            proptest::prop_assert_eq!(found.len(), roots.len());
            for (root, found) in roots.iter().zip(&found) {
                proptest::prop_assert!((root - found).abs() < 1e-7);
            }
        }
    }
}
