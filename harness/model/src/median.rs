//! The middle of values.

/// The median: of an even number of values the mean of the middle two, in the unit of these. `None` of none.
///
/// Numbers that are none count as larger than all others.
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_unstable_by(f64::total_cmp);
    let upper = *values.get(values.len() / 2)?;
    Some(f64::midpoint(values[(values.len() - 1) / 2], upper))
}

/// The median that is one of the values: of an even number of them the larger of the middle two. `None` of none.
///
/// Numbers that are none count as larger than all others.
pub fn upper_median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_lies_between_the_middle_two_or_is_the_upper_one() {
        for (values, between, upper) in [
            (&[][..], None, None),
            (&[3.0], Some(3.0), Some(3.0)),
            (&[5.0, 1.0], Some(3.0), Some(5.0)),
            (&[9.0, 1.0, 4.0], Some(4.0), Some(4.0)),
            (&[8.0, 1.0, 4.0, 2.0], Some(3.0), Some(4.0)),
            (&[f64::INFINITY, 1.0, 2.0], Some(2.0), Some(2.0)),
        ] {
            let values = values.iter().copied();
            assert_eq!((median(values.clone()), upper_median(values)), (between, upper));
        }
    }

    #[test]
    fn numbers_that_are_none_are_the_largest() {
        assert_eq!(upper_median([f64::NAN, 2.0, 1.0]), Some(2.0));
        assert!(upper_median([f64::NAN, 1.0]).is_some_and(f64::is_nan));
    }
}
