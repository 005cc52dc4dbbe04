//! A sweep of calibrations that are applied elsewhere, as over boards.

use rayon::prelude::*;

use super::boards;
use super::check_points::has_check_points;
use crate::LoadError;
use crate::canvas::Pictures;
use crate::load::LoadedSweep;
use crate::load::adjustments::load_cell_with;
use crate::studies::shown::OnPage;

/// The text of a sweep and its pictures; `None` where a cell has no figures of check points.
///
/// # Errors
/// Records that cannot be read.
pub fn section(loaded: &LoadedSweep, OnPage { stem, .. }: OnPage<'_>) -> Result<Option<(String, Pictures)>, LoadError> {
    let read = |index: usize| -> Result<Option<boards::Cell>, LoadError> {
        let mut distances = boards::Distances::default();
        let Some(found) = load_cell_with(&loaded.folder, (&loaded.name, &loaded.sweep, index), |row| distances.add(row))? else {
            return Ok(None);
        };
        let values = loaded.sweep.values(index).iter().map(|value| value.text.clone()).collect();
        Ok(has_check_points(&found).then(|| boards::Cell { values, found, medians: distances.medians() }))
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
