//! The test of a parameter against zero, by Student's density integrated here.

use calibench_adjust::{Options, Variance, adjust};

use crate::networks;

/// Simpson's rule for the density of Student's distribution, without its constant factor, from `from` on; `t = from + u / (1 - u)`.
fn upper_area(from: f64, freedom: f64) -> f64 {
    let density = |t: f64| (-(freedom + 1.0) / 2.0 * (t * t / freedom).ln_1p()).exp();
    let steps = 20_000;
    let value = |k: i32| {
        let u = f64::from(k) / f64::from(steps);
        if k == steps { 0.0 } else { density(from + u / (1.0 - u)) / (1.0 - u).powi(2) }
    };
    let inner: f64 = (1..steps).map(|k| if k % 2 == 1 { 4.0 * value(k) } else { 2.0 * value(k) }).sum();
    (value(0) + inner + value(steps)) / (3.0 * f64::from(steps))
}

/// Both tails: a parameter is as doubtful below zero as above.
#[test]
fn p_is_the_area_beyond_t_on_both_sides() {
    let mut network = networks::ring_from(networks::photogrammetric(), 4.2, 5, 14, 6);
    networks::shake_pixels(&mut network, 0.5, &mut networks::random(31));
    networks::free(&mut network, &["c", "x0", "y0", "k1", "k3", "p1", "b1", "b2"]);
    networks::control(&mut network, 3, 1e-3);
    let solution = adjust(&network, &Options::default()).unwrap();
    let freedom = solution.counts().redundancy() as f64;
    let all = upper_area(0.0, freedom);
    let covariances = solution.covariances(Variance::Estimated).unwrap();
    let tests = solution.significance(&covariances).unwrap();
    assert_eq!(tests.len(), 8);
    for (k, test) in tests.iter().enumerate() {
        assert!((test.sigma / covariances.interior[(k, k)].sqrt() - 1.0).abs() < 1e-12);
        assert!((test.t - test.value / test.sigma).abs() < 1e-12 * test.t.abs());
        let expected = upper_area(test.t.abs(), freedom) / all;
        assert!((test.p - expected).abs() < 1e-9 + 1e-6 * expected, "{}: {} is not {expected}", test.parameter, test.p);
    }
    assert!(tests.iter().any(|test| test.t < 0.0) && tests.iter().any(|test| (0.05..0.95).contains(&test.p)), "{tests:?}");
}
