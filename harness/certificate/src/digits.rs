//! Numbers as a certificate prints them.

/// A value to the place of the second digit of its uncertainty, and that uncertainty with two digits, as GUM 7.2.6 advises. Very small and large ones with a power of ten.
pub fn with_uncertainty(value: f64, uncertainty: f64) -> (String, String) {
    if !(uncertainty > 0.0 && uncertainty.is_finite()) {
        return (value.to_string(), "0".into());
    }
    let digits = 1 - exponent(uncertainty, 2);
    if (0..=7).contains(&digits) {
        let digits = digits as usize;
        return (format!("{value:.digits$}"), format!("{uncertainty:.digits$}"));
    }
    let more = if value == 0.0 { 1 } else { exponent(value, 2) + digits };
    (power(format!("{value:.*e}", more.clamp(0, 16) as usize)), power(format!("{uncertainty:.1e}")))
}

/// With three digits.
pub fn three(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".into() } else { "unbounded".into() };
    }
    let exponent = exponent(value, 3);
    if (-5..=6).contains(&exponent) { format!("{value:.*}", (2 - exponent).max(0) as usize) } else { power(format!("{value:.2e}")) }
}

/// The power of ten of a number that is printed with so many digits: of 0.0996 with two it is that of 0.10.
fn exponent(value: f64, digits: usize) -> i32 {
    format!("{:.*e}", digits - 1, value.abs()).rsplit_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or(0)
}

/// `1.2e-9` as `1.2·10^-9`, which nobody takes for a product with Euler's number.
fn power(text: String) -> String {
    match text.split_once('e') {
        Some((digits, "0")) => digits.to_owned(),
        Some((digits, power)) => format!("{digits}\u{b7}10^{power}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_uncertainty_has_two_digits_and_its_value_as_many_places() {
        let of = |value, uncertainty| {
            let (value, uncertainty) = with_uncertainty(value, uncertainty);
            format!("{value} {uncertainty}")
        };
        assert_eq!(of(532.8163, 0.441), "532.82 0.44");
        assert_eq!(of(-0.2809, 0.0054), "-0.2809 0.0054");
        // Rounded up it has another first digit.
        assert_eq!(of(1.0, 0.0996), "1.00 0.10");
        assert_eq!(of(1234.5, 31.0), "1234 31");
        assert_eq!(of(1.234_567e-9, 2.5e-11), "1.235\u{b7}10^-9 2.5\u{b7}10^-11");
        assert_eq!(of(3.5, 0.0), "3.5 0");
    }

    #[test]
    fn three_digits_are_three() {
        assert_eq!(
            [0.012_345, 1.0, 999.6, 1e-9, 0.0, f64::NAN].map(three),
            ["0.0123", "1.00", "1000", "1.00\u{b7}10^-9", "0", "unbounded"]
        );
    }
}
