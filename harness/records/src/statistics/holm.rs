//! Holm's correction for many tests.

/// The p-values (0 to 1) adjusted for each other, in the order given: a test is significant at the family-wise level alpha
/// when its adjusted value is at most alpha.
///
/// The chance that any true hypothesis is rejected is at most alpha, however the tests depend on each other. A value that is
/// not a number counts as 0: what cannot be judged must not pass.
///
/// Source: Holm 1979, A simple sequentially rejective multiple test procedure, Scand. J. Statist. 6, 65-70.
pub fn holm(p: &[f64]) -> Vec<f64> {
    let value = |index: usize| if p[index].is_nan() { 0.0 } else { p[index] };
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| value(*a).total_cmp(&value(*b)));
    let mut adjusted = vec![0.0; p.len()];
    let mut largest: f64 = 0.0;
    for (rank, index) in order.into_iter().enumerate() {
        largest = largest.max((value(index) * (p.len() - rank) as f64).min(1.0));
        adjusted[index] = largest;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::holm;

    /// The thrombolysis trial of Benjamini & Hochberg 1995, J. R. Statist. Soc. B 57, Sect. 4: with the family-wise error rate
    /// held at 0.05, three of the fifteen hypotheses are rejected.
    #[test]
    fn the_example_of_benjamini_and_hochberg() {
        let p = [0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344, 0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0];
        let adjusted = holm(&p);
        assert_eq!(adjusted.iter().filter(|p| **p <= 0.05).count(), 3);
        for (found, expected) in adjusted.iter().zip([0.0015, 0.0056, 0.0247, 0.1140]) {
            assert!((found - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn adjusted_values_keep_the_order_given_and_never_fall() {
        let adjusted = holm(&[0.01, 0.04, 0.03, 0.005]);
        for (found, expected) in adjusted.iter().zip([0.03, 0.06, 0.06, 0.02]) {
            assert!((found - expected).abs() < 1e-15);
        }
        assert_eq!(holm(&[0.5, f64::NAN]), [0.5, 0.0]);
        assert!(holm(&[]).is_empty());
    }
}
