//! How large the error of a length may be.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

/// The maximum permissible error of a length L: `A + K L`, at most B.
///
/// Source: VDI/VDE 2634 part 1, by Luhmann et al., Close-Range Photogrammetry and 3D Imaging, on acceptance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// A, in the unit of the lengths.
    pub constant: f64,
    /// K, a number: 1e-5 is 10 um for each metre.
    pub rate: f64,
    /// B, in the unit of the lengths; infinite where there is none.
    pub most: f64,
}

/// What is no limit.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("found `{found}`; expected {expected}")]
pub struct LimitError {
    found: String,
    expected: &'static str,
}

impl Limit {
    /// Of a length; both in one unit.
    pub fn at(&self, length: f64) -> f64 {
        self.rate.mul_add(length, self.constant).min(self.most)
    }
}

impl FromStr for Limit {
    type Err = LimitError;

    /// From `A`, `A,K` or `A,K,B`.
    fn from_str(text: &str) -> Result<Self, LimitError> {
        let wrong = |expected| LimitError { found: text.to_owned(), expected };
        let numbers: Vec<f64> = text
            .split(',')
            .map(|number| number.trim().parse().ok().filter(|number: &f64| number.is_finite() && *number >= 0.0))
            .collect::<Option<_>>()
            .ok_or_else(|| {
                wrong("A,K,B of the limit A + K L, at most B: numbers of at least 0, as in 0.02,1e-5,0.1; K and B may be left out")
            })?;
        let (constant, rate, most) = match numbers[..] {
            [constant] => (constant, 0.0, f64::INFINITY),
            [constant, rate] => (constant, rate, f64::INFINITY),
            [constant, rate, most] => (constant, rate, most),
            _ => return Err(wrong("at most three numbers: A,K,B of the limit A + K L, at most B")),
        };
        if constant + rate <= 0.0 || most <= 0.0 {
            return Err(wrong("a limit that leaves room: A + K L and B above 0"));
        }
        Ok(Self { constant, rate, most })
    }
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.constant)?;
        if self.rate > 0.0 {
            write!(f, " + {} L", self.rate)?;
        }
        if self.most.is_finite() { write!(f, ", at most {}", self.most) } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 0.02 mm and 10 um for each metre, at most 0.03 mm.
    #[test]
    fn a_limit_grows_with_the_length_up_to_its_end() {
        let limit: Limit = "0.02, 1e-5,0.03".parse().unwrap();
        for (length, at) in [(0.0, 0.02), (500.0, 0.025), (1000.0, 0.03), (2000.0, 0.03)] {
            assert!((limit.at(length) - at).abs() < 1e-15, "{length}");
        }
        assert_eq!(limit.to_string(), "0.02 + 0.00001 L, at most 0.03");
        let plain: Limit = "0.5".parse().unwrap();
        assert_eq!((plain.at(1e6), plain.to_string().as_str()), (0.5, "0.5"));
        assert_eq!("0,2e-5".parse::<Limit>().unwrap().at(100.0), 0.002);
    }

    #[test]
    fn what_is_no_limit_says_what_was_expected() {
        for (text, expected) in [
            ("a", "found `a`; expected A,K,B of the limit"),
            ("-1", "found `-1`; expected A,K,B of the limit"),
            ("1,inf", "found `1,inf`; expected A,K,B"),
            ("1,2,3,4", "found `1,2,3,4`; expected at most three numbers"),
            ("0", "found `0`; expected a limit that leaves room"),
            ("1,0,0", "found `1,0,0`; expected a limit that leaves room"),
        ] {
            let error = text.parse::<Limit>().unwrap_err().to_string();
            assert!(error.starts_with(expected), "{error}");
        }
    }
}
