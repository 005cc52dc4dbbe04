//! The section of a published table: its cells beside ours, what was found out, every method.

use calibench_records::description::Study;

use super::adjustment::ours;
use super::figure::Ours;
use super::{Table, Tally, Verdict, every_method, many, one};
use crate::load::adjustments::Summaries;
use crate::load::{LoadError, Loaded};

/// A section of a page, and the verdicts of its cells.
pub struct Section {
    /// Markdown.
    pub text: String,
    /// Its verdicts.
    pub tally: Tally,
}

/// The section of `table`, whose scenario's records are `main`; other scenarios stand `beside` it.
///
/// # Errors
/// Records that cannot be read.
pub fn section(table: &Table, main: &Loaded, beside: &[&Loaded]) -> Result<Section, LoadError> {
    let mut text = head(table);
    let compared = if table.is_of_adjustments() { adjustments(table, main) } else { points(table, main)? };
    let tally = match compared {
        Ok((comparison, tally)) => {
            text.push_str(&comparison);
            tally
        }
        Err(nothing) => {
            text.push_str(&nothing);
            Tally::default()
        }
    };
    text.push_str(&findings(table));
    if table.is_of_points() {
        text.push_str(&every_method::section(table, main, beside));
    }
    Ok(Section { text, tally })
}

/// Heading, source and unit.
pub fn head(table: &Table) -> String {
    format!("## {}\n\n{}. Unit: {}.\n\n", table.title, table.source, table.unit)
}

/// The comparison, or why there is none.
type Compared = Result<(String, Tally), String>;

fn points(table: &Table, main: &Loaded) -> Result<Compared, LoadError> {
    if main.method(&table.method).is_none() {
        return Ok(Err(no_method(table)));
    }
    if main.scores.trials < 2 {
        return Ok(Ok(one::comparison(table, &of_one(table, main), false)));
    }
    Ok(Ok(many::comparison(table, &many::of_all_trials(table, main)?, main.scores.trials)))
}

fn adjustments(table: &Table, main: &Loaded) -> Compared {
    let Some(found) = &main.calibrations else {
        return Err(no_adjustments(table));
    };
    if is_of_print(main) {
        return Ok(one::comparison(table, &first(&of_adjustments(table, main, found)), true));
    }
    Ok(many::comparison(table, &of_adjustments(table, main, found), found.trials))
}

/// Whether nothing was measured, so that there are no runs which differ.
fn is_of_print(main: &Loaded) -> bool {
    matches!(main.scenario.study, Study::Printed(_))
}

fn first(figures: &[Option<Ours>]) -> Vec<Option<f64>> {
    figures.iter().map(|ours| Some(ours.as_ref()?.one)).collect()
}

/// Our figure for each cell in the first trial.
fn of_one(table: &Table, main: &Loaded) -> Vec<Option<f64>> {
    table.cells.iter().map(|cell| one::figure(table, main, cell)).collect()
}

/// Our figure for each cell.
fn of_adjustments(table: &Table, main: &Loaded, found: &Summaries) -> Vec<Option<Ours>> {
    let pitch = main.scenario.adjusted().map_or(f64::NAN, |(_, told)| told.pitch_um);
    table.cells.iter().map(|cell| ours(found, cell, &table.method, pitch)).collect()
}

/// The verdict of each cell of `table`, as its section states them; `None` where the records `main` hold nothing of its method.
///
/// # Errors
/// Records that cannot be read.
pub fn verdicts(table: &Table, main: &Loaded) -> Result<Option<Vec<Verdict>>, LoadError> {
    let of_one_run = |figures: &[Option<f64>]| table.cells.iter().zip(figures).map(|(cell, ours)| cell.verdict(*ours)).collect();
    let of_many =
        |figures: &[Option<Ours>]| table.cells.iter().zip(figures).map(|(cell, ours)| many::verdict(table, cell, ours.as_ref())).collect();
    if table.is_of_adjustments() && is_of_print(main) {
        return Ok(main.calibrations.as_ref().map(|found| of_one_run(&first(&of_adjustments(table, main, found)))));
    }
    if table.is_of_adjustments() {
        return Ok(main.calibrations.as_ref().map(|found| of_many(&of_adjustments(table, main, found))));
    }
    if main.method(&table.method).is_none() {
        return Ok(None);
    }
    if main.scores.trials < 2 {
        return Ok(Some(of_one_run(&of_one(table, main))));
    }
    Ok(Some(of_many(&many::of_all_trials(table, main)?)))
}

/// The section of a table of adjustments whose scenario was not run.
pub fn without_records(table: &Table) -> Section {
    Section { text: head(table) + &no_adjustments(table) + &findings(table), tally: Tally::default() }
}

fn no_adjustments(table: &Table) -> String {
    format!("There are no adjustments of `{}`: run it with `calibench run {}`.\n\n", table.scenario, table.scenario)
}

/// Records of the scenario that lack the table's method.
pub fn no_method(table: &Table) -> String {
    format!("The records of `{}` hold no method `{}`: nothing to compare.\n\n", table.scenario, table.method)
}

/// What was found out about a table.
pub fn findings(table: &Table) -> String {
    if table.findings.is_empty() {
        return String::new();
    }
    let lines: String = table.findings.iter().map(|finding| format!("- {}\n", finding.trim().replace('\n', " "))).collect();
    format!("### What was found out\n\n{lines}\n")
}
