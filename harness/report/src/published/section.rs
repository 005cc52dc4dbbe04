//! The section of a published table: its cells beside ours, what was found out, every method.

use calibench_records::description::Study;

use super::adjustment::of_all_cells;
use super::figure::Ours;
use super::{Cell, Table, Tally, Verdict, every_method, many, one};
use crate::load::{LoadError, Loaded};

/// A section of a page, and the verdicts of its cells.
pub struct Section {
    /// Markdown: the table beside ours.
    pub text: String,
    /// What stands behind what was found out.
    pub after: String,
    /// The verdict of each cell; none where nothing could be compared.
    pub verdicts: Vec<Verdict>,
    /// Our figure for each cell, or none.
    pub figures: Vec<Option<f64>>,
}

impl Section {
    /// Where nothing could be compared.
    pub fn of_nothing(text: String) -> Self {
        Self { text, after: String::new(), verdicts: Vec::new(), figures: Vec::new() }
    }
}

/// The section of `table`, whose scenario's records are `main`; other scenarios stand `beside` it.
///
/// # Errors
/// Records that cannot be read.
pub fn section(table: &Table, main: &Loaded, beside: &[&Loaded]) -> Result<Section, LoadError> {
    let mut text = head(table);
    let compared = if table.is_of_adjustments() { adjustments(table, main)? } else { points(table, main)? };
    match compared {
        Ok((comparison, _)) | Err(comparison) => text.push_str(&comparison),
    }
    let after = if table.is_of_points() { every_method::section(table, main, beside) } else { String::new() };
    let judged = judged(table, main)?.unwrap_or_default();
    let (verdicts, figures) = judged.into_iter().unzip();
    Ok(Section { text, after, verdicts, figures })
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

fn adjustments(table: &Table, main: &Loaded) -> Result<Compared, LoadError> {
    let Some(found) = &main.calibrations else {
        return Ok(Err(no_adjustments(table)));
    };
    let figures = of_all_cells(table, main, found)?;
    if is_of_print(main) {
        return Ok(Ok(one::comparison(table, &first(&figures), true)));
    }
    Ok(Ok(many::comparison(table, &figures, found.trials)))
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

/// The verdict of each cell of `table`, as its section states them; `None` where the records `main` hold nothing of its method.
///
/// # Errors
/// Records that cannot be read.
pub fn verdicts(table: &Table, main: &Loaded) -> Result<Option<Vec<Verdict>>, LoadError> {
    Ok(judged(table, main)?.map(|judged| judged.into_iter().map(|(verdict, _)| verdict).collect()))
}

/// The verdict of each cell, and our figure: of one run, or the mean or median of many.
type Judged = Vec<(Verdict, Option<f64>)>;

fn judged(table: &Table, main: &Loaded) -> Result<Option<Judged>, LoadError> {
    let of_one_run =
        |figures: &[Option<f64>]| -> Judged { table.cells.iter().zip(figures).map(|(cell, ours)| (cell.verdict(*ours), *ours)).collect() };
    let of_many = |figures: &[Option<Ours>]| -> Judged {
        let of =
            |(cell, ours): (&Cell, &Option<Ours>)| (many::verdict(table, cell, ours.as_ref()), many::middle(table, cell, ours.as_ref()));
        table.cells.iter().zip(figures).map(of).collect()
    };
    if table.is_of_adjustments() {
        let Some(found) = &main.calibrations else { return Ok(None) };
        let figures = of_all_cells(table, main, found)?;
        return Ok(Some(if is_of_print(main) { of_one_run(&first(&figures)) } else { of_many(&figures) }));
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
    Section::of_nothing(head(table) + &no_adjustments(table))
}

/// The section of a table that takes figures of a scenario that was not run.
pub fn not_run(table: &Table, scenario: &str) -> Section {
    Section::of_nothing(format!("{}There are no records of `{scenario}`: run it with `calibench run {scenario}`.\n\n", head(table)))
}

fn no_adjustments(table: &Table) -> String {
    format!("There are no adjustments of `{}`: run it with `calibench run {}`.\n\n", table.scenario, table.scenario)
}

/// Records of the scenario that lack the table's method.
pub fn no_method(table: &Table) -> String {
    format!("The records of `{}` hold no method `{}`: nothing to compare.\n\n", table.scenario, table.method)
}

/// What was found out about a table, as it is written: figures may be asked for in braces.
pub fn findings(table: &Table) -> String {
    if table.findings.is_empty() {
        return String::new();
    }
    let lines: String = table.findings.iter().map(|finding| format!("- {}\n", finding.trim().replace('\n', " "))).collect();
    format!("### What was found out\n\n{lines}\n")
}
