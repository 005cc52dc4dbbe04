//! Checks of parameters.

use std::ops::RangeInclusive;

use super::{FieldError, Levels, Shape, SheetBend};

/// What counts as a length, object units.
const LENGTHS: RangeInclusive<f64> = 1e-6..=1e6;

/// Refuses a `value` outside `range`, and what is not a number.
///
/// # Errors
/// [`FieldError::Parameter`] with the parameter, its value and what was expected.
pub fn within(parameter: &'static str, value: f64, range: RangeInclusive<f64>) -> Result<(), FieldError> {
    if range.contains(&value) {
        return Ok(());
    }
    let expected = format!("a number from {} to {}", range.start(), range.end());
    Err(FieldError::Parameter { parameter, value, expected })
}

/// Refuses a `count` outside `range`.
///
/// # Errors
/// [`FieldError::Parameter`] with the parameter, its value and what was expected.
pub fn counted(parameter: &'static str, count: usize, range: RangeInclusive<usize>) -> Result<(), FieldError> {
    if range.contains(&count) {
        return Ok(());
    }
    let expected = format!("a whole number from {} to {}", range.start(), range.end());
    Err(FieldError::Parameter { parameter, value: count as f64, expected })
}

/// A length above zero.
///
/// # Errors
/// [`FieldError::Parameter`] with the parameter, its value and what was expected.
pub fn length(parameter: &'static str, value: f64) -> Result<(), FieldError> {
    within(parameter, value, LENGTHS)
}

/// A length or zero.
///
/// # Errors
/// [`FieldError::Parameter`] with the parameter, its value and what was expected.
pub fn distance(parameter: &'static str, value: f64) -> Result<(), FieldError> {
    within(parameter, value, 0.0..=*LENGTHS.end())
}

/// Reflectances, which must differ.
///
/// # Errors
/// [`FieldError::Parameter`] with the parameter, its value and what was expected.
pub fn levels(levels: Levels) -> Result<(), FieldError> {
    within("paper", levels.paper, 0.0..=1.0)?;
    within("ink", levels.ink, 0.0..=1.0)?;
    if (levels.paper - levels.ink).abs() < 1e-3 {
        return Err(FieldError::Parameter { parameter: "ink", value: levels.ink, expected: "another level than `paper`".into() });
    }
    Ok(())
}

/// A bend whose height is at most a quarter of the sheet's shorter side: it is a paper's or a board's, not a roll's.
///
/// # Errors
/// [`FieldError::Parameter`] with the parameter, its value and what was expected.
pub fn bend(bend: Option<SheetBend>, [width, height]: [f64; 2]) -> Result<(), FieldError> {
    let Some(bend) = bend else { return Ok(()) };
    let most = 0.25 * width.min(height);
    within("bend", bend.peak, -most..=most)?;
    within("bend_across", bend.across, -7.0..=7.0)
}

/// The free numbers of a shape: a corner from 30 to 150 degrees, bars from a twentieth to half of their length.
///
/// # Errors
/// [`FieldError::Parameter`] with the parameter, its value and what was expected.
pub fn shape(shape: Shape) -> Result<(), FieldError> {
    const ROUNDING: f64 = 1e-9;
    match shape {
        Shape::Corner { angle } if !(30.0 - ROUNDING..=150.0 + ROUNDING).contains(&angle.to_degrees()) => {
            Err(FieldError::Parameter { parameter: "angle", value: angle.to_degrees(), expected: "30 to 150 degrees".into() })
        }
        Shape::Cross { bar } => within("bar", bar, 0.05..=0.5),
        _ => Ok(()),
    }
}
