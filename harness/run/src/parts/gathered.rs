//! The parts below some folders, by scenario: all of one run, each once.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use calibench_files::at;
use calibench_files::folder::intact;
use calibench_records::names::{ORIGIN, PART, cell_name};
use calibench_records::parts::Manifest;
use calibench_records::stored::Table;

use super::MergeError;

/// A part that is there.
pub(super) struct Found {
    /// Its folder.
    pub folder: PathBuf,
    /// What it is.
    pub manifest: Manifest,
    /// Its files, whole, by their names with `/` between folders.
    pub files: Vec<String>,
}

impl Found {
    /// Its files of cell `cell` of a sweep but for the tables.
    pub fn of_cell(&self, cell: usize) -> impl Iterator<Item = &str> {
        let below = cell_name(cell) + "/";
        self.files.iter().filter(move |name| name.starts_with(&below) && !is_table(name)).map(String::as_str)
    }

    /// Its files that are of no cell and no table: the scenario, and the images of the first trial where that is in the part.
    pub fn common(&self) -> impl Iterator<Item = &str> {
        let cells: BTreeSet<String> = self.manifest.pieces.iter().map(|piece| cell_name(piece.cell)).collect();
        let of_cell = move |name: &str| name.split_once('/').is_some_and(|(folder, _)| cells.contains(folder));
        self.files.iter().map(String::as_str).filter(move |name| *name != PART && !is_table(name) && !of_cell(name))
    }

    /// The part's file of `table` in cell `cell`.
    pub fn table(&self, table: Table, cell: usize) -> PathBuf {
        self.folder.join(self.name_of(table, cell))
    }

    /// Whether the part has it.
    pub fn has(&self, table: Table, cell: usize) -> bool {
        self.files.contains(&self.name_of(table, cell))
    }

    fn name_of(&self, table: Table, cell: usize) -> String {
        let file = table.file();
        if self.manifest.swept { format!("{}/{file}", cell_name(cell)) } else { file.to_owned() }
    }
}

fn is_table(name: &str) -> bool {
    let file = name.rsplit('/').next().unwrap_or(name);
    [Table::Points, Table::Adjustments].iter().any(|table| table.file() == file)
}

/// The parts below `folders`, by scenario and in their order.
///
/// # Errors
/// What is said of parts in [`MergeError`]: nothing was written then.
pub(super) fn gather(folders: &[PathBuf]) -> Result<Vec<Vec<Found>>, MergeError> {
    let mut places = BTreeMap::new();
    for folder in folders {
        let below = places_below(folder)?;
        if below.is_empty() {
            return Err(MergeError::NoPart(folder.clone()));
        }
        for place in below {
            // One that is named twice is one.
            places.entry(place.canonicalize().map_err(|error| at(&place, &error))?).or_insert(place);
        }
    }
    let mut runs: BTreeMap<String, Vec<(PathBuf, Manifest)>> = BTreeMap::new();
    for folder in places.into_values() {
        let Some(manifest) = Manifest::read(&folder)? else { continue };
        runs.entry(manifest.scenario.clone()).or_default().push((folder, manifest));
    }
    runs.into_values().map(one_run).collect()
}

/// The folders of parts at or below `folder`.
fn places_below(folder: &Path) -> io::Result<Vec<PathBuf>> {
    if folder.join(PART).is_file() {
        return Ok(vec![folder.to_owned()]);
    }
    let mut found = Vec::new();
    let named = |error: io::Error| at(folder, &error);
    for entry in fs::read_dir(folder).map_err(named)? {
        let entry = entry.map_err(named)?;
        // What is being written has a name with a dot. Links are not followed.
        if entry.file_type().map_err(named)?.is_dir() && !entry.file_name().to_string_lossy().starts_with('.') {
            found.extend(places_below(&entry.path())?);
        }
    }
    Ok(found)
}

/// Checks that the parts are all parts of one run, and whole.
fn one_run(mut parts: Vec<(PathBuf, Manifest)>) -> Result<Vec<Found>, MergeError> {
    parts.sort_by_key(|(_, manifest)| manifest.part);
    for ((first, manifest), (second, other)) in parts.iter().zip(parts.iter().skip(1)) {
        let (scenario, first, second) = (manifest.scenario.clone(), first.clone(), second.clone());
        if let Some(difference) = other.difference(manifest) {
            return Err(MergeError::Different { scenario, first, second, difference });
        }
        if other.part == manifest.part {
            return Err(MergeError::Doubled { scenario, part: named(manifest.part, manifest.of), first, second });
        }
    }
    missing(&parts)?;
    let whole = |(folder, manifest): (PathBuf, Manifest)| {
        let files = intact(&folder).map_err(MergeError::Broken)?;
        Ok(Found { folder, manifest, files })
    };
    let found = parts.into_iter().map(whole).collect::<Result<Vec<Found>, MergeError>>()?;
    same_scenario(&found)?;
    Ok(found)
}

fn named(part: u64, of: u64) -> String {
    format!("{part}/{of}")
}

/// So many parts stand in a message.
const NAMED: usize = 8;

fn missing(parts: &[(PathBuf, Manifest)]) -> Result<(), MergeError> {
    let Some((_, Manifest { scenario, of, .. })) = parts.first() else { return Ok(()) };
    let there: BTreeSet<u64> = parts.iter().map(|(_, manifest)| manifest.part).collect();
    let absent: Vec<u64> = (1..=*of).filter(|part| !there.contains(part)).collect();
    let names = absent.iter().take(NAMED).map(|part| named(*part, *of)).collect::<Vec<_>>().join(", ");
    let missing = match absent.len() {
        0 => return Ok(()),
        1 => format!("part {names} is"),
        count if count <= NAMED => format!("parts {names} are"),
        count => format!("parts {names} and {} more are", count - NAMED),
    };
    Err(MergeError::Missing { scenario: scenario.clone(), missing, of: *of })
}

/// Every part keeps the scenario and its camera: all must have kept the same. Where the scenario's file lay may differ from machine to machine.
fn same_scenario(parts: &[Found]) -> Result<(), MergeError> {
    let Some((first, others)) = parts.split_first() else { return Ok(()) };
    for other in others {
        for name in other.common().filter(|name| *name != ORIGIN) {
            let [mine, theirs] = [&first.folder, &other.folder].map(|folder| fs::read(folder.join(name)));
            if mine.is_err() || mine? != theirs? {
                return Err(MergeError::Common { file: other.folder.join(name), first: first.folder.clone() });
            }
        }
    }
    Ok(())
}
