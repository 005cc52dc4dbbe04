//! The digits of numbers in records.

use calibench_model::PixelPoint;

/// To how many parts of a pixel coordinates are written: far more than an operator finds, in files a third smaller than with every digit.
const PARTS: f64 = 1e9;

/// The nearest number of nine decimals, in parts; one out of all bounds has none.
fn parts(px: f64) -> Option<f64> {
    Some((px * PARTS).round()).filter(|parts| parts.is_finite())
}

/// A number of parts in decimals.
fn decimal(parts: f64) -> String {
    // Dividing by a power of ten gives the number nearest to the decimals; adding zero turns -0 into 0.
    (parts / PARTS + 0.0).to_string()
}

/// A coordinate, px, to nine decimals.
pub(crate) fn coordinate(px: f64) -> String {
    parts(px).map_or_else(|| px.to_string(), decimal)
}

/// The cells `x`, `y`, `x_true`, `y_true` of a point, all px: where it was measured, and where it truly is if its error, measured less true, is known. The
/// true position and the error have nine decimals, and the measured one is their sum, so that their [`difference`] is the error to the last of them.
pub(crate) fn coordinates(position: PixelPoint, error: Option<(f64, f64)>) -> [String; 4] {
    let Some((dx, dy)) = error else {
        return [coordinate(position.x), coordinate(position.y), String::new(), String::new()];
    };
    let pair = |measured: f64, error: f64| match (parts(measured - error), parts(error)) {
        (Some(truth), Some(error)) => (decimal(truth + error), decimal(truth)),
        _ => (measured.to_string(), (measured - error).to_string()),
    };
    let ((x, x_true), (y, y_true)) = (pair(position.x, dx), pair(position.y, dy));
    [x, y, x_true, y_true]
}

/// Measured less true, px, of coordinates of nine decimals: as many decimals, without the digits that a difference of binary numbers adds.
pub(crate) fn difference(measured: f64, truth: f64) -> f64 {
    let error = measured - truth;
    parts(error).map_or(error, |parts| parts / PARTS + 0.0)
}

/// A standard deviation, px, to six significant digits, and from 1 px on to seven decimals: others compare it to a millionth.
pub(crate) fn deviation(px: f64) -> String {
    let text = if px.abs() >= 1.0 { format!("{px:.7}") } else { format!("{px:.5e}") };
    text.parse().map_or_else(|_| px.to_string(), |rounded: f64| rounded.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_those_that_are_worth_something() {
        for (px, expected) in
            [(0.1 + 0.2, "0.3"), (-1e-17, "0"), (1.0 / 3.0, "0.333333333"), (-2_500.123_456_789_6, "-2500.12345679"), (1e-9, "0.000000001")]
        {
            assert_eq!(coordinate(px), expected);
        }
        // What is out of all bounds stays a number.
        assert_eq!(coordinate(1e300).parse::<f64>().unwrap(), 1e300);
        for (px, expected) in
            [(1.0 / 7.0, "0.142857"), (0.000_012_345_678, "0.0000123457"), (12.5, "12.5"), (0.0, "0"), (12.345_678_912, "12.3456789")]
        {
            assert_eq!(deviation(px), expected);
        }
    }

    #[test]
    fn an_error_is_the_difference_of_what_is_written() {
        // Positions over a frame of 100 megapixels, errors from a lost point to the last decimal.
        for place in 0..2000 {
            let truth = PixelPoint::new(f64::from(place) * 5.987_654_321, -f64::from(place) / 3.0);
            for error in [(3.5, -2.0 / 3.0), (0.012_345_678_95, -1e-9), (-0.000_000_000_49, 0.000_000_000_51)] {
                let position = PixelPoint::new(truth.x + error.0, truth.y + error.1);
                let [x, y, x_true, y_true] = coordinates(position, Some(error)).map(|cell| cell.parse::<f64>().unwrap());
                let rounded = |px: f64| coordinate(px).parse::<f64>().unwrap();
                assert_eq!((difference(x, x_true), difference(y, y_true)), (rounded(error.0), rounded(error.1)), "at {truth:?}");
                assert!((x - position.x).abs() <= 1.001e-9 && (x_true - truth.x).abs() <= 0.501e-9, "at {truth:?}");
            }
        }
        let far = PixelPoint::new(1e300, 2.0);
        let [x, y, ..] = coordinates(far, Some((1e300, 1.0)));
        assert_eq!((x.parse::<f64>().unwrap(), &*y), (1e300, "2"));
        assert_eq!(difference(1e300, 5.0), 1e300);
    }
}
