//! Calibrated here, applied there, in a report: what check points make of each calibration under each condition, and which cause makes how much of it.

mod boards;
mod cases;
mod decomposition;
mod errors;
#[cfg(test)]
mod tests;

use calibench_records::description::Subject;
use calibench_records::figures::Quantity;
use rayon::prelude::*;

use crate::LoadError;
use crate::canvas::Pictures;
use crate::load::Loaded;
use crate::load::adjustments::{Summaries, load_cell_with};
use crate::network::pictures::plan::plan;
use crate::sweep::LoadedSweep;

/// The text of a scenario whose calibrations are applied elsewhere and its pictures, whose names begin with `stem`; `None` for another scenario.
pub fn section(loaded: &Loaded, stem: &str) -> Option<(String, Pictures)> {
    let found = loaded.calibrations.as_ref().filter(|found| is_transfer(found))?;
    let mut text = cases::table(found);
    text.push_str(&decomposition::tables(found));
    let mut pictures: Pictures = Vec::new();
    if let Subject::Views(views) = &loaded.scenario.subject
        && let Some(canvas) = plan(views)
    {
        let file = format!("{stem}-plan.png");
        text.push_str(&format!(
            "Where calibrations are applied: stations, control and check points:\n\n![Stations, control and check points]({file})\n\n"
        ));
        pictures.push((file, canvas));
    }
    for (place, (case, canvas)) in errors::pictures(found).into_iter().enumerate() {
        let file = format!("{stem}-errors-{}.png", place + 1);
        text.push_str(&format!(
            "Errors of the check points in the first trial, case *{case}*:\n\n![Errors of the check points, {case}]({file})\n\n"
        ));
        pictures.push((file, canvas));
    }
    Some((text, pictures))
}

/// The text of a sweep of such a scenario and its pictures; `None` for another one.
///
/// # Errors
/// Records that cannot be read.
pub fn sweep(loaded: &LoadedSweep, stem: &str) -> Result<Option<(String, Pictures)>, LoadError> {
    let read = |index: usize| -> Result<Option<boards::Cell>, LoadError> {
        let mut distances = boards::Distances::default();
        let Some(found) = load_cell_with(&loaded.folder, (&loaded.name, &loaded.sweep, index), |row| distances.add(row))? else {
            return Ok(None);
        };
        let values = loaded.sweep.values(index).iter().map(|value| value.text.clone()).collect();
        Ok(is_transfer(&found).then(|| boards::Cell { values, found, medians: distances.medians() }))
    };
    // The first cell says what the others are.
    let Some(first) = (if loaded.cells.is_empty() { None } else { read(0)? }) else { return Ok(None) };
    let others: Vec<_> = (1..loaded.cells.len()).into_par_iter().map(read).collect();
    let mut cells = vec![first];
    for cell in others {
        let Some(cell) = cell? else { return Ok(None) };
        cells.push(cell);
    }
    let axes: Vec<String> = loaded.sweep.axes.iter().map(|axis| axis.name.clone()).collect();
    let mut text = boards::table(&axes, &cells);
    let file = format!("{stem}.png");
    let picture = boards::picture(&axes, &cells);
    if picture.is_some() {
        text.push_str(&format!("![Error of the camera over the frame]({file})\n\n"));
    }
    Ok(Some((text, picture.map(|picture| (file, picture)).into_iter().collect())))
}

/// Scenarios that are adjusted where they are measured have no error in space.
fn is_transfer(found: &Summaries) -> bool {
    found.figures.keys().any(|(.., name)| name.quantity() == Quantity::RmseXyz)
}
