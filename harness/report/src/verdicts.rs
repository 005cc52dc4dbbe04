//! The verdicts of all published cells, for a gate to keep.

use std::path::Path;

use crate::published::{self, Cell, Table, Verdict};
use crate::{LoadError, ReportError, load, sweep};

/// A verdict: table (`paper/table-1`), row and column, and the word for it with its kind, as in `reproduces (reconstruction)`.
pub type CellVerdict = ([String; 3], String);

/// What is said of a cell whose method has no records.
const NO_RECORDS: &str = "not comparable";

/// The scenarios on whose records the published tables below `published` stand, each once.
///
/// # Errors
/// A table that cannot be read.
pub fn scenarios(published: &Path) -> Result<Vec<String>, ReportError> {
    let mut names: Vec<String> = Vec::new();
    for paper in published::papers(published) {
        names.extend(published::tables(published, &paper)?.into_iter().map(|(_, table)| table.scenario));
    }
    names.sort();
    names.dedup();
    Ok(names)
}

/// The verdicts of all cells of the tables below `published`, from the records below `records`. Tables whose scenario has no records are left out.
///
/// # Errors
/// Records or tables that cannot be read.
pub fn verdicts(records: &Path, published: &Path) -> Result<Vec<CellVerdict>, ReportError> {
    let mut all = Vec::new();
    for paper in published::papers(published) {
        for (name, table) in published::tables(published, &paper)? {
            let words = match of_table(records, &table) {
                Err(LoadError::None(_)) => continue,
                other => other?,
            };
            let cells = table.cells.iter().zip(words);
            all.extend(cells.map(|(cell, word)| ([format!("{paper}/{name}"), cell.row.clone(), cell.column.clone()], word)));
        }
    }
    Ok(all)
}

/// The word for each cell of a table, in their order.
fn of_table(records: &Path, table: &Table) -> Result<Vec<String>, LoadError> {
    let verdicts = match sweep::load(records, &table.scenario)? {
        Some(loaded) => published::swept_verdicts(table, &loaded)?,
        None => published::verdicts(table, &load(records, &table.scenario)?)?,
    };
    let words = verdicts.map(|verdicts| table.cells.iter().zip(&verdicts).map(|(cell, verdict)| word(cell, verdict)).collect());
    Ok(words.unwrap_or_else(|| vec![NO_RECORDS.to_owned(); table.cells.len()]))
}

/// What is not comparable is of no kind.
fn word(cell: &Cell, verdict: &Verdict) -> String {
    match (verdict, cell.kind) {
        (Verdict::NotComparable(_), _) | (_, None) => verdict.word().to_owned(),
        (_, Some(kind)) => format!("{} ({})", verdict.word(), kind.word()),
    }
}
