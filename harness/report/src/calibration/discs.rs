//! What is said of the eccentricity of discs.

use calibench_calibrate::{Calibration, Discs, Eccentricity};

use crate::plain;

/// Eccentricities from which on a user must know, px: a fifth of what good operators reach.
const NOTABLE: f64 = 0.005;

/// What was taken out.
pub(super) fn fact(calibration: &Calibration<'_>) -> Option<String> {
    let found = calibration.prepared.eccentricity.as_ref()?;
    let of = match calibration.prepared.settings.discs {
        Some(Discs::Radius(radius)) => format!(" of radius {radius}"),
        _ => String::new(),
    };
    Some(format!("eccentricity of {} discs{of} taken from {} image points: {}", found.discs, found.image_points, size(found)))
}

fn size(found: &Eccentricity) -> String {
    format!("{} px RMS, {} px at most", plain(found.rms()), plain(found.largest()))
}

/// What was not.
pub(super) fn warnings(calibration: &Calibration<'_>) -> Vec<String> {
    let Some(taken) = &calibration.prepared.eccentricity else {
        let untaken = |found: &Eccentricity| {
            format!(
                "the control file has {} discs, and the centres of their pictures are not the pictures of their centres: {}; --eccentricity control takes \
                 that out",
                found.discs,
                size(found)
            )
        };
        return calibration.untaken().filter(|found| found.largest() > NOTABLE).iter().map(untaken).collect();
    };
    let why = [
        (taken.unpictured, "of discs that do not lie before the camera as a whole: is their radius right?"),
        (taken.unstated, "that were measured as discs: the control file states no radius of theirs"),
    ];
    let left = why.into_iter().filter(|(count, _)| *count > 0);
    left.map(|(count, why)| format!("eccentricity: nothing was taken from {count} image points {why}")).collect()
}
