//! Points of photographs in new pictures, or back.

use std::path::Path;

use calibench_exchange::{MeasuredRow, Outcome, write_measured};
use calibench_files::OutputFile;
use calibench_model::{Measurement, PointRef};

use super::views::Views;
use crate::failure::Failure;
use crate::inputs::read_measured;

/// What rows say of how their positions came about.
const METHOD: &str = "undistort";

/// Writes the points of `table` where they lie in new pictures; those that have no place there have none and say why.
pub(super) fn moved(table: &Path, views: &Views, output: &OutputFile, quiet: bool) -> Result<(), Failure> {
    let points = read_measured(table)?;
    let strangers = points.rows().filter(|given| !views.given.holds(given.start.position)).count();
    if strangers > 0 {
        say!(
            "warning: {strangers} of the points that are given lie outside of their pictures: is the camera's size that of the photographs (--size says theirs)?"
        );
    }
    let rows: Vec<MeasuredRow<'_>> = points
        .rows()
        .map(|given| match views.given.point_in(&views.made, &given.start) {
            Some(start) => {
                let outcome = Outcome::Measured(Measurement { position: start.position, covariance: start.covariance });
                MeasuredRow { given: PointRef { start, ..given }, method: METHOD, outcome }
            }
            None => MeasuredRow { given, method: METHOD, outcome: Outcome::Unavailable("has no place in the new picture".into()) },
        })
        .collect();
    output.write(|file| write_measured(file, rows.iter().cloned()))?;
    let lost = rows.iter().filter(|row| matches!(row.outcome, Outcome::Unavailable(_))).count();
    let outside = rows.iter().filter(|row| matches!(row.outcome, Outcome::Measured(found) if !views.made.holds(found.position))).count();
    if !quiet {
        say!("undistort: {} points, of which {outside} lie outside of the new frame", rows.len() - lost);
    }
    if lost > 0 {
        say!("warning: {lost} of {} points have no place in the new picture: their rows say so", rows.len());
    }
    Ok(())
}
