//! The whole of a calibration, from prepared observations to a result that says what is doubtful.

use crate::{Calibration, CalibrationError, Prepared};

/// Adjusts, with weak priors on coefficients that nothing determines; takes the eccentricity of discs out where that was asked for; leaves images out, looks for
/// what the model leaves out, and compares sets of parameters, each by names. `read` gets the result.
///
/// # Errors
/// An adjustment that does not converge or whose unknowns are not determined, by name; discs without a plane; sets with unknown parameters.
pub fn calibrate<T>(prepared: &Prepared, sets: &[Vec<String>], read: impl FnOnce(&Calibration<'_>) -> T) -> Result<T, CalibrationError> {
    let undetermined = match prepared.adjust() {
        Ok(calibration) => return finished(calibration, sets, read),
        Err(error) if error.is_undetermined() => error,
        Err(error) => return Err(error),
    };
    let held = prepared.held_weakly().ok_or(undetermined)?;
    finished(held.adjust()?, sets, read)
}

fn finished<T>(
    calibration: Calibration<'_>,
    sets: &[Vec<String>],
    read: impl FnOnce(&Calibration<'_>) -> T,
) -> Result<T, CalibrationError> {
    match calibration.centred()? {
        Some(centred) => examined(centred.adjust()?, sets).map(|calibration| read(&calibration)),
        None => examined(calibration, sets).map(|calibration| read(&calibration)),
    }
}

fn examined<'p>(mut calibration: Calibration<'p>, sets: &[Vec<String>]) -> Result<Calibration<'p>, CalibrationError> {
    calibration.resample();
    calibration.examine();
    if !sets.is_empty() {
        calibration.compare(sets)?;
    }
    Ok(calibration)
}
