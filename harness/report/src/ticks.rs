//! Round numbers for scales.

/// Round numbers from `low` to `high`, at most about five steps of 1, 2 or 5 times a power of ten apart.
pub(crate) fn linear(low: f64, high: f64) -> Vec<f64> {
    let wanted = (high - low) / 5.0;
    let decade = 10_f64.powf(wanted.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|factor| factor * decade).find(|step| *step >= wanted).unwrap_or(wanted);
    // An end that rounding put a little below its number counts.
    let (first, last) = ((low / step).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|index| index as f64 * step).collect()
}

/// The `factors` of each power of ten from `low` to `high`, both positive.
pub(crate) fn decades(low: f64, high: f64, factors: &[f64]) -> Vec<f64> {
    let powers = low.log10().floor() as i32..=high.log10().ceil() as i32;
    let all = powers.flat_map(|power| factors.iter().map(move |factor| rounded(factor * 10_f64.powi(power))));
    all.filter(|value| (low..=high).contains(value)).collect()
}

/// Without the rounding of powers of ten.
fn rounded(value: f64) -> f64 {
    format!("{value:.3e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_round_and_within_the_scale() {
        assert_eq!(linear(-0.3, 1.1), [0.0, 0.5, 1.0]);
        assert_eq!(linear(0.0, 100.0).len(), 6);
        assert_eq!(decades(0.012, 0.3, &[1.0, 2.0, 5.0]), [0.02, 0.05, 0.1, 0.2]);
    }
}
