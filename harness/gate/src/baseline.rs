//! Baselines of scenarios: one file a scenario, one row a point.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use calibench_model::Rejection;

use super::baseline_file::{self, BaselineError, Head, HeadMethod, Kind, Row};
use super::point_entry::{Coordinates, DECIMALS, Entry, Found, Place, SIGMA_DECIMALS};
use super::table::{MethodTable, Table};

/// The columns before the two coordinates.
const COLUMNS: [&str; 6] = ["method", "trial", "view", "target", "status", "reason"];

fn columns(coordinates: Coordinates) -> Vec<&'static str> {
    COLUMNS.into_iter().chain(coordinates.names()).chain(["sigma"]).collect()
}

/// Where the baseline of a scenario is: `folder/<scenario with '/' as '--'>.csv`.
pub fn baseline_path(folder: &Path, scenario: &str) -> PathBuf {
    folder.join(format!("{}.csv", scenario.replace('/', "--")))
}

/// Where the figures of the adjustments of a scenario are: beside its baseline, as `<scenario>.figures.csv`.
pub fn figures_path(folder: &Path, scenario: &str) -> PathBuf {
    folder.join(format!("{}.figures.csv", scenario.replace('/', "--")))
}

/// Where the image points behind the adjustments of a scenario are: beside its baseline, as `<scenario>.images.csv`.
pub fn images_path(folder: &Path, scenario: &str) -> PathBuf {
    folder.join(format!("{}.images.csv", scenario.replace('/', "--")))
}

/// The heads of the methods that a file keeps: those that were available.
pub(super) fn head_method(label: &Arc<str>, method: &MethodTable, rows: usize) -> HeadMethod {
    HeadMethod {
        label: label.to_string(),
        version: method.version.to_string(),
        settings: method.settings.clone(),
        library: method.library.clone(),
        rows: rows as u64,
    }
}

/// Writes a baseline, whole or not at all, the same bytes for the same table, and returns its checksum. Unavailable methods have no rows.
///
/// # Errors
/// What the file system refuses.
pub fn write_baseline(path: &Path, table: &Table) -> Result<String, BaselineError> {
    let (name, coordinates) = (table.coordinates.name(), table.coordinates);
    let mut head = Head::new(Kind::Points, &table.scenario, &table.text, table.seed, name, vec![String::new()]);
    let kept: Vec<(&Arc<str>, &MethodTable)> = table.methods().filter(|(_, method)| method.unavailable.is_none()).collect();
    head.method = kept.iter().map(|(label, method)| head_method(label, method, method.points.len())).collect();
    let of_method = |(index, (_, method)): (usize, &(&Arc<str>, &'_ MethodTable))| {
        method.points.iter().map(|(place, entry)| row(index + 1, place, entry)).collect::<Vec<_>>()
    };
    baseline_file::write(path, &head, &columns(coordinates), kept.iter().enumerate().flat_map(of_method))
}

fn row(method: usize, place: &Place, entry: &Entry) -> Vec<String> {
    let reason = if let Entry::Rejected(why) = entry { why.name() } else { "" };
    let [a, b] = entry.coordinates().map_or_else(Default::default, |at| at.map(|value| format!("{value:.DECIMALS$}")));
    let sigma = entry.found().and_then(|found| found.sigma).map_or_else(String::new, |sigma| format!("{sigma:.SIGMA_DECIMALS$}"));
    let [view, target, status, reason] = [&*place.view, &*place.target, entry.status(), reason].map(str::to_owned);
    vec![method.to_string(), place.trial.to_string(), view, target, status, reason, a, b, sigma]
}

/// Reads the baseline of `scenario`; `None` when there is no such file.
///
/// # Errors
/// A file that is not to the letter what [`write_baseline`] wrote: cut, edited, of another scenario; with line and column where there is one.
pub fn read_baseline(path: &Path, scenario: &str) -> Result<Option<(Table, String)>, BaselineError> {
    let of = |coordinates: Coordinates| baseline_file::read(path, Kind::Points, &columns(coordinates));
    let read = of(Coordinates::Errors).or_else(|first| of(Coordinates::Positions).map_err(|_| first))?;
    let Some(sheet) = read else { return Ok(None) };
    let damaged = |problem: String| BaselineError::Damaged { path: path.to_owned(), problem };
    let head = &sheet.head;
    if head.scenario != scenario {
        return Err(damaged(format!("is the baseline of `{}`, expected that of `{scenario}`", head.scenario)));
    }
    let coordinates = if head.coordinates == Coordinates::Errors.name() { Coordinates::Errors } else { Coordinates::Positions };
    let seed = head.seed.parse().map_err(|_| damaged(format!("its head says seed {}, expected a whole number", head.seed)))?;
    let mut table = Table::new(scenario, seed, coordinates, &[]);
    table.text.clone_from(&head.text);
    let labels: Vec<(Arc<str>, Arc<str>)> = head.method.iter().map(|m| (m.label.as_str().into(), m.version.as_str().into())).collect();
    for (method, (label, version)) in head.method.iter().zip(&labels) {
        table.method_mut(label, version);
        table.describe(label, method.settings.clone(), method.library.clone());
    }
    for row in sheet.rows() {
        let (label, version) = &labels[row.place(0, labels.len())?];
        let place = Place { trial: row.parse(1)?, view: row.text(2).into(), target: row.text(3).into() };
        let entry = entry(&row)?;
        if table.method_mut(label, version).points.insert(place, entry).is_some() {
            return Err(row.wrong(3, "the point is there twice"));
        }
    }
    sheet.verify()?;
    Ok(Some((table, sheet.checksum)))
}

fn entry(row: &Row<'_>) -> Result<Entry, BaselineError> {
    let found = || Ok(Found { at: [row.parse(6)?, row.parse(7)?], sigma: row.optional(8)? });
    match row.text(4) {
        "measured" => Ok(Entry::Measured(found()?)),
        "lost" => Ok(Entry::Lost(found()?)),
        "rejected" => {
            let known = Rejection::ALL.into_iter().find(|why| why.name() == row.text(5));
            known.map(Entry::Rejected).ok_or_else(|| row.wrong(5, "expected a reason of rejection"))
        }
        _ => Err(row.wrong(4, "expected measured, lost or rejected")),
    }
}
