//! What has to hold of published tables.

use std::ops::Range;
use std::path::Path;

use calibench_diagnostics::{Problem, Problems};

use super::asked::not_asked;
use super::{Cell, Kind, Metric, Place, Printed, PublishedError, Table, adjustment};

/// The first mistake of `table`, which was read from `text`.
///
/// # Errors
/// A mistake, with its place.
pub fn check(table: &Table, text: &str) -> Result<(), Problem> {
    for (index, cell) in table.cells.iter().enumerate() {
        let at = |key: &str, message: String| Problem::new(place(text, index, key), message);
        if table.cells[..index].iter().any(|other| (&other.row, &other.column) == (&cell.row, &cell.column)) {
            return Err(at("row", format!("row `{}`, column `{}` is given twice", cell.row, cell.column)));
        }
        if !table.columns.contains(&cell.column) {
            let message =
                format!("row `{}` has a cell in column `{}`, which is none of {}", cell.row, cell.column, table.columns.join(", "));
            return Err(at("column", message).nearest(&cell.column, table.columns.iter().map(String::as_str)));
        }
        if Printed::parse(&cell.printed).is_none() && cell.not_comparable.is_none() && cell.at_most.is_none() {
            let message = format!("`{}` is no number: expected digits as in 22.520 or 1/18.9, `at_most` or `not_comparable`", cell.printed);
            return Err(at("printed", message));
        }
        if let Some(message) = adjustment::unknown(cell) {
            return Err(at("of", format!("row `{}`: {message}", cell.row)));
        }
        if cell.metric.is_of_one_target() != cell.target.is_some() {
            return Err(at("metric", format!("row `{}`: figures of one target have a `target`, statistics have none", cell.row)));
        }
        if let Some(message) = of_kind(cell) {
            return Err(at("kind", format!("row `{}`, column `{}`: {message}", cell.row, cell.column)));
        }
    }
    for finding in &table.findings {
        let Some(at) = not_asked(finding) else { continue };
        let start = text.find(&finding[at..]).unwrap_or(0);
        return Err(Problem::new(
            start..start + 1,
            "`{` in a finding: expected a figure that is asked for, as in `{ours table-1 | row | column}`",
        ));
    }
    let touches = |figure: &str| table.cells.iter().any(|cell| cell.of.as_deref().is_some_and(|of| of.starts_with(figure)));
    let figures = table.causes.iter().flat_map(|fitted| &fitted.figures);
    match figures.into_iter().find(|figure| !touches(figure)) {
        Some(figure) => {
            let start = text.find(figure.as_str()).unwrap_or(0);
            Err(Problem::new(start..start + figure.len(), format!("no cell has a figure `of` that begins with `{figure}`")))
        }
        None => Ok(()),
    }
}

/// What is wrong with the kind of `cell`.
fn of_kind(cell: &Cell) -> Option<&'static str> {
    match cell.kind {
        None if cell.metric != Metric::Unscored => {
            Some("`kind` is missing: expected `definition`, `reconstruction`, `consequence`, `prediction` or `input`")
        }
        Some(_) if cell.metric == Metric::Unscored => Some("there is no figure of ours (`unscored`), so it has no `kind`"),
        Some(Kind::Input) if cell.not_comparable.is_none() => Some("what is put in does not come out: `not_comparable` says what it is"),
        _ => None,
    }
}

/// Where `key` of the cell `index` stands in `text`: its line, or that of the cell.
fn place(text: &str, index: usize, key: &str) -> Range<usize> {
    let Some((start, _)) = text.match_indices("[[cell]]").nth(index) else { return 0..0 };
    let mut at = start;
    for line in text[start..].split_inclusive('\n') {
        if at > start && line.starts_with('[') {
            break;
        }
        if line.split_once('=').is_some_and(|(name, _)| name.trim() == key) {
            return at..at + line.trim_end().len();
        }
        at += line.len();
    }
    start..start + "[[cell]]".len()
}

/// Whether what names another cell names one that stands for the same printed figure.
///
/// # Errors
/// A cell that does not, in its file in `folder`.
pub fn counted_once(folder: &Path, tables: &[(String, Table)]) -> Result<(), PublishedError> {
    for (name, table) in tables {
        for (index, cell) in table.cells.iter().enumerate() {
            let Some(message) = cell.same_as.as_ref().and_then(|other| of_other(tables, cell, other)) else { continue };
            let path = folder.join(name).with_extension("toml");
            let text = calibench_files::bounded::text(&path).map_err(|source| PublishedError::File { path: path.clone(), source })?;
            let problems = vec![Problem::new(place(&text, index, "same_as"), message)];
            return Err(Problems { file: path.display().to_string(), text, problems }.into());
        }
    }
    Ok(())
}

/// Why `cell` is not the same printed figure as that at `place`. A ratio counts as the figure above its line, whatever that prints.
fn of_other(tables: &[(String, Table)], cell: &Cell, place: &Place) -> Option<String> {
    let table = tables.iter().find(|(name, _)| *name == place.table).map(|(_, table)| table);
    let other = table.and_then(|table| table.cells.iter().find(|cell| cell.row == place.row && cell.column == place.column));
    let called = format!("row `{}`, column `{}` of `{}`", place.row, place.column, place.table);
    match other {
        None => Some(format!("there is no {called}")),
        Some(other) if other.same_as.is_some() => Some(format!("{called} is itself the same as another: name that")),
        Some(other) if other.printed != cell.printed && cell.metric != Metric::FigureRatio => {
            Some(format!("{called} prints `{}`, not `{}`", other.printed, cell.printed))
        }
        Some(_) => None,
    }
}
