//! A published table beside many runs of ours: one of them, their mean, and where single runs lie.

use std::fs::File;
use std::io::BufReader;

use calibench_records::names::RECORDS;
use calibench_records::points::read_records;
use calibench_records::statistics::running::Running;

use super::figure::{Ours, of_points};
use super::notes::Notes;
use super::{Cell, Printed, Table, Tally, Verdict};
use crate::load::{LoadError, Loaded};
use crate::markdown::{MarkdownTable, fixed};

/// Within so many standard deviations of their mean lie 95 % of single runs, if these are normal.
const SINGLE: f64 = 1.959_964;

/// Our figures of points for every cell of `table`, over all trials in the records of `loaded`.
///
/// # Errors
/// Records that cannot be read.
pub fn of_all_trials(table: &Table, loaded: &Loaded) -> Result<Vec<Option<Ours>>, LoadError> {
    let path = loaded.folder.join(RECORDS);
    let file = File::open(&path).map_err(|source| LoadError::File { path: path.clone(), source })?;
    let mut figures = vec![(None, Running::default()); table.cells.len()];
    let read = read_records(BufReader::new(file), |trial, methods| {
        for (cell, (first, all)) in table.cells.iter().zip(&mut figures) {
            let label = cell.method.as_ref().unwrap_or(&table.method);
            let method = methods.iter().position(|method| *method.label == **label);
            let figure = method.and_then(|method| of_points(&trial.points, method, cell.metric, cell.target.as_deref(), &cell.except));
            if let Some(figure) = figure.map(|figure| figure + cell.plus) {
                first.get_or_insert(figure);
                all.add(figure);
            }
        }
    });
    read.map_err(|source| LoadError::Records { path, source })?;
    Ok(figures.into_iter().map(|(first, all)| Ours::of(first, &all)).collect())
}

/// The table, with a figure of ours for every cell or none, over `trials` trials.
pub fn comparison(table: &Table, figures: &[Option<Ours>], trials: u64) -> (String, Tally) {
    let against_truth = figures.iter().flatten().any(|ours| ours.truth.is_some());
    let mut header = vec!["row", "column", "printed", "one run", "mean", "single runs, 95 %", "true errors", "verdict"];
    header.retain(|name| against_truth || *name != "true errors");
    let mut rows = MarkdownTable::new(&header);
    let (mut tally, mut notes) = (Tally::default(), Notes::default());
    for (cell, figure) in table.cells.iter().zip(figures) {
        let verdict = verdict(cell, figure.as_ref());
        tally.count(&verdict);
        let mut row = vec![cell.row.clone(), cell.column.clone(), cell.printed.clone()];
        row.extend(figure.as_ref().map_or_else(|| vec!["none".to_owned(); 4], |ours| cells(cell, ours)));
        if !against_truth {
            row.pop();
        }
        let misprint = cell.misprint.as_ref().map_or_else(String::new, |misprint| notes.mark(&format!("misprint: {misprint}")));
        let said = match (&verdict, figure, Printed::parse(&cell.printed)) {
            (Verdict::NotComparable(why), _, _) => format!("{}{}", verdict.word(), notes.mark(why)),
            (Verdict::Differs, Some(ours), Some(printed)) if printed.value != 0.0 => {
                format!("{}: {:.2} times", verdict.word(), ours.mean / printed.value)
            }
            _ => verdict.word().to_owned(),
        };
        rows.row(row.into_iter().chain([said + &misprint]));
    }
    let truth = if against_truth {
        " *True errors*: the same figure of errors against the truth (root mean square, or the ratio of root mean squares)."
    } else {
        ""
    };
    let text = format!(
        "Printed beside `{}`: its first trial, the mean of {trials} trials, and where 95 % of single runs lie; after \u{b1} stands half a 95 % interval. The paper is a single run: a cell \
         *reproduces* when it lies in that range, widened by half a unit of its last digit; where it *differs*, ours is so many times as large in the mean.{truth}\n\n{}\n{}{}\n\n",
        table.scenario,
        rows.render(),
        notes.render(),
        tally.sentence()
    );
    (text, tally)
}

/// The verdict of `cell`, given our figure or none.
pub fn verdict(cell: &Cell, ours: Option<&Ours>) -> Verdict {
    match (&cell.not_comparable, ours) {
        (Some(why), _) => Verdict::NotComparable(why.clone()),
        (None, None) => Verdict::NotComparable("no record of ours".to_owned()),
        (None, Some(ours)) => cell.verdict_within(ours.mean, SINGLE * ours.scatter.unwrap_or(0.0)),
    }
}

fn cells(cell: &Cell, ours: &Ours) -> Vec<String> {
    let text = |value: f64| like(cell, value);
    let with_half = |value: f64, half: Option<f64>| match half {
        Some(half) => format!("{} \u{b1} {}", text(value), spread(cell, value, half)),
        None => text(value),
    };
    let truth = ours.truth.map_or_else(String::new, |(value, half)| with_half(value, half));
    let range = ours.scatter.map_or_else(
        || "none".to_owned(),
        |scatter| {
            let (low, high) = (ours.mean - SINGLE * scatter, ours.mean + SINGLE * scatter);
            format!("{} to {}", text(low), text(high))
        },
    );
    vec![text(ours.one), with_half(ours.mean, ours.half), range, truth]
}

/// In the form of the printed figure, with one digit more.
fn like(cell: &Cell, value: f64) -> String {
    if cell.printed.contains('/') {
        return if value > 0.0 { format!("1/{:.0}", 1.0 / value) } else { "0".to_owned() };
    }
    let digits = Printed::parse(&cell.printed).map_or(4, |printed| (-printed.unit.log10()).round() as usize + 1);
    fixed(value, digits)
}

/// A half interval: of a fraction, that of its denominator.
fn spread(cell: &Cell, value: f64, half: f64) -> String {
    if cell.printed.contains('/') { format!("{:.0}", half / (value * value)) } else { like(cell, half) }
}
