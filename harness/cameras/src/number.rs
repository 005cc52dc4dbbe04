//! Numbers in text.

use super::CameraFileError;

/// A finite number.
pub(super) fn finite(text: &str) -> Result<f64, CameraFileError> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        _ => Err(CameraFileError::new(format!("expected a finite number with a decimal point, found `{}`", shortened(text)))),
    }
}

/// A number of pixels: 1 to 2^20.
pub(super) fn pixels(text: &str) -> Result<u32, CameraFileError> {
    let wrong = || CameraFileError::new(format!("expected a whole number of pixels from 1 to {MOST_PIXELS}, found `{}`", shortened(text)));
    let number = finite(text).map_err(|_| wrong())?;
    if number.fract() != 0.0 || number < 1.0 || number > f64::from(MOST_PIXELS) {
        return Err(wrong());
    }
    Ok(number as u32)
}

const MOST_PIXELS: u32 = 1 << 20;

/// The finite numbers of a text, separated by white space: exactly `N`.
pub(super) fn numbers<const N: usize>(text: &str) -> Result<[f64; N], CameraFileError> {
    let mut found = [0.0; N];
    let count = text.split_whitespace().count();
    if count != N {
        return Err(CameraFileError::new(format!("expected {N} numbers, found {count}")));
    }
    for (slot, word) in found.iter_mut().zip(text.split_whitespace()) {
        *slot = finite(word)?;
    }
    Ok(found)
}

/// What errors quote of a text that may be long.
pub(super) fn shortened(text: &str) -> String {
    const MOST: usize = 40;
    let text = text.trim();
    if text.chars().count() <= MOST { text.to_owned() } else { text.chars().take(MOST).chain("...".chars()).collect() }
}

/// 17 significant digits as C prints them: `6.6217434572062830e+03`.
pub(super) fn scientific(value: f64) -> String {
    let text = format!("{value:.16e}");
    let Some((mantissa, exponent)) = text.split_once('e') else { return text };
    let (sign, digits) = exponent.strip_prefix('-').map_or(('+', exponent), |digits| ('-', digits));
    format!("{mantissa}e{sign}{digits:0>2}")
}

/// The shortest decimals that are read back exactly; very large and small numbers as [`scientific`], with the point that YAML 1.1 wants.
pub(super) fn shortest(value: f64) -> String {
    let text = format!("{value:?}");
    if text.contains('e') { scientific(value) } else { text }
}

/// Numbers in a row, between commas.
pub(super) fn row(values: &[f64]) -> String {
    values.iter().map(|&value| shortest(value)).collect::<Vec<_>>().join(", ")
}

/// Decimals without an exponent, at least 20 and at least 17 significant digits: as Pix4D prints.
pub(super) fn fixed(value: f64) -> String {
    let below = if value == 0.0 { 0.0 } else { (-value.abs().log10().floor()).max(0.0) };
    format!("{value:.*}", (17 + below as usize).max(20))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn written_numbers_are_read_exactly() {
        for value in [0.0, 1.0, -0.1, 4_470.897_102_766_255, 1.237e-9, -2.2e-30, 6.02e23] {
            assert_eq!(scientific(value).parse(), Ok(value));
            assert_eq!(fixed(value).parse(), Ok(value));
            assert_eq!(shortest(value).parse(), Ok(value));
        }
        assert_eq!(scientific(-0.000_25), "-2.5000000000000001e-04");
    }

    #[test]
    fn what_is_no_number_is_refused() {
        for text in ["", "nan", "inf", "1e999", "1,5", "0x10"] {
            assert!(finite(text).is_err(), "{text}");
        }
        for text in ["0", "-3", "1.5", "1e9"] {
            assert!(pixels(text).is_err(), "{text}");
        }
        assert_eq!(pixels("5472.00000"), Ok(5472));
        assert!(numbers::<2>("1 2 3").unwrap_err().problem.contains("expected 2 numbers, found 3"));
    }
}
