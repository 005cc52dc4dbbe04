//! The whole of a calibration, from prepared observations to a result that says what is doubtful.

use crate::{Calibration, CalibrationError, GrossErrors, Prepared};

/// Adjusts, with weak priors on coefficients that nothing determines; leaves out image points in gross error where these are sought and are wrong for themselves; takes
/// the eccentricity of discs out where that was asked for; leaves images out, looks for what the model leaves out, and compares sets of parameters, each by names. `read` gets the result.
///
/// # Errors
/// An adjustment that does not converge or whose unknowns are not determined, by name; discs without a plane; sets with unknown parameters.
pub fn calibrate<T>(prepared: &Prepared, sets: &[Vec<String>], read: impl FnOnce(&Calibration<'_>) -> T) -> Result<T, CalibrationError> {
    let sought = prepared.settings.gross == GrossErrors::Sought;
    adjusted(prepared, |all| {
        let is_normal = all.as_ref().is_ok_and(|all| !all.has_gross_errors());
        let without = if is_normal || !sought { None } else { prepared.without_gross_errors() };
        let Some(without) = without else { return finished(all?, sets, read) };
        adjusted(&without, |rest| match (rest, all) {
            (Ok(rest), Err(_)) if rest.leaves_out_single_points() => finished(rest, sets, read),
            (Ok(rest), Ok(all)) if rest.leaves_out_any() => {
                // What is off at the border of a lens that the model does not picture has few neighbours; what remains without it tells.
                let is_off_together = !rest.leaves_out_single_points() || rest.is_doubted() || all.is_structured();
                finished(if is_off_together { Calibration { is_off_together, ..all } } else { rest }, sets, read)
            }
            (_, all) => finished(all?, sets, read),
        })
    })
}

/// What an adjustment gives, with weak priors where it needs them.
fn adjusted<T>(prepared: &Prepared, read: impl FnOnce(Result<Calibration<'_>, CalibrationError>) -> T) -> T {
    if let Some(near) = prepared.without_far_points() {
        return undisputed(near.adjust(), read);
    }
    match prepared.adjust() {
        Err(error) if error.is_undetermined() => match prepared.held_weakly() {
            Some(held) => read(held.adjust()),
            None => read(Err(error)),
        },
        found => undisputed(found, read),
    }
}

/// What was found, or what is found without the points whose last two rays do not meet.
fn undisputed<T>(found: Result<Calibration<'_>, CalibrationError>, read: impl FnOnce(Result<Calibration<'_>, CalibrationError>) -> T) -> T {
    let without = found.as_ref().ok().and_then(Calibration::without_disputed_points);
    match without.as_ref().map(Prepared::adjust) {
        Some(Ok(without)) => read(Ok(without)),
        _ => read(found),
    }
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
    if calibration.prepared.settings.board.is_measured {
        calibration.measure_board();
    }
    if !sets.is_empty() {
        calibration.compare(sets)?;
    }
    Ok(calibration)
}
