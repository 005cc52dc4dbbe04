//! Putting parts together.

use std::fs::{self, File};
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use calibench_files::{NewFolder, at};
use calibench_model::told::{Told, notes};
use calibench_records::compressor::Compressor;
use calibench_records::description::{read as read_description, write as write_description};
use calibench_records::names::{DESCRIPTION, ORIGIN, cell_name};
use calibench_records::parts::{Joiner, Span, ToldBy};
use calibench_records::stored::Table;

use super::MergeError;
use super::gathered::{Found, gather};
use crate::description::told_notes;
use crate::store::RecordsFolder;

/// A run that was put together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merged {
    /// Its scenario.
    pub scenario: String,
    /// Of how many parts.
    pub parts: u64,
    /// How many trials it has, of all cells.
    pub trials: u64,
    /// Cells of its sweep; one without a sweep.
    pub cells: usize,
    /// How many points were measured, or calibrations applied, or sets of printed figures recomputed.
    pub measured: u64,
    /// What its methods told, in words: of which method, and what.
    pub notes: Vec<(String, String)>,
}

/// Puts the parts in and below `folders` together: of every scenario all parts of one run, to what one run would have written, byte for byte, in the folder of
/// the scenario below `records`. What is there is replaced as a run replaces it. All parts are checked before anything is written, and one row of a table is held
/// at a time.
///
/// # Errors
/// [`MergeError`]; the records of the scenario that it names are then as they were.
pub fn merge(folders: &[PathBuf], records: &Path) -> Result<Vec<Merged>, MergeError> {
    let runs = gather(folders)?;
    let places = runs.iter().map(|parts| place(parts, records)).collect::<io::Result<Vec<_>>>()?;
    runs.iter().zip(&places).map(|(parts, place)| one(parts, place)).collect()
}

/// Where the run of `parts` will be.
fn place(parts: &[Found], records: &Path) -> io::Result<RecordsFolder> {
    let first = &parts[0];
    let origin = match fs::read_to_string(first.folder.join(ORIGIN)) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        other => Some(other?.trim_end().to_owned()),
    };
    RecordsFolder::whole(records, &first.manifest.scenario, origin)
}

fn one(parts: &[Found], place: &RecordsFolder) -> Result<Merged, MergeError> {
    let manifest = &parts[0].manifest;
    let told = told(parts);
    place.replace(|folder| {
        copy(&parts[0], parts[0].common().filter(|name| *name != DESCRIPTION), folder)?;
        describe(parts, &told, folder)?;
        (0..manifest.cells.len()).try_for_each(|cell| cell_of(parts, cell, folder))
    })?;
    Ok(Merged {
        scenario: manifest.scenario.clone(),
        parts: manifest.of,
        trials: manifest.all_trials(),
        cells: manifest.cells.len(),
        measured: parts.iter().map(|part| part.manifest.measured).sum(),
        notes: notes(by_method(&told)).into_iter().map(|(method, note)| (method.to_owned(), note)).collect(),
    })
}

/// What methods told in any of the parts.
fn told(parts: &[Found]) -> Vec<ToldBy> {
    let mut all: Vec<ToldBy> = Vec::new();
    for (place, one) in parts.iter().flat_map(|part| part.manifest.told.iter().enumerate()) {
        // All parts list the same methods in the same order.
        match all.get_mut(place).filter(|known| known.method == one.method) {
            Some(known) => known.told.join(&one.told),
            None => all.push(one.clone()),
        }
    }
    all
}

fn by_method(told: &[ToldBy]) -> impl Iterator<Item = (&str, Told)> {
    told.iter().map(|one| (one.method.as_str(), one.told.clone()))
}

/// Writes the description that all parts have in common, with what methods told.
fn describe(parts: &[Found], told: &[ToldBy], folder: &NewFolder) -> io::Result<()> {
    let path = parts[0].folder.join(DESCRIPTION);
    let mut description = read_description(BufReader::new(File::open(&path).map_err(|error| at(&path, &error))?))
        .map_err(|error| io::Error::other(format!("{}: {error}", path.display())))?;
    description.notes.extend(told_notes(by_method(told)));
    folder.write(DESCRIPTION, |file| write_description(file, &description))
}

/// Copies files of `part`, under their names.
fn copy<'n>(part: &Found, names: impl Iterator<Item = &'n str>, folder: &NewFolder) -> io::Result<()> {
    for name in names {
        let path = part.folder.join(name);
        let mut input = File::open(&path).map_err(|error| at(&path, &error))?;
        folder.write(name, |output| io::copy(&mut input, output).map(drop))?;
    }
    Ok(())
}

/// Puts together what the parts have of a cell.
fn cell_of(parts: &[Found], cell: usize, folder: &NewFolder) -> Result<(), MergeError> {
    let pieces: Vec<(&Found, Span)> = parts.iter().filter_map(|part| Some((part, trials(part, cell)?))).collect();
    let Some((first, _)) = pieces.first() else { return Ok(()) };
    copy(first, first.of_cell(cell), folder)?;
    let folder = if first.manifest.swept { folder.folder(&cell_name(cell))? } else { folder.clone() };
    [Table::Points, Table::Adjustments].into_iter().try_for_each(|table| join(table, &pieces, cell, &folder))
}

/// The trials of a cell that a part has.
fn trials(part: &Found, cell: usize) -> Option<Span> {
    part.manifest.pieces.iter().find(|piece| piece.cell == cell).map(|piece| piece.trials)
}

/// Joins the tables of a cell, if its trials have one: of points always, and of all parts or of none.
fn join(table: Table, pieces: &[(&Found, Span)], cell: usize, folder: &NewFolder) -> Result<(), MergeError> {
    if table != Table::Points && pieces.iter().all(|(part, _)| !part.has(table, cell)) {
        return Ok(());
    }
    let mut joiner = Joiner::new(Compressor::new(folder.create(table.file())?));
    for (part, trials) in pieces {
        let path = part.table(table, cell);
        joiner.add(&path, *trials).map_err(|source| MergeError::Join { path, source })?;
    }
    let output = joiner.finish().map_err(|source| MergeError::Join { path: folder.path().join(table.file()), source })?;
    Ok(output.finish()?)
}
