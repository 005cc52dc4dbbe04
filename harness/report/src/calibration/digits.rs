//! Values with the digits that their standard deviations leave.

/// A value with the digits that its standard deviation leaves, and that with two.
pub(super) fn rounded(value: f64, sigma: f64) -> (String, String) {
    if sigma <= 0.0 || !sigma.is_finite() {
        return (value.to_string(), sigma.to_string());
    }
    let digits = 1 - sigma.log10().floor() as i32;
    if (0..=8).contains(&digits) {
        let digits = digits as usize;
        return (format!("{value:.digits$}"), format!("{sigma:.digits$}"));
    }
    let more = if value == 0.0 { 1 } else { (value.abs().log10().floor() - sigma.log10().floor()) as i32 + 1 };
    (format!("{value:.*e}", more.clamp(0, 16) as usize), format!("{sigma:.1e}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_has_the_digits_that_its_standard_deviation_leaves() {
        let text = |value: f64, sigma: f64| {
            let (value, sigma) = rounded(value, sigma);
            format!("{value} {sigma}")
        };
        assert_eq!(text(532.8163, 0.441), "532.82 0.44");
        assert_eq!(text(-0.2809, 0.0054), "-0.2809 0.0054");
        assert_eq!(text(1234.5, 31.0), "1234 31");
        assert_eq!(text(1.234_567e-9, 2.5e-11), "1.235e-9 2.5e-11");
        assert_eq!(text(0.0, 2.5e-11), "0.0e0 2.5e-11");
        assert_eq!(text(3.5, 0.0), "3.5 0");
    }
}
