//! What fixes the frame of the object, in a word.

use std::str::FromStr;

use calibench_adjust::Datum;
use thiserror::Error;

use super::{CalibrationError, few};

/// What fixes the frame of the object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum DatumChoice {
    /// Control points as their file says: weighted where it gives standard deviations, fixed where not.
    #[default]
    Control,
    /// All control points fixed.
    Fixed,
    /// Control points are start values only: inner constraints.
    Free,
    /// The same, and the constraints look at these targets alone: they stay closest to their start values.
    FreeOver(Vec<String>),
    /// Seven coordinates held; the others are start values only.
    Minimal {
        /// Targets whose X and Y are held.
        horizontal: [String; 2],
        /// Targets whose Z is held.
        vertical: [String; 3],
    },
}

/// Text that is no datum.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error(
    "`{0}` is no datum: expected control, fixed, free, free:A,B,C,... with the targets that stay closest to their start values, or minimal:A,B,C,D,E with two targets whose X and Y are held and three whose Z is"
)]
pub struct NoDatum(String);

impl FromStr for DatumChoice {
    type Err = NoDatum;

    fn from_str(text: &str) -> Result<Self, NoDatum> {
        match text {
            "control" => Ok(Self::Control),
            "fixed" => Ok(Self::Fixed),
            "free" => Ok(Self::Free),
            _ => minimal(text).or_else(|| free_over(text)).ok_or_else(|| NoDatum(text.into())),
        }
    }
}

fn names(text: &str, kind: &str) -> Option<Vec<String>> {
    Some(text.strip_prefix(kind)?.split(',').map(|name| name.trim().to_owned()).collect())
}

/// Three points and more fix a frame.
fn free_over(text: &str) -> Option<DatumChoice> {
    names(text, "free:").filter(|names| names.len() > 2 && names.iter().all(|name| !name.is_empty())).map(DatumChoice::FreeOver)
}

fn minimal(text: &str) -> Option<DatumChoice> {
    let names = names(text, "minimal:")?;
    let [a, b, c, d, e] = <[String; 5]>::try_from(names).ok()?;
    Some(DatumChoice::Minimal { horizontal: [a, b], vertical: [c, d, e] })
}

impl DatumChoice {
    /// Whether control points are start values only.
    pub fn is_minimal(&self) -> bool {
        matches!(self, Self::Free | Self::FreeOver(_) | Self::Minimal { .. })
    }

    /// For the adjustment; `place` finds a control point among the network's points.
    pub(super) fn datum(&self, place: impl Fn(&str) -> Option<usize>) -> Result<Datum, CalibrationError> {
        let of = |name: &String| place(name).ok_or_else(|| CalibrationError::DatumTarget { target: name.clone() });
        match self {
            Self::Control | Self::Fixed => Ok(Datum::Control),
            Self::Free => Ok(Datum::Inner),
            Self::FreeOver(targets) => Ok(Datum::InnerOver(targets.iter().map(of).collect::<Result<_, _>>()?)),
            Self::Minimal { horizontal: [a, b], vertical: [c, d, e] } => {
                Ok(Datum::Minimal { horizontal: [of(a)?, of(b)?], vertical: [of(c)?, of(d)?, of(e)?] })
            }
        }
    }

    /// In words.
    pub fn words(&self) -> String {
        match self {
            Self::Control => "control points as their file says: weighted where it gives standard deviations, fixed where not".into(),
            Self::Fixed => "all control points fixed".into(),
            Self::Free => "inner constraints over all object points (free network)".into(),
            Self::FreeOver(targets) => format!("inner constraints over {} (free network)", few(targets)),
            Self::Minimal { horizontal, vertical } => {
                format!("X and Y of {} and Z of {} held", horizontal.join(", "), vertical.join(", "))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_datum_is_a_word() {
        assert_eq!("free".parse(), Ok(DatumChoice::Free));
        let names = |n: &[&str]| n.iter().map(|n| (*n).to_owned()).collect::<Vec<_>>();
        let expected = DatumChoice::Minimal {
            horizontal: names(&["a", "b/1"]).try_into().unwrap(),
            vertical: names(&["c", "d", "e"]).try_into().unwrap(),
        };
        assert_eq!("minimal:a,b/1,c, d,e".parse(), Ok(expected));
        assert_eq!("free:a, b,c/1".parse(), Ok(DatumChoice::FreeOver(names(&["a", "b", "c/1"]))));
        for wrong in ["free:", "free:a,b", "free:a,,b", "", "minimal", "minimal:a,b,c,d", "minimal:a,b,c,d,e,f", "inner "] {
            assert!(wrong.parse::<DatumChoice>().is_err(), "{wrong}");
        }
    }
}
