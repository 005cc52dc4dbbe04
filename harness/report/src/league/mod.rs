//! The league of calibration systems: which one, for which case, from the tables of `calibench league`.

mod calls;
mod cells;
mod held_out;
mod page;
mod picture;
#[cfg(test)]
mod tests;
mod versions;

use calibench_records::league::{read_all, read_classes};

use crate::composed::Composed;
use crate::{Places, ReportError};

/// The family of this report.
pub const FAMILY: &str = "league";
/// Every class with every calibrator.
const CLASSES: &str = "classes.md";

/// The report from the tables; `None` where there are none.
///
/// # Errors
/// Tables that cannot be read.
pub(crate) fn compose(places: &Places) -> Result<Option<Composed>, ReportError> {
    let (photographs, classes) = read_classes(&places.league)?.into_iter().partition(|class| class.photographs);
    let tables = read_all(&places.league)?;
    let league = cells::League::new(classes, &tables);
    if league.classes.is_empty() || league.calibrators.is_empty() {
        return Ok(None);
    }
    let figure = picture::figure(&league);
    let held_out = held_out::section(&cells::League::new(photographs, &tables));
    let mut composed = Composed::page(page::first(&league, &held_out, &figure), vec![(figure.file(), figure.picture())]);
    composed.pages.push((CLASSES.to_owned(), page::classes(&league)));
    Ok(Some(composed))
}
